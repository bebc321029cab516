// SPDX-License-Identifier: GPL-3.0-or-later
// §3: the Delaunay tetrahedralization. The only file that knows which code computes it.
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_cell_base_with_info_3.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>

#include <algorithm>
#include <memory>
#include <thread>

#include <eigencrust/error.h>
#include <eigencrust/stages.h>

#include "geometry/predicates.h"
#include "geometry/tetrahedron.h"
#include "parallel/compressed_rows.h"
#include "tetrahedra/growth.h"
#include "tetrahedra/insertion_rounds.h"

namespace eigencrust {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_3<std::uint32_t, Kernel>;
using CellBase =
    CGAL::Triangulation_cell_base_with_info_3<std::uint32_t, Kernel, CGAL::Delaunay_triangulation_cell_base_3<Kernel>>;
using Delaunay = CGAL::Delaunay_triangulation_3<Kernel, CGAL::Triangulation_data_structure_3<VertexBase, CellBase>>;

// Where the time goes, of a million points: the rest is for the copy in our own order.
constexpr double share_of_insertion = 0.85;

// "Much wider than the cloud" (§3): no sample may lie near a side.
constexpr double cube_half_side_in_diagonals = 10;

// A sample among thousands of tetrahedra takes a thousandth of a second, any other a thousandth of that.
constexpr std::uint32_t samples_between_looks = 32;

/// The corners of the cube, then the samples in rounds along the Hilbert curve.
void insert_all(Delaunay& delaunay, const IndexedArray<SampleIndex, Vec3>& positions, std::uint32_t samples,
                const WatchGrowth& watch) {
  Delaunay::Cell_handle hint;
  std::uint32_t done = 0;
  const auto insert = [&](std::uint32_t i) {
    if (watch && ++done % samples_between_looks == 0)
      watch(share_of_insertion * done / positions.size(), delaunay.tds().number_of_cells());
    const Vec3& p = positions.raw()[i];
    const Delaunay::Vertex_handle v = delaunay.insert({p.x, p.y, p.z}, hint);
    v->info() = i;
    hint = v->cell();
  };
  for (std::uint32_t i = samples; i < positions.size(); ++i) insert(i);
  for (const std::uint32_t i : in_rounds(samples)) insert(i);
}

/// Which vertex goes where so that the smallest comes first and the second smallest second. Only even
/// permutations are used, so the orientation stays; with it the form is unique.
std::array<std::size_t, 4> canonical_order(const std::array<std::uint32_t, 4>& v) {
  const auto first = static_cast<std::size_t>(std::min_element(v.begin(), v.end()) - v.begin());
  auto rest = face_opposite[first];
  const auto smaller = [&](std::size_t a, std::size_t b) { return v[a] < v[b]; };
  std::rotate(rest.begin(), std::min_element(rest.begin(), rest.end(), smaller), rest.end());
  return {first, rest[0], rest[1], rest[2]};
}

/// Cells in the engine's order, in canonical form; cells beyond the hull have no number.
void copy_cells(Delaunay& delaunay, Tetrahedralization& result, const Threads& threads) {
  std::vector<Delaunay::Cell_handle> cells;
  cells.reserve(delaunay.tds().number_of_cells());
  for (auto c = delaunay.all_cells_begin(); c != delaunay.all_cells_end(); ++c) {
    if (delaunay.is_infinite(c)) {
      c->info() = no_index;
      continue;
    }
    if (cells.size() >= no_index - 1)
      throw Error(ErrorKind::memory, "delaunay", "more than 4 billion tetrahedra", "split the cloud");
    c->info() = static_cast<std::uint32_t>(cells.size());
    cells.push_back(c);
  }
  auto& tetrahedra = result.tetrahedra.raw();
  auto& neighbours = result.neighbours.raw();
  tetrahedra.resize(cells.size());
  neighbours.resize(cells.size());
  for_each_index(threads, cells.size(), [&](std::size_t i) {
    const Delaunay::Cell_handle c = cells[i];
    std::array<std::uint32_t, 4> v{};
    for (std::size_t k = 0; k < 4; ++k) v[k] = c->vertex(static_cast<int>(k))->info();
    const std::array<std::size_t, 4> order = canonical_order(v);
    for (std::size_t k = 0; k < 4; ++k) {
      tetrahedra[i][k] = SampleIndex{v[order[k]]};
      neighbours[i][k] = TetrahedronIndex{c->neighbor(static_cast<int>(order[k]))->info()};
    }
  });
}

/// Tetrahedra by their vertices: by the first with counting, then within each first vertex.
std::vector<std::uint32_t> sorted_order(const Tetrahedralization& t, const Threads& threads) {
  const auto& tetrahedra = t.tetrahedra.raw();
  auto rows = build_rows<std::uint32_t>(t.positions.size(), [&](auto&& visit) {
    for (std::uint32_t i = 0; i < tetrahedra.size(); ++i) visit(tetrahedra[i][0].value, i);
  });
  sort_rows(rows, threads, [&](std::uint32_t a, std::uint32_t b) { return tetrahedra[a] < tetrahedra[b]; });
  return std::move(rows.item);
}

/// From the engine's order, which depends on the order of insertion, to one that does not.
void sort_tetrahedra(Tetrahedralization& t, const Threads& threads) {
  const std::vector<std::uint32_t> order = sorted_order(t, threads);
  std::vector<std::uint32_t> rank(order.size());
  for_each_index(threads, order.size(), [&](std::size_t i) { rank[order[i]] = static_cast<std::uint32_t>(i); });
  std::vector<std::array<SampleIndex, 4>> tetrahedra(order.size());
  for_each_index(threads, order.size(), [&](std::size_t i) { tetrahedra[i] = t.tetrahedra.raw()[order[i]]; });
  t.tetrahedra.raw() = std::move(tetrahedra);
  std::vector<std::array<TetrahedronIndex, 4>> neighbours(order.size());
  for_each_index(threads, order.size(), [&](std::size_t i) {
    neighbours[i] = t.neighbours.raw()[order[i]];
    for (TetrahedronIndex& n : neighbours[i])
      if (n.valid()) n = TetrahedronIndex{rank[n.value]};
  });
  t.neighbours.raw() = std::move(neighbours);
}

} // namespace

Tetrahedralization tetrahedralize(Samples samples, const Threads& threads, const std::function<void()>& beside) {
  return tetrahedralize(std::move(samples), threads, beside, {});
}

Tetrahedralization tetrahedralize(Samples samples, const Threads& threads, const std::function<void()>& beside,
                                  const WatchGrowth& watch) {
  const int dimension = affine_dimension(samples.positions.raw());
  if (dimension <= 2)
    throw Error(ErrorKind::input, "delaunay", dimension < 2 ? "all points are collinear" : "all points are coplanar",
                "give points that surround a volume");
  Tetrahedralization result;
  result.origin = samples.origin;
  result.sample_count = samples.positions.size();
  result.positions = std::move(samples.positions);
  result.source = std::move(samples.source);
  const double h = cube_half_side_in_diagonals * samples.bounds.diagonal();
  const Vec3 middle = samples.bounds.centre() - samples.origin;
  for (const double x : {-h, h})
    for (const double y : {-h, h})
      for (const double z : {-h, h}) result.positions.raw().push_back(middle + Vec3{x, y, z});
  auto engine = std::make_unique<Delaunay>();
  Delaunay& delaunay = *engine;
  threads.run(beside ? 2 : 1, [&](std::size_t task) {
    if (task == 0)
      insert_all(delaunay, result.positions, result.sample_count, watch);
    else
      beside();
  });
  if (delaunay.number_of_vertices() != result.positions.size())
    throw Error(ErrorKind::guarantee, "delaunay", "a sample was lost", "report this as a fault of the program");
  if (watch) watch(share_of_insertion, delaunay.tds().number_of_cells());
  copy_cells(delaunay, result, threads);
  if (watch) watch((1 + share_of_insertion) / 2, result.tetrahedra.size());
  engine.reset(); // its half a kilobyte per sample is not needed beside ours
  sort_tetrahedra(result, threads);
  return result;
}

} // namespace eigencrust
