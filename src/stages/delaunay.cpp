// SPDX-License-Identifier: GPL-3.0-or-later
// §3: the Delaunay tetrahedralization. The only file that knows which code computes it.
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_cell_base_with_info_3.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>

#include <algorithm>
#include <bit>

#include <eigencrust/error.h>
#include <eigencrust/stages.h>

#include "geometry/predicates.h"
#include "parallel/threads.h"

namespace eigencrust {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_3<std::uint32_t, Kernel>;
using CellBase =
    CGAL::Triangulation_cell_base_with_info_3<std::uint32_t, Kernel, CGAL::Delaunay_triangulation_cell_base_3<Kernel>>;
using Delaunay = CGAL::Delaunay_triangulation_3<Kernel, CGAL::Triangulation_data_structure_3<VertexBase, CellBase>>;

constexpr std::uint32_t none = TetrahedronIndex::none;
// "Much wider than the cloud" (§3): no sample may lie near a side.
constexpr double cube_half_side_in_diagonals = 10;

/// Random insertion rounds, each along the Hilbert curve (BRIO; Amenta, Choi, Rote 2003): the round of a
/// sample is a hash of its number, later rounds being eight times larger.
unsigned insertion_round(std::uint32_t i) {
  std::uint64_t h = (i + 1) * 0x9e3779b97f4a7c15ull;
  h = (h ^ (h >> 32)) * 0xd6e8feb86659fd93ull;
  return static_cast<unsigned>(std::countr_zero((h ^ (h >> 29)) | 1ull << 60)) / 3;
}

void insert_all(Delaunay& delaunay, const IndexedArray<SampleIndex, Vec3>& positions, std::uint32_t samples) {
  Delaunay::Cell_handle hint;
  const auto insert = [&](std::uint32_t i) {
    const Vec3& p = positions.raw()[i];
    const Delaunay::Vertex_handle v = delaunay.insert({p.x, p.y, p.z}, hint);
    v->info() = i;
    hint = v->cell();
  };
  for (std::uint32_t i = samples; i < positions.size(); ++i) insert(i);
  std::vector<std::vector<std::uint32_t>> rounds(21);
  for (std::uint32_t i = 0; i < samples; ++i) rounds[insertion_round(i)].push_back(i);
  for (std::size_t r = rounds.size(); r-- > 0;)
    for (const std::uint32_t i : rounds[r]) insert(i);
}

/// Which vertex goes where so that the smallest comes first and the second smallest second. Only even
/// permutations are used, so the orientation stays; with it the form is unique.
std::array<int, 4> canonical_order(const std::array<std::uint32_t, 4>& v) {
  static constexpr std::array<std::array<int, 4>, 12> even{{{0, 1, 2, 3},
                                                            {0, 2, 3, 1},
                                                            {0, 3, 1, 2},
                                                            {1, 0, 3, 2},
                                                            {1, 2, 0, 3},
                                                            {1, 3, 2, 0},
                                                            {2, 0, 1, 3},
                                                            {2, 1, 3, 0},
                                                            {2, 3, 0, 1},
                                                            {3, 0, 2, 1},
                                                            {3, 1, 0, 2},
                                                            {3, 2, 1, 0}}};
  const auto smaller = [&](const std::array<int, 4>& p, const std::array<int, 4>& q) {
    return std::pair(v[static_cast<std::size_t>(p[0])], v[static_cast<std::size_t>(p[1])]) <
           std::pair(v[static_cast<std::size_t>(q[0])], v[static_cast<std::size_t>(q[1])]);
  };
  return *std::min_element(even.begin(), even.end(), smaller);
}

struct RawCell {
  std::array<std::uint32_t, 4> vertex; // canonical
  std::uint32_t number;                // in the engine's order
  friend bool operator<(const RawCell& a, const RawCell& b) { return a.vertex < b.vertex; }
};

/// Sorts by the vertices: by the first with counting, then within each first vertex.
std::vector<RawCell> sort_cells(std::vector<RawCell> cells, std::size_t vertices, const Threads& threads) {
  std::vector<std::uint32_t> begin(vertices + 1, 0);
  for (const RawCell& c : cells) ++begin[c.vertex[0] + 1];
  for (std::size_t v = 0; v < vertices; ++v) begin[v + 1] += begin[v];
  std::vector<RawCell> sorted(cells.size());
  std::vector<std::uint32_t> cursor(begin.begin(), begin.end() - 1);
  for (const RawCell& c : cells) sorted[cursor[c.vertex[0]]++] = c;
  for_each_index(threads, vertices,
                 [&](std::size_t v) { std::sort(sorted.begin() + begin[v], sorted.begin() + begin[v + 1]); });
  return sorted;
}

void copy_cells(Delaunay& delaunay, Tetrahedralization& result, const Threads& threads) {
  std::vector<RawCell> cells;
  for (auto c = delaunay.all_cells_begin(); c != delaunay.all_cells_end(); ++c) c->info() = none;
  for (auto c = delaunay.finite_cells_begin(); c != delaunay.finite_cells_end(); ++c) {
    std::array<std::uint32_t, 4> v{};
    for (int k = 0; k < 4; ++k) v[static_cast<std::size_t>(k)] = c->vertex(k)->info();
    const std::array<int, 4> order = canonical_order(v);
    RawCell cell{{}, static_cast<std::uint32_t>(cells.size())};
    for (std::size_t k = 0; k < 4; ++k) cell.vertex[k] = v[static_cast<std::size_t>(order[k])];
    c->info() = cell.number;
    cells.push_back(cell);
    if (cells.size() >= none)
      throw Error(ErrorKind::memory, "delaunay", "more than 4 billion tetrahedra", "split the cloud");
  }
  cells = sort_cells(std::move(cells), result.positions.size(), threads);
  std::vector<std::uint32_t> rank(cells.size());
  for (std::uint32_t t = 0; t < cells.size(); ++t) rank[cells[t].number] = t;
  result.tetrahedra.raw().resize(cells.size());
  for (std::uint32_t t = 0; t < cells.size(); ++t)
    for (std::size_t k = 0; k < 4; ++k) result.tetrahedra.raw()[t][k] = SampleIndex{cells[t].vertex[k]};
  cells = {};
  result.neighbours.raw().resize(rank.size());
  for (auto c = delaunay.finite_cells_begin(); c != delaunay.finite_cells_end(); ++c) {
    std::array<std::uint32_t, 4> v{};
    for (int k = 0; k < 4; ++k) v[static_cast<std::size_t>(k)] = c->vertex(k)->info();
    const std::array<int, 4> order = canonical_order(v);
    for (std::size_t k = 0; k < 4; ++k) {
      const std::uint32_t n = c->neighbor(order[k])->info();
      result.neighbours.raw()[rank[c->info()]][k] = TetrahedronIndex{n == none ? none : rank[n]};
    }
  }
}

} // namespace

Tetrahedralization tetrahedralize(Samples samples, const Threads& threads) {
  const int dimension = affine_dimension(samples.positions.raw());
  if (dimension < 3)
    throw Error(ErrorKind::input, "delaunay", dimension < 2 ? "all points are collinear" : "all points are coplanar",
                "give points that surround a volume");
  Tetrahedralization result;
  result.origin = samples.origin;
  result.sample_count = samples.positions.size();
  result.positions = std::move(samples.positions);
  result.source = std::move(samples.source);
  const double h = cube_half_side_in_diagonals * samples.bounds.diagonal();
  for (const double x : {-h, h})
    for (const double y : {-h, h})
      for (const double z : {-h, h}) result.positions.raw().push_back({x, y, z});
  Delaunay delaunay;
  insert_all(delaunay, result.positions, result.sample_count);
  if (delaunay.number_of_vertices() != result.positions.size())
    throw Error(ErrorKind::guarantee, "delaunay", "a sample was lost", "report this as a fault of the program");
  copy_cells(delaunay, result, threads);
  return result;
}

VertexStars vertex_stars(const Tetrahedralization& t, const Threads&) {
  VertexStars stars;
  stars.begin.assign(t.positions.size() + 1, 0);
  for (const auto& tetrahedron : t.tetrahedra)
    for (const SampleIndex s : tetrahedron) ++stars.begin[s.value + 1];
  for (std::size_t s = 0; s < t.positions.size(); ++s) stars.begin[s + 1] += stars.begin[s];
  stars.tetrahedra.resize(stars.begin.back());
  std::vector<std::uint64_t> cursor(stars.begin.begin(), stars.begin.end() - 1);
  for (std::uint32_t i = 0; i < t.tetrahedra.size(); ++i)
    for (const SampleIndex s : t.tetrahedra[TetrahedronIndex{i}])
      stars.tetrahedra[cursor[s.value]++] = TetrahedronIndex{i};
  return stars;
}

} // namespace eigencrust
