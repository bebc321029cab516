// SPDX-License-Identifier: GPL-3.0-or-later
#include "settle/outside_regions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <queue>
#include <tuple>
#include <utility>

#include "geometry/distinct_numbers.h"
#include "geometry/mesh_topology.h"
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
  sort_distinct(samples);
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
  const double squared_twice_area = squared_norm(cross(a, b));
  if (!(squared_twice_area > 0) || !(unit > 0)) return 0;
  return std::sqrt(squared_norm(a) / squared_twice_area * squared_norm(b) * squared_norm(b - a)) / (2 * unit);
}

OutsideRegions::OutsideRegions(const Scene& scene, const Labels& labels, const Labels& known, const Threads& threads)
    : scene_(scene), labels_(labels), region_(labels.size(), none) {
  const PassedFaces passes = passed_faces(threads);
  DisjointSets sets(labels.size());
  for_each(passes, [&](TetrahedronIndex i, TetrahedronIndex n, std::size_t) {
    sets.unite(i.value, n.value);
    region_[i] = region_[n] = 0;
  });
  // By region: how many tetrahedra, none where some are known to be outside.
  std::vector<std::uint32_t> unknown(labels.size());
  for (TetrahedronIndex i{0}; i.value < labels.size(); ++i.value) {
    if (region_[i] == none) continue;
    std::uint32_t& count = unknown[region_[i] = sets.find(i.value)];
    if (known[i] == Label::outside)
      count = none;
    else if (count != none)
      ++count;
  }
  list_unknown(passes, unknown);
}

/// Of each tetrahedron those to neighbours with smaller numbers: bit k: a ball gets through face k.
OutsideRegions::PassedFaces OutsideRegions::passed_faces(const Threads& threads) const {
  PassedFaces passes(labels_.size());
  for_each_index(threads, labels_.size(), [&](std::size_t at) {
    const TetrahedronIndex i{static_cast<std::uint32_t>(at)};
    if (labels_[i] != Label::outside) return;
    for (std::size_t k = 0; k < 4; ++k) {
      const TetrahedronIndex n = scene_.tetrahedralization.neighbours[i][k];
      if (n.valid() && n < i && labels_[n] == Label::outside && clearance(scene_, i, k) >= passing_ball)
        passes[i] = static_cast<std::uint8_t>(passes[i] | 1 << k);
    }
  });
  return passes;
}

template <class Visit>
void OutsideRegions::for_each(const PassedFaces& passes, Visit&& visit) const {
  for (TetrahedronIndex i{0}; i.value < passes.size(); ++i.value)
    for (std::size_t k = 0; passes[i] >> k != 0; ++k)
      if ((passes[i] >> k & 1) != 0) visit(i, scene_.tetrahedralization.neighbours[i][k], k);
}

/// What has no room is no region but a gap between samples.
void OutsideRegions::list_unknown(const PassedFaces& passes, const std::vector<std::uint32_t>& tetrahedra) {
  // With each tetrahedron a region gets one corner more at most.
  const auto may_have_room = [&](std::uint32_t region) { return tetrahedra[region] + 3 >= fewest_samples; };
  std::map<std::uint32_t, UnknownRegion> regions;
  for (TetrahedronIndex i{0}; i.value < region_.size(); ++i.value) {
    if (region_[i] == none || tetrahedra[region_[i]] == none) continue;
    if (may_have_room(region_[i]))
      regions[region_[i]].tetrahedra.push_back(i);
    else
      region_[i] = none;
  }
  if (regions.empty()) return;
  for_each(passes, [&](TetrahedronIndex i, TetrahedronIndex, std::size_t k) {
    if (region_[i] == none || tetrahedra[region_[i]] == none) return;
    double& widest = regions[region_[i]].widest;
    widest = std::max(widest, clearance(scene_, i, k));
  });
  for (auto& [number, region] : regions) {
    region.number = number;
    region.samples = samples_of(scene_.tetrahedralization, region.tetrahedra);
    if (region.widest >= room * passing_ball && region.samples.size() >= fewest_samples)
      unknown_.push_back(std::move(region));
    else
      for (const TetrahedronIndex gap : region.tetrahedra) region_[gap] = none;
  }
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
