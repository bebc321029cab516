// SPDX-License-Identifier: GPL-3.0-or-later
#include "evidence/hidden.h"

#include <algorithm>
#include <array>
#include <atomic>

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
/// hidden by the line's own sample, which may well have been seen from there.
template <class Visit>
void cross_to_next_sheet(const Scene& scene, const SightLine& line, const Visit& visit) {
  const Tetrahedralization& t = scene.tetrahedralization;
  const auto depth = static_cast<double>(line.depth);
  const Vec3 start = t.positions[line.sample], way = line.target - start, direction = (1 / norm(way)) * way;
  SegmentWalk walk(t, scene.stars, line.sample, line.target);
  bool has_left = false; // its own sheet
  for (TetrahedronIndex last; walk.next(); last = walk.tetrahedron()) {
    const TetrahedronIndex at = walk.tetrahedron();
    if (has_left && is_in_sheet(scene, last, at)) return;
    const Vec3 middle = start + (walk.depth() + walk.exit_depth()) / 2 * direction;
    // As lines of sight: near the samples nothing is told.
    if (std::any_of(t.tetrahedra[at].begin(), t.tetrahedra[at].end(),
                    [&](VertexIndex v) { return squared_norm(t.positions[v] - middle) <= depth * depth; }))
      continue;
    has_left = true;
    visit(at);
  }
}

} // namespace

HiddenCounts count_hidden(const Scene& scene, const Vec3& front, SampleLengthsView depth, const Labels& named,
                          const Threads& threads) {
  const Tetrahedralization& t = scene.tetrahedralization;
  Box3 box;
  for (SampleIndex s{0}; s.value < t.sample_count; ++s.value) box.add(t.positions[VertexIndex(s)]);
  const Vec3 way = box.diagonal() * front;
  std::vector<std::atomic<std::int32_t>> sum(t.tetrahedra.size()); // whole numbers: any order gives the same
  for_each_index(
      threads, t.sample_count,
      [&](std::size_t i) {
        const SampleIndex s{static_cast<std::uint32_t>(i)};
        for (const bool is_behind : {true, false}) {
          const SightLine line{s, depth[s], t.positions[VertexIndex(s)] + (is_behind ? -1.0 : 1.0) * way};
          cross_to_next_sheet(scene, line, [&](TetrahedronIndex at) {
            if (named[at] != Label::outside)
              sum[at.value].fetch_add(is_behind ? 1 : -worth_of_sight, std::memory_order_relaxed);
          });
        }
      },
      costly_block);
  HiddenCounts hidden(sum.size());
  for_each_index(threads, sum.size(), [&](std::size_t i) {
    hidden.raw()[i] = static_cast<std::uint8_t>(std::clamp(sum[i].load(std::memory_order_relaxed), 0, 255));
  });
  return hidden;
}

} // namespace eigencrust
