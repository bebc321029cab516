// SPDX-License-Identifier: GPL-3.0-or-later
#include "evidence/hidden.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <limits>
#include <vector>

#include "tetrahedra/segment_walk.h"

namespace eigencrust {
namespace {

// What a sample was seen through is free, whatever else is hidden there: a line along the axis may slip between the
// samples of a sheet.
constexpr std::int32_t worth_of_sight = 2;
// A sheet of samples at random places has few longer edges, in spacings.
constexpr double longest_in_sheet = 3;

/// Is what two tetrahedra have in common a face among neighbouring samples, as those of a sheet are?
bool is_in_sheet(const Scene& scene, TetrahedronIndex one, TetrahedronIndex other) {
  const Tetrahedralization& t = scene.tetrahedralization;
  std::array<SampleIndex, 3> face;
  std::size_t common = 0;
  for (const VertexIndex v : t.tetrahedra[one])
    if (const auto& w = t.tetrahedra[other]; std::find(w.begin(), w.end(), v) != w.end()) {
      if (t.is_corner(v) || common == face.size()) return false;
      face[common++] = t.sample(v);
    }
  if (common < face.size()) return false;
  double longest = 0, spacing = 0;
  for (std::size_t k = 0; k < face.size(); ++k) {
    longest = std::max(longest, distance(t.positions[face[k]], t.positions[face[(k + 1) % face.size()]]));
    spacing += static_cast<double>(scene.measures.model.spacing[face[k]]) / static_cast<double>(face.size());
  }
  return longest <= longest_in_sheet * spacing;
}

/// visit(tetrahedron) for those that the line crosses, up to the next sheet of samples: what lies behind that is not
/// hidden by the line's own sample, which may well have been seen from there. \return whether there was none
template <class Visit>
bool cross_to_next_sheet(const Scene& scene, const SightLine& line, const Visit& visit) {
  const Tetrahedralization& t = scene.tetrahedralization;
  const auto depth = static_cast<double>(line.depth);
  const Vec3 start = t.positions[line.sample], way = line.target - start, direction = (1 / norm(way)) * way;
  SegmentWalk walk(t, scene.stars, line.sample, line.target);
  bool has_left = false; // its own sheet
  for (TetrahedronIndex last; walk.next(); last = walk.tetrahedron()) {
    const TetrahedronIndex at = walk.tetrahedron();
    if (has_left && is_in_sheet(scene, last, at)) return false;
    const Vec3 middle = start + (walk.depth() + walk.exit_depth()) / 2 * direction;
    // As lines of sight: near the samples nothing is told.
    if (std::any_of(t.tetrahedra[at].begin(), t.tetrahedra[at].end(),
                    [&](VertexIndex v) { return squared_norm(t.positions[v] - middle) <= depth * depth; }))
      continue;
    has_left = true;
    visit(at);
  }
  return true;
}

/// How many lines go through each tetrahedron. Whole numbers: any order gives the same.
struct Tallies {
  explicit Tallies(std::size_t n) : hidden(n), free(n) {}
  std::vector<std::atomic<std::int32_t>> hidden; ///< by samples, less what they were seen through
  std::vector<std::atomic<std::int32_t>> free;   ///< up to the hull
};

/// The lines of a sample, behind it and before it.
void add_lines(const Scene& scene, const SightLine& behind, const SightLine& before, const Labels& named,
               std::vector<TetrahedronIndex>& crossed, Tallies& tallies) {
  const auto add = [&](TetrahedronIndex at, std::int32_t worth) {
    if (named[at] != Label::outside) tallies.hidden[at.value].fetch_add(worth, std::memory_order_relaxed);
  };
  cross_to_next_sheet(scene, behind, [&](TetrahedronIndex at) { add(at, 1); });
  crossed.clear();
  const bool is_free = cross_to_next_sheet(scene, before, [&](TetrahedronIndex at) { crossed.push_back(at); });
  for (const TetrahedronIndex at : crossed) {
    add(at, -worth_of_sight);
    if (is_free) tallies.free[at.value].fetch_add(1, std::memory_order_relaxed);
  }
}

} // namespace

HiddenCounts count_hidden(const Scene& scene, const Vec3& front, bool all_seen, SampleLengthsView depth,
                          const Labels& named, const Threads& threads) {
  const Tetrahedralization& t = scene.tetrahedralization;
  Box3 box;
  for (SampleIndex s{0}; s.value < t.sample_count; ++s.value) box.add(t.positions[VertexIndex(s)]);
  const Vec3 way = box.diagonal() * front;
  Tallies tallies(t.tetrahedra.size());
  for_blocks(threads, t.sample_count, costly_block, [&](std::size_t begin, std::size_t end, std::size_t) {
    std::vector<TetrahedronIndex> crossed;
    for (SampleIndex s{static_cast<std::uint32_t>(begin)}; s.value < end; ++s.value) {
      if (scene.measures.model.isolated[s] > 0) continue;
      const Vec3& place = t.positions[VertexIndex(s)];
      add_lines(scene, {s, depth[s], place - way}, {s, depth[s], place + way}, named, crossed, tallies);
    }
  });
  HiddenCounts hidden(t.tetrahedra.size());
  for_each_index(threads, hidden.size(), [&](std::size_t i) {
    constexpr std::int32_t most = std::numeric_limits<std::uint8_t>::max();
    const std::int32_t sum = tallies.hidden[i].load(std::memory_order_relaxed);
    const std::int32_t free = all_seen ? tallies.free[i].load(std::memory_order_relaxed) : 0;
    hidden.raw()[i] =
        static_cast<std::int16_t>(std::clamp(sum > 0 ? sum : std::max(-free, sum / worth_of_sight), -most, most));
  });
  return hidden;
}

void label_hidden(const HiddenCounts& hidden, Labels& labels) {
  for (TetrahedronIndex i{0}; i.value < labels.size(); ++i.value) {
    if (labels[i] != Label::unlabelled) continue;
    if (hidden[i] < 0) labels[i] = Label::outside;
    if (hidden[i] >= worth_of_sight) labels[i] = Label::inside;
  }
}

} // namespace eigencrust
