// SPDX-License-Identifier: GPL-3.0-or-later
#include "evidence/hidden.h"

#include <algorithm>
#include <atomic>
#include <limits>
#include <vector>

#include "evidence/next_sheet.h"

namespace eigencrust {
namespace {

// What a sample was seen through is free, whatever else is hidden there: a line along the axis may slip between the
// samples of a sheet.
constexpr std::int32_t worth_of_sight = 2;

/// How many lines go through each tetrahedron. Whole numbers: any order gives the same.
struct Tallies {
  explicit Tallies(std::size_t n) : hidden(n), free(n) {}
  std::vector<std::atomic<std::int32_t>> hidden; ///< by samples, less what they were seen through
  std::vector<std::atomic<std::int32_t>> free;   ///< up to the hull
};

/// The lines of a sample, behind it and before it. What lies behind the next sheet is not hidden by the line's own
/// sample: it may well have been seen from there.
void add_lines(const Scene& scene, const SightLine& behind, const SightLine& before, const Labels& named,
               std::vector<TetrahedronIndex>& crossed, Tallies& tallies) {
  const auto add = [&](TetrahedronIndex at, std::int32_t worth) {
    if (named[at] != Label::outside) tallies.hidden[at.value].fetch_add(worth, std::memory_order_relaxed);
  };
  cross_to_next_sheet(scene, behind, [&](TetrahedronIndex at, double) { add(at, 1); });
  crossed.clear();
  const bool is_free = cross_to_next_sheet(scene, before, [&](TetrahedronIndex at, double) { crossed.push_back(at); });
  for (const TetrahedronIndex at : crossed) {
    add(at, -worth_of_sight);
    if (is_free) tallies.free[at.value].fetch_add(1, std::memory_order_relaxed);
  }
}

} // namespace

HiddenCounts count_hidden(const Scene& scene, const Vec3& front, SampleLengthsView depth, const Labels& named,
                          const Threads& threads) {
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
    const std::int32_t free = tallies.free[i].load(std::memory_order_relaxed);
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
