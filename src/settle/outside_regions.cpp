// SPDX-License-Identifier: GPL-3.0-or-later
#include "settle/outside_regions.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <limits>
#include <queue>
#include <tuple>
#include <utility>

#include "geometry/tetrahedron.h"

namespace eigencrust {
namespace {

// A region in which no ball twice as large finds room, or at fewer samples, is a gap between samples, too.
constexpr double room = 2;
constexpr std::size_t fewest_samples = 100;

std::vector<SampleIndex> samples_of(const Tetrahedralization& t, std::span<const TetrahedronIndex> tetrahedra) {
  std::vector<SampleIndex> samples;
  for (const TetrahedronIndex i : tetrahedra)
    for (const VertexIndex v : t.tetrahedra[i])
      if (!t.is_corner(v)) samples.push_back(t.sample(v));
  std::sort(samples.begin(), samples.end());
  samples.erase(std::unique(samples.begin(), samples.end()), samples.end());
  return samples;
}

} // namespace

double clearance(const Scene& scene, TetrahedronIndex i, std::size_t face) {
  const Tetrahedralization& t = scene.tetrahedralization;
  const SampleModel& model = scene.measures.model;
  std::array<Vec3, 3> corner;
  double unit = 0;
  for (std::size_t k = 0; k < corner.size(); ++k) {
    const VertexIndex v = t.tetrahedra[i][face_opposite[face][k]];
    if (t.is_corner(v)) return std::numeric_limits<double>::infinity();
    corner[k] = t.positions[v];
    const SampleIndex s = t.sample(v);
    unit = std::max(unit, static_cast<double>(std::max(model.spacing[s], model.noise[s])));
  }
  const Vec3 a = corner[1] - corner[0], b = corner[2] - corner[0];
  const double twice_area = norm(cross(a, b));
  if (!(twice_area > 0) || !(unit > 0)) return 0;
  return norm(a) * norm(b) * norm(b - a) / (2 * twice_area * unit);
}

OutsideRegions::OutsideRegions(const Scene& scene, const Labels& labels, const Labels& known, const Threads& threads)
    : scene_(scene), labels_(labels), passes_(labels.size()), region_(labels.size(), none) {
  const Tetrahedralization& t = scene.tetrahedralization;
  for_each_index(threads, labels.size(), [&](std::size_t at) {
    const TetrahedronIndex i{static_cast<std::uint32_t>(at)};
    if (labels[i] != Label::outside) return;
    for (std::size_t k = 0; k < 4; ++k) {
      const TetrahedronIndex n = t.neighbours[i][k];
      if (n.valid() && labels[n] == Label::outside && clearance(scene, i, k) >= passing_ball)
        passes_[i] = static_cast<std::uint8_t>(passes_[i] | 1 << k);
    }
  });
  std::uint32_t count = 0;
  for (TetrahedronIndex i{0}; i.value < labels.size(); ++i.value) {
    if (passes_[i] == 0 || region_[i] != none) continue;
    Walk walk = walk_from(i, count, known);
    if (walk.is_known) {
      ++count;
      continue;
    }
    std::vector<SampleIndex> samples = samples_of(t, walk.tetrahedra);
    if (walk.widest >= room * passing_ball && samples.size() >= fewest_samples)
      unknown_.push_back({count++, std::move(walk.tetrahedra), std::move(samples), walk.widest});
    else
      for (const TetrahedronIndex gap : walk.tetrahedra) region_[gap] = none, passes_[gap] = 0;
  }
}

/// What can be reached from there; the tetrahedra only of a region in which nothing is known.
OutsideRegions::Walk OutsideRegions::walk_from(TetrahedronIndex start, std::uint32_t region, const Labels& known) {
  const Tetrahedralization& t = scene_.tetrahedralization;
  Walk walk;
  std::vector<TetrahedronIndex> waiting{start};
  region_[start] = region;
  while (!waiting.empty()) {
    const TetrahedronIndex i = waiting.back();
    waiting.pop_back();
    if (known[i] == Label::outside && !std::exchange(walk.is_known, true)) walk.tetrahedra.clear();
    if (!walk.is_known) walk.tetrahedra.push_back(i);
    for (std::size_t k = 0; k < 4; ++k) {
      if ((passes_[i] >> k & 1) == 0) continue;
      if (!walk.is_known) walk.widest = std::max(walk.widest, clearance(scene_, i, k));
      const TetrahedronIndex n = t.neighbours[i][k];
      if (region_[n] != none) continue;
      region_[n] = region;
      waiting.push_back(n);
    }
  }
  return walk;
}

void OutsideRegions::divide(std::span<const TetrahedronIndex> tetrahedra) {
  const Tetrahedralization& t = scene_.tetrahedralization;
  std::vector<TetrahedronIndex> open;
  const auto is_open = [&](TetrahedronIndex i) { return labels_[i] == Label::outside && region_[i] == none; };
  std::copy_if(tetrahedra.begin(), tetrahedra.end(), std::back_inserter(open), is_open);
  using Step = std::tuple<double, std::uint32_t, std::uint32_t>; // largest ball on the way, tetrahedron, region
  std::priority_queue<Step> next;
  for (const TetrahedronIndex i : open)
    for (std::size_t k = 0; k < 4; ++k)
      if (const TetrahedronIndex n = t.neighbours[i][k]; n.valid() && region_[n] != none)
        next.emplace(clearance(scene_, i, k), i.value, region_[n]);
  while (!next.empty()) {
    const auto [ball, at, from] = next.top();
    next.pop();
    const TetrahedronIndex i{at};
    if (region_[i] != none) continue;
    region_[i] = from;
    for (std::size_t k = 0; k < 4; ++k)
      if (const TetrahedronIndex n = t.neighbours[i][k];
          n.valid() && is_open(n) && std::binary_search(open.begin(), open.end(), n))
        next.emplace(std::min(ball, clearance(scene_, i, k)), n.value, from);
  }
}

} // namespace eigencrust
