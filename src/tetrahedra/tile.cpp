// SPDX-License-Identifier: GPL-3.0-or-later
// §3: the Delaunay tetrahedralization. The only file that knows which code computes it.
#include "tetrahedra/tile.h"

#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_cell_base_with_info_3.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <eigencrust/error.h>

#include "geometry/predicates.h"
#include "geometry/tetrahedron.h"
#include "parallel/compressed_rows.h"
#include "tetrahedra/circumsphere.h"
#include "tetrahedra/insertion_rounds.h"

namespace eigencrust {
namespace {

/// A cell's number in the tile, once it has one.
struct CellState {
  static constexpr std::uint32_t unasked = no_index, asked = no_index - 1, foreign = no_index - 2;
  std::uint32_t number = unasked;
};

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_3<std::uint32_t, Kernel>;
using CellBase =
    CGAL::Triangulation_cell_base_with_info_3<CellState, Kernel, CGAL::Delaunay_triangulation_cell_base_3<Kernel>>;
using Delaunay = CGAL::Delaunay_triangulation_3<Kernel, CGAL::Triangulation_data_structure_3<VertexBase, CellBase>>;
using Cell = Delaunay::Cell_handle;
using Vertex = Delaunay::Vertex_handle;

// A sample among thousands of tetrahedra takes a thousandth of a second, any other a thousandth of that.
constexpr std::uint32_t samples_between_reports = 32;
constexpr std::uint64_t tetrahedra_between_reports = 4096; // a ten-thousandth of a second, mostly

// How many groups of samples may be looked at for each tetrahedron that is asked: about ten are of scans, and all for
// each where all samples lie on one sphere.
constexpr std::uint64_t looks_per_tetrahedron = 32;
constexpr std::uint64_t looks_that_do_not_matter = 1000000; // a hundredth of a second
constexpr std::uint64_t looks_as_long_as_a_test = 16;       // of one sample, where exact arithmetic is needed

/// Which vertex goes where so that the smallest comes first and the second smallest second. Only even
/// permutations are used, so the orientation stays; with it the form is unique.
std::array<std::size_t, 4> canonical_order(const std::array<std::uint32_t, 4>& v) {
  const auto first = static_cast<std::size_t>(std::min_element(v.begin(), v.end()) - v.begin());
  auto rest = face_opposite[first];
  const auto smaller = [&](std::size_t a, std::size_t b) { return v[a] < v[b]; };
  std::rotate(rest.begin(), std::min_element(rest.begin(), rest.end(), smaller), rest.end());
  return {first, rest[0], rest[1], rest[2]};
}

std::array<std::uint32_t, 4> vertices_of(Cell c) {
  return {c->vertex(0)->info(), c->vertex(1)->info(), c->vertex(2)->info(), c->vertex(3)->info()};
}

/// A tetrahedron whose circumsphere holds samples that are elsewhere, perhaps. What is inserted meanwhile may end it.
using Waiting = std::array<Vertex, 4>;

/// A sample inside the circumsphere of a tetrahedron.
struct Missing {
  std::uint32_t sample;
  Vertex near; ///< of the tetrahedron
};

/// Around the circumsphere, whatever was rounded.
struct Shell {
  Vec3 centre;
  double squared_inner, squared_outer; ///< what is not farther is inside for certain; what is farther is outside
};

class TileMaker {
 public:
  TileMaker(std::span<const Vec3> corners, const SampleBlocks& blocks, const SampleRange& range, TileProgress& progress,
            SampleSupply* supply)
      : corners_(corners),
        samples_(blocks.sample_count()),
        blocks_(blocks),
        range_(range),
        progress_(progress),
        supply_(supply) {
    Box3 box;
    for (const Vec3& p : corners) box.add(p);
    rounding_ = 16 * std::numeric_limits<double>::epsilon() * box.diagonal();
  }

  std::optional<Tile> make() {
    insert_own();
    if (range_.size() < samples_ && !insert_what_matters()) return {};
    return copy();
  }

 private:
  [[nodiscard]] const Vec3& position(std::uint32_t vertex) const {
    return vertex < samples_ ? blocks_.position(vertex) : corners_[vertex - samples_];
  }

  Vertex insert(std::uint32_t i, Cell near) {
    const Vec3& p = position(i);
    const Vertex v = delaunay_->insert({p.x, p.y, p.z}, near);
    v->info() = i;
    ++vertices_;
    if (++inserted_ % samples_between_reports == 0) report();
    return v;
  }

  void report() {
    const auto cells = static_cast<std::int64_t>(delaunay_->tds().number_of_cells());
    progress_.add(std::exchange(inserted_, 0), cells - std::exchange(reported_cells_, cells));
  }

  /// The corners of the cube, then the tile's samples in rounds along the Hilbert curve.
  void insert_own() {
    Cell near;
    const auto add = [&](std::uint32_t i) { near = insert(i, near)->cell(); };
    for (std::uint32_t i = 0; i < corners_.size(); ++i) add(samples_ + i);
    for (const std::uint32_t i : in_rounds(range_.size())) add(range_.begin + i);
  }

  /// \return false if it was given up
  bool insert_what_matters() {
    measure_margins();
    known_.resize(samples_);
    std::vector<Cell> open;
    for (auto c = delaunay_->finite_cells_begin(); c != delaunay_->finite_cells_end(); ++c) ask_later(c, open);
    do {
      settle(open);
      open.clear();
    } while (fetch(open));
    return !progress_.given_up();
  }

  /// Asks the cells and what stands in their place, as long as samples that are known are missing.
  void settle(std::vector<Cell>& open) {
    while (!open.empty()) {
      std::vector<Vertex> fresh;
      for (const Missing& m : missing_of(open)) {
        fresh.push_back(insert(m.sample, m.near->cell()));
        known_[m.sample] = true;
      }
      open.clear();
      if (progress_.given_up()) return;
      for (const Vertex v : fresh) {
        std::vector<Cell> around;
        delaunay_->finite_incident_cells(v, std::back_inserter(around));
        for (const Cell c : around) ask_later(c, open);
      }
    }
  }

  /// What cells wait for; then those are open that are still there. \return false where all is settled, everywhere
  bool fetch(std::vector<Cell>& open) {
    if (supply_ == nullptr) return false;
    std::sort(wanted_.begin(), wanted_.end());
    wanted_.erase(std::unique(wanted_.begin(), wanted_.end()), wanted_.end());
    if (!supply_->fetch(wanted_)) return false;
    wanted_.clear();
    for (const auto& [a, b, c, d] : std::exchange(waiting_, {})) {
      Cell cell;
      if (delaunay_->is_cell(a, b, c, d, cell)) open.push_back(cell);
    }
    return true;
  }

  /// Of each block of own samples, how far it is from the samples of others.
  void measure_margins() {
    const std::uint32_t first = range_.begin / SampleBlocks::block_size, end = last_block() + 1;
    for (std::uint32_t b = first; b < end; ++b)
      margins_.push_back(blocks_.distance_to_others(blocks_.box_of_block(b), range_));
  }
  [[nodiscard]] std::uint32_t last_block() const { return (range_.end - 1) / SampleBlocks::block_size; }
  [[nodiscard]] double margin(std::uint32_t sample) const {
    return margins_[sample / SampleBlocks::block_size - range_.begin / SampleBlocks::block_size];
  }

  [[nodiscard]] bool is_own(Cell c) const {
    const auto v = vertices_of(c);
    return range_.holds(*std::min_element(v.begin(), v.end()));
  }

  [[nodiscard]] std::uint32_t own_vertex(const std::array<std::uint32_t, 4>& v) const {
    const auto own = std::find_if(v.begin(), v.end(), [&](std::uint32_t i) { return range_.holds(i); });
    return own == v.end() ? no_index : *own;
  }

  /// What stands around the tile's samples has to be right, else there is no room for all that is the tile's.
  void ask_later(Cell c, std::vector<Cell>& open) const {
    if (c->info().number != CellState::unasked || own_vertex(vertices_of(c)) == no_index) return;
    c->info().number = CellState::asked;
    open.push_back(c);
  }

  /// Each sample once.
  std::vector<Missing> missing_of(const std::vector<Cell>& open) {
    std::vector<Missing> missing;
    for (const Cell c : open) {
      if (const auto sample = deepest_inside(c)) missing.push_back({*sample, c->vertex(0)});
      if (++asked_ % tetrahedra_between_reports == 0) report();
      if (looks_ > looks_that_do_not_matter + looks_per_tetrahedron * asked_) progress_.give_up();
      if (progress_.given_up()) return {};
    }
    const auto by_sample = [](const Missing& a, const Missing& b) { return a.sample < b.sample; };
    const auto same = [](const Missing& a, const Missing& b) { return a.sample == b.sample; };
    std::stable_sort(missing.begin(), missing.end(), by_sample);
    missing.erase(std::unique(missing.begin(), missing.end(), same), missing.end());
    return missing;
  }

  /// Of the samples of others that are inside the circumsphere of a cell, the one nearest to its centre.
  std::optional<std::uint32_t> deepest_inside(Cell c) {
    const auto v = vertices_of(c);
    const Shell shell = shell_around(v);
    const double free = margin(own_vertex(v));
    if (4 * shell.squared_outer < free * free) return {};
    const auto is_inside = [&](std::uint32_t s, double squared_distance) {
      if (squared_distance < shell.squared_inner) return true;
      if (known_[s]) return false; // no sphere here has one of these inside
      looks_ += looks_as_long_as_a_test;
      const Vec3& p = position(s);
      return delaunay_->side_of_sphere(c, {p.x, p.y, p.z}, true) == CGAL::ON_BOUNDED_SIDE;
    };
    std::optional<std::uint32_t> absent;
    const auto found = blocks_.nearest(shell.centre, shell.squared_outer, range_, looks_, is_inside,
                                       [&](std::uint32_t block) { absent = absent.value_or(block); });
    if (!found && absent) wait_for(*absent, c, own_vertex(v));
    return found;
  }

  /// One block at a time: the first tetrahedra at the border are so large that all samples are in their spheres.
  void wait_for(std::uint32_t block, Cell c, std::uint32_t own) {
    wanted_.push_back(block);
    Waiting& w = waiting_.emplace_back(Waiting{c->vertex(0), c->vertex(1), c->vertex(2), c->vertex(3)});
    // It is looked for around the first; around corners of the cube there are too many.
    std::iter_swap(w.begin(), std::find_if(w.begin(), w.end(), [&](Vertex k) { return k->info() == own; }));
  }

  /// The circumcentre is off by at most a small multiple of half_the_digits, of the radius (see circumcentre), and of
  /// the rounding of coordinates.
  [[nodiscard]] Shell shell_around(const std::array<std::uint32_t, 4>& v) const {
    constexpr double doubt = 64 * std::numeric_limits<float>::epsilon(); // more than that multiple
    const Vec3& first = position(v[0]);
    const Vec3 centre = circumcentre(first, position(v[1]), position(v[2]), position(v[3]));
    const double r = distance(centre, first);
    const double inner = (1 - doubt) * r - rounding_, outer = (1 + doubt) * r + rounding_;
    // A radius without bounds, as of four samples nearly in a plane, says nothing.
    if (!(outer * outer <= std::numeric_limits<double>::max())) return {{}, 0, std::numeric_limits<double>::infinity()};
    return {centre, inner > 0 ? inner * inner : 0, outer * outer};
  }

  /// Numbers them in the engine's order.
  std::vector<Cell> number_own_cells() {
    if (delaunay_->number_of_vertices() != vertices_)
      throw Error(ErrorKind::guarantee, "delaunay", "a sample was lost", "report this as a fault of the program");
    std::vector<Cell> cells;
    for (auto c = delaunay_->finite_cells_begin(); c != delaunay_->finite_cells_end(); ++c) {
      const bool own = is_own(c);
      c->info().number = own ? static_cast<std::uint32_t>(cells.size()) : CellState::foreign;
      if (own) cells.push_back(c);
      if (cells.size() >= CellState::foreign)
        throw Error(ErrorKind::memory, "delaunay", "more than 4 billion tetrahedra", "split the cloud");
    }
    return cells;
  }

  /// The tile's own cells; afterwards there is no triangulation any more.
  Tile copy() {
    const std::vector<Cell> cells = number_own_cells();
    Tile tile;
    tile.tetrahedra.reserve(cells.size());
    tile.neighbours.reserve(cells.size());
    for (const Cell c : cells) {
      const auto v = vertices_of(c);
      auto& tetrahedron = tile.tetrahedra.emplace_back();
      auto& neighbours = tile.neighbours.emplace_back();
      const std::array<std::size_t, 4> order = canonical_order(v);
      for (std::size_t k = 0; k < 4; ++k) {
        tetrahedron[k] = VertexIndex{v[order[k]]};
        neighbours[k] = number_across(c, static_cast<int>(order[k]));
      }
    }
    report();
    delaunay_.reset(); // its half a kilobyte per sample is not needed beside ours
    return tile;
  }

  /// CellState::foreign for a cell that is not the tile's.
  [[nodiscard]] TetrahedronIndex number_across(Cell c, int corner) const {
    const Cell other = c->neighbor(corner);
    return TetrahedronIndex{delaunay_->is_infinite(other) ? no_index : other->info().number};
  }

  std::span<const Vec3> corners_;
  std::uint32_t samples_;
  const SampleBlocks& blocks_;
  SampleRange range_;
  TileProgress& progress_;
  SampleSupply* supply_;
  double rounding_ = 0; ///< of distances between coordinates; length
  std::unique_ptr<Delaunay> delaunay_ = std::make_unique<Delaunay>();
  std::vector<double> margins_;
  std::vector<bool> known_;           ///< samples of others that were inserted
  std::vector<std::uint32_t> wanted_; ///< blocks
  std::vector<Waiting> waiting_;
  std::uint64_t vertices_ = 0, asked_ = 0, looks_ = 0;
  std::uint64_t inserted_ = 0; ///< since the last report
  std::int64_t reported_cells_ = 0;
};

/// Tetrahedra by their vertices: by the first with counting, then within each first vertex.
std::vector<std::uint32_t> sorted_order(const Tile& tile, const SampleRange& range) {
  const auto& tetrahedra = tile.tetrahedra;
  auto rows = build_rows<std::uint32_t>(range.size(), [&](auto&& visit) {
    for (std::uint32_t i = 0; i < tetrahedra.size(); ++i) visit(tetrahedra[i][0].value - range.begin, i);
  });
  sort_rows(rows, Threads(1), [&](std::uint32_t a, std::uint32_t b) { return tetrahedra[a] < tetrahedra[b]; });
  return std::move(rows.item);
}

/// From the engine's order, which depends on the order of insertion, to one that does not.
void sort_tetrahedra(Tile& tile, const SampleRange& range) {
  const std::vector<std::uint32_t> order = sorted_order(tile, range);
  std::vector<std::uint32_t> rank(order.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) rank[order[i]] = i;
  std::vector<std::array<VertexIndex, 4>> tetrahedra(order.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) tetrahedra[i] = tile.tetrahedra[order[i]];
  tile.tetrahedra = std::move(tetrahedra);
  std::vector<std::array<TetrahedronIndex, 4>> neighbours(order.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) {
    neighbours[i] = tile.neighbours[order[i]];
    for (TetrahedronIndex& n : neighbours[i])
      if (n.value < order.size()) n = TetrahedronIndex{rank[n.value]};
  }
  tile.neighbours = std::move(neighbours);
}

/// Where the neighbour is of another tile.
void list_open_faces(Tile& tile) {
  for (std::uint32_t i = 0; i < tile.tetrahedra.size(); ++i)
    for (std::uint32_t k = 0; k < 4; ++k) {
      TetrahedronIndex& n = tile.neighbours[i][k];
      if (n.value != CellState::foreign) continue;
      n = {};
      OpenFace face{{}, TetrahedronIndex{i}, k};
      for (std::size_t j = 0; j < 3; ++j) face.vertices[j] = tile.tetrahedra[i][face_opposite[k][j]];
      std::sort(face.vertices.begin(), face.vertices.end());
      tile.open.push_back(face);
    }
}

} // namespace

void TileProgress::add(std::uint64_t insertions, std::int64_t tetrahedra) {
  const std::uint64_t inserted = inserted_ += insertions;
  const std::int64_t all = tetrahedra_ += tetrahedra;
  if (watch_)
    watch_(std::min(1.0, static_cast<double>(inserted) / static_cast<double>(expected_)),
           static_cast<std::uint64_t>(all));
}

std::optional<Tile> make_tile(std::span<const Vec3> corners, const SampleBlocks& blocks, const SampleRange& range,
                              TileProgress& progress, SampleSupply* supply) {
  std::optional<Tile> tile = TileMaker(corners, blocks, range, progress, supply).make();
  if (!tile) return {};
  sort_tetrahedra(*tile, range);
  list_open_faces(*tile);
  return tile;
}

} // namespace eigencrust
