// SPDX-License-Identifier: GPL-3.0-or-later
// §3: the Delaunay tetrahedralization. Of a part of the samples, and of what matters of the others.
#include "tetrahedra/tile.h"

#include <algorithm>
#include <cmath>

#include <eigencrust/error.h>

#include "geometry/distinct_numbers.h"
#include "geometry/predicates.h"
#include "geometry/tetrahedron.h"
#include "parallel/compressed_rows.h"
#include "parallel/prefetch.h"
#include "tetrahedra/circumsphere.h"
#include "tetrahedra/incremental_delaunay.h"
#include "tetrahedra/insertion_rounds.h"

namespace eigencrust {
namespace {

// A sample among thousands of tetrahedra takes a thousandth of a second, any other a thousandth of that.
constexpr std::uint32_t samples_between_reports = 32;
constexpr std::uint64_t tetrahedra_between_reports = 4096; // a ten-thousandth of a second, mostly

// How many groups of samples may be looked at for each tetrahedron that is asked: about ten are of scans, and all for
// each where all samples lie on one sphere.
constexpr std::uint64_t looks_per_tetrahedron = 32;
constexpr std::uint64_t looks_that_do_not_matter = 1000000; // a hundredth of a second
constexpr std::uint64_t looks_as_long_as_a_test = 16;       // of one sample, where exact arithmetic is needed

constexpr std::uint64_t fetched_ahead = 16; // tetrahedra of about two samples

/// Which vertex goes where so that the smallest comes first and the second smallest second. Only even
/// permutations are used, so the orientation stays; with it the form is unique.
inline std::array<std::size_t, 4> canonical_order(const std::array<std::uint32_t, 4>& v) {
  const auto smaller = [&](std::size_t a, std::size_t b) { return v[a] < v[b] ? a : b; };
  const std::size_t first = smaller(smaller(0, 1), smaller(2, 3));
  const auto& rest = face_opposite[first];
  std::size_t second = v[rest[1]] < v[rest[0]] ? 1 : 0;
  second = v[rest[2]] < v[rest[second]] ? 2 : second;
  constexpr std::array<std::size_t, 5> round{0, 1, 2, 0, 1};
  return {first, rest[second], rest[round[second + 1]], rest[round[second + 2]]};
}

/// Across a face that is open, until the tile's tetrahedra are put together.
constexpr std::uint32_t foreign = no_index - 1;

/// A tetrahedron whose circumsphere holds samples that are elsewhere, perhaps: its vertices, one of the tile's first.
/// What is inserted meanwhile may end it.
using Waiting = std::array<std::uint32_t, 4>;

/// A sample inside the circumsphere of a tetrahedron.
struct Missing {
  std::uint32_t sample;
  std::uint32_t near; ///< vertex of the tetrahedron
};

class TileMaker {
 public:
  TileMaker(std::span<const Vec3> corners, const SampleBlocks& blocks, const SampleRange& range, TileProgress& progress,
            SampleSupply* supply)
      : samples_(blocks.sample_count()),
        blocks_(blocks),
        range_(range),
        progress_(progress),
        supply_(supply),
        delaunay_(own_and_corners(corners)) {
    for (std::uint32_t i = 0; i < cube_corners; ++i) others_.push_back(samples_ + i);
  }

  std::optional<Tile> make() {
    insert_own();
    if (range_.size() < samples_ && !insert_what_matters()) return {};
    report();
    Tile tile;
    number_neighbours(sort_own(tile), tile);
    return tile;
  }

 private:
  using Tetrahedron = IncrementalDelaunay::Tetrahedron;

  [[nodiscard]] std::vector<Vec3> own_and_corners(std::span<const Vec3> corners) const {
    std::vector<Vec3> points;
    points.reserve(range_.size() + corners.size());
    for (std::uint32_t i = range_.begin; i < range_.end; ++i) points.push_back(blocks_.position(i));
    points.insert(points.end(), corners.begin(), corners.end());
    return points;
  }

  /// \name Vertices: the tile's samples, the corners of the cube, samples of others
  /// @{
  [[nodiscard]] bool is_own(std::uint32_t vertex) const { return vertex < range_.size(); }
  /// The number that a vertex has in all tiles.
  [[nodiscard]] std::uint32_t sample(std::uint32_t vertex) const {
    return is_own(vertex) ? range_.begin + vertex : others_[vertex - range_.size()];
  }
  [[nodiscard]] std::array<std::uint32_t, 4> samples(const std::array<std::uint32_t, 4>& v) const {
    return {sample(v[0]), sample(v[1]), sample(v[2]), sample(v[3])};
  }
  /// \return no_index where there is none
  [[nodiscard]] std::uint32_t own_vertex(const std::array<std::uint32_t, 4>& v) const {
    const auto own = std::find_if(v.begin(), v.end(), [&](std::uint32_t i) { return is_own(i); });
    return own == v.end() ? no_index : *own;
  }
  /// @}

  std::uint32_t insert(std::uint32_t vertex, std::uint32_t near) {
    const std::uint32_t made = delaunay_.insert(vertex, near);
    if (++inserted_ % samples_between_reports == 0) report();
    return made;
  }

  void report() {
    const auto count = static_cast<std::int64_t>(delaunay_.count());
    progress_.add(std::exchange(inserted_, 0), count - std::exchange(reported_, count));
  }

  /// The tile's samples in rounds along the Hilbert curve.
  void insert_own() {
    std::uint32_t near = 0;
    for (const std::uint32_t i : in_rounds(range_.size())) near = insert(i, near);
  }

  /// \return false if it was given up
  bool insert_what_matters() {
    measure_margins();
    known_.resize(samples_);
    std::vector<std::uint32_t> open;
    for (std::uint32_t t = 0; t < delaunay_.tetrahedra().size(); ++t)
      if (delaunay_.exists(t)) open.push_back(t);
    do {
      settle(open);
    } while (fetch(open));
    return !progress_.given_up();
  }

  /// Asks tetrahedra and what stands in their place, as long as samples that are known are missing.
  void settle(std::vector<std::uint32_t>& open) {
    while (!open.empty()) {
      std::vector<std::uint32_t> fresh;
      for (const Missing& m : missing_of(open)) {
        const std::uint32_t vertex = fresh.emplace_back(delaunay_.add(blocks_.position(m.sample)));
        others_.push_back(m.sample);
        insert(vertex, delaunay_.at(m.near));
        known_[m.sample] = true;
      }
      open.clear();
      if (progress_.given_up()) return;
      for (const std::uint32_t vertex : fresh) {
        const std::vector<std::uint32_t> around = delaunay_.around(vertex);
        open.insert(open.end(), around.begin(), around.end());
      }
      sort_distinct(open);
    }
  }

  /// What tetrahedra wait for; then those are open that are still there. \return false where all is settled, everywhere
  bool fetch(std::vector<std::uint32_t>& open) {
    if (supply_ == nullptr) return false;
    sort_distinct(wanted_);
    if (!supply_->fetch(wanted_)) return false;
    wanted_.clear();
    for (const Waiting& vertices : std::exchange(waiting_, {}))
      for (const std::uint32_t t : delaunay_.around(vertices.front()))
        if (std::is_permutation(vertices.begin(), vertices.end(), delaunay_.tetrahedra()[t].vertices.begin()))
          open.push_back(t);
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

  /// What stands around the tile's samples has to be right, else there is no room for all that is the tile's.
  /// \return each sample once
  std::vector<Missing> missing_of(const std::vector<std::uint32_t>& open) {
    std::vector<Missing> missing;
    for (const std::uint32_t t : open) {
      const auto& v = delaunay_.tetrahedra()[t].vertices;
      const std::uint32_t own = own_vertex(v);
      if (own == no_index) continue;
      if (const auto sample = deepest_inside(t, own)) missing.push_back({*sample, v[0]});
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

  /// Of the samples of others that are inside the circumsphere of a tetrahedron, the one deepest inside.
  /// \param own vertex of it
  std::optional<std::uint32_t> deepest_inside(std::uint32_t t, std::uint32_t own) {
    auto v = delaunay_.tetrahedra()[t].vertices;
    // A corner of the cube may be far away, and from there all is in one place.
    std::iter_swap(v.begin(), std::find(v.begin(), v.end(), own));
    const Circumsphere sphere = circumsphere(delaunay_.position(v[0]), delaunay_.position(v[1]),
                                             delaunay_.position(v[2]), delaunay_.position(v[3]));
    if (2 * (norm(sphere.centre) + 3 * sphere.doubt) < margin(sample(own))) return {};

    const auto is_inside = [&](std::uint32_t s, const Power& power) {
      if (power.value + power.doubt < 0) return true;
      if (known_[s]) return false; // no sphere here has one of these inside
      looks_ += looks_as_long_as_a_test;
      return delaunay_.is_inside_sphere(t, blocks_.position(s));
    };
    std::optional<std::uint32_t> absent;
    const auto found = blocks_.deepest(sphere, range_, looks_, is_inside,
                                       [&](std::uint32_t block) { absent = absent.value_or(block); });
    if (!found && absent) wait_for(*absent, t, own);
    return found;
  }

  /// One block at a time: the first tetrahedra at the border are so large that all samples are in their spheres.
  void wait_for(std::uint32_t block, std::uint32_t t, std::uint32_t own) {
    wanted_.push_back(block);
    Waiting& w = waiting_.emplace_back(delaunay_.tetrahedra()[t].vertices);
    // It is looked for around the first; around corners of the cube there are too many.
    std::iter_swap(w.begin(), std::find(w.begin(), w.end(), own));
  }

  /// The tile's tetrahedra by their smallest sample.
  [[nodiscard]] CompressedRows<std::uint32_t> own_by_sample() const {
    const std::vector<Tetrahedron>& all = delaunay_.tetrahedra();
    std::vector<std::uint32_t> smallest(all.size(), no_index);
    for (std::uint32_t t = 0; t < all.size(); ++t)
      if (delaunay_.exists(t)) {
        const auto v = samples(all[t].vertices);
        smallest[t] = std::min(std::min(v[0], v[1]), std::min(v[2], v[3]));
      }
    return build_rows<std::uint32_t>(range_.size(), [&](auto&& visit) {
      for (std::uint32_t t = 0; t < all.size(); ++t)
        if (range_.holds(smallest[t])) visit(smallest[t] - range_.begin, t);
    });
  }

  /// The second and third vertex: of those with the same first one, no two tetrahedra have the same.
  [[nodiscard]] std::uint64_t sorting_key(std::uint32_t number) const {
    const auto v = samples(delaunay_.tetrahedra()[number].vertices);
    const auto order = canonical_order(v);
    return std::uint64_t{v[order[1]]} << 32 | v[order[2]];
  }

  /// The tile's tetrahedra, sorted. Their neighbours have the engine's numbers still.
  /// \return by the engine's number, which it is in the tile; foreign for those of others
  std::vector<std::uint32_t> sort_own(Tile& tile) const {
    const auto rows = own_by_sample();
    tile.tetrahedra.reserve(rows.item.size());
    tile.neighbours.reserve(rows.item.size());
    std::vector<std::uint32_t> rank(delaunay_.tetrahedra().size(), foreign);
    std::vector<std::pair<std::uint64_t, std::uint32_t>> sorted;
    for (std::uint32_t s = 0; s < range_.size(); ++s) {
      sorted.clear();
      for (const std::uint32_t t : rows[s]) sorted.emplace_back(sorting_key(t), t);
      const std::uint64_t next = rows.begin[s + 1];
      for (std::uint64_t j = next; j < std::min(next + fetched_ahead, rows.begin.back()); ++j)
        prefetch(delaunay_.tetrahedra()[rows.item[j]]);
      std::sort(sorted.begin(), sorted.end());
      for (const auto& [key, number] : sorted) {
        rank[number] = static_cast<std::uint32_t>(tile.tetrahedra.size());
        append(number, tile);
      }
    }
    return rank;
  }

  void append(std::uint32_t number, Tile& tile) const {
    const Tetrahedron& t = delaunay_.tetrahedra()[number];
    const auto v = samples(t.vertices);
    const auto order = canonical_order(v);
    auto& vertices = tile.tetrahedra.emplace_back();
    auto& neighbours = tile.neighbours.emplace_back();
    for (std::size_t k = 0; k < 4; ++k) {
      vertices[k] = VertexIndex{v[order[k]]};
      const std::uint32_t across = t.across[order[k]];
      neighbours[k] = TetrahedronIndex{across == no_index ? no_index : IncrementalDelaunay::tetrahedron_of(across)};
    }
  }

  static void number_neighbours(const std::vector<std::uint32_t>& rank, Tile& tile) {
    for (std::uint32_t i = 0; i < tile.neighbours.size(); ++i)
      for (std::uint32_t k = 0; k < 4; ++k) {
        TetrahedronIndex& n = tile.neighbours[i][k];
        if (!n.valid()) continue;
        n = TetrahedronIndex{rank[n.value]};
        if (n.value != foreign) continue;
        n = {};
        tile.open.push_back(open_face(tile, i, k));
      }
  }

  static OpenFace open_face(const Tile& tile, std::uint32_t i, std::uint32_t k) {
    OpenFace face{{}, TetrahedronIndex{i}, k};
    for (std::size_t j = 0; j < 3; ++j) face.vertices[j] = tile.tetrahedra[i][face_opposite[k][j]];
    std::sort(face.vertices.begin(), face.vertices.end());
    return face;
  }

  std::uint32_t samples_;
  const SampleBlocks& blocks_;
  SampleRange range_;
  TileProgress& progress_;
  SampleSupply* supply_;
  IncrementalDelaunay delaunay_;
  std::vector<std::uint32_t> others_; ///< samples of the vertices that are not the tile's
  std::vector<double> margins_;
  std::vector<bool> known_;           ///< samples of others that were inserted
  std::vector<std::uint32_t> wanted_; ///< blocks
  std::vector<Waiting> waiting_;
  std::uint64_t asked_ = 0, looks_ = 0;
  std::uint64_t inserted_ = 0; ///< since the last report
  std::int64_t reported_ = 0;  ///< tetrahedra
};

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
  return TileMaker(corners, blocks, range, progress, supply).make();
}

} // namespace eigencrust
