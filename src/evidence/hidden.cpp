// SPDX-License-Identifier: GPL-3.0-or-later
#include "evidence/hidden.h"

#include <algorithm>

namespace eigencrust {
namespace {

/// Adds `sign` for each line that crosses it to each tetrahedron.
void count_lines(const Scene& scene, const Vec3& way, int sign, SampleLengthsView depth, const Labels& named,
                 const Threads& threads, IndexedArray<TetrahedronIndex, std::int32_t>& sum) {
  const Tetrahedralization& t = scene.tetrahedralization;
  std::vector<SightLine> lines;
  lines.reserve(t.sample_count);
  for (SampleIndex s{0}; s.value < t.sample_count; ++s.value)
    lines.push_back({s, depth[s], t.positions[VertexIndex(s)] + way});
  const SightCrossings crossings = sight_crossings(t, scene.stars, lines, Weights::evidence, named, threads);
  for (const TetrahedronIndex i : crossings.tetrahedra) sum[i] += sign;
}

} // namespace

HiddenCounts count_hidden(const Scene& scene, const Vec3& front, SampleLengthsView depth, const Labels& named,
                          const Threads& threads) {
  const Tetrahedralization& t = scene.tetrahedralization;
  Box3 box;
  for (SampleIndex s{0}; s.value < t.sample_count; ++s.value) box.add(t.positions[VertexIndex(s)]);
  const Vec3 way = box.diagonal() * front;
  IndexedArray<TetrahedronIndex, std::int32_t> sum(t.tetrahedra.size(), 0);
  count_lines(scene, -1.0 * way, 1, depth, named, threads, sum);
  count_lines(scene, way, -1, depth, named, threads, sum);
  HiddenCounts hidden(sum.size());
  for_each_index(threads, sum.size(),
                 [&](std::size_t i) { hidden.raw()[i] = static_cast<std::uint8_t>(std::clamp(sum.raw()[i], 0, 255)); });
  return hidden;
}

} // namespace eigencrust
