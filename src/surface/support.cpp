// SPDX-License-Identifier: GPL-3.0-or-later
// How well the samples bear out each triangle (not in the paper; docs/decisions/0004).
#include <algorithm>
#include <cmath>

#include <eigencrust/stages.h>

#include "parallel/threads.h"
#include "surface/support.h"

namespace eigencrust {
namespace {

// The longest edge of a triangle among evenly spread samples is about twice the distance to the third nearest.
constexpr double full_support = 2.5;

} // namespace

TetrahedronIndex outside_of(const Surface& surface, std::size_t triangle, const Tetrahedralization& t) {
  const TetrahedronIndex inside = surface.inside[triangle];
  const auto& v = surface.mesh.triangles[triangle];
  for (std::size_t k = 0; k < t.tetrahedra[inside].size(); ++k)
    if (std::none_of(v.begin(), v.end(),
                     [&](std::uint32_t corner) { return surface.sample_of[corner] == t.tetrahedra[inside][k]; }))
      return t.neighbours[inside][k];
  return {};
}

void measure_support(const Tetrahedralization& t, const TetrahedronLabels& labels, const SampleModel& model,
                     std::span<const float> grid_spacing, Surface& surface, const Threads& threads) {
  surface.support.resize(surface.mesh.triangles.size());
  for_each_index(threads, surface.support.size(), [&](std::size_t i) {
    std::array<SampleIndex, 3> v;
    for (std::size_t k = 0; k < 3; ++k) v[k] = surface.sample_of[surface.mesh.triangles[i][k]];
    double longest = 0, mean = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      longest = std::max(longest, distance(t.positions[v[k]], t.positions[v[(k + 1) % 3]]));
      float scale = model.spacing[v[k].value];
      if (!grid_spacing.empty()) scale = std::max(scale, grid_spacing[v[k].value]);
      mean += static_cast<double>(scale) / static_cast<double>(v.size());
    }
    const TetrahedronIndex inside = surface.inside[i], outside = outside_of(surface, i, t);
    const float contrast = outside.valid() ? std::fabs(labels.value(outside) - labels.value(inside)) : 0;
    const double sampling = std::min(1.0, full_support * mean / longest);
    surface.support[i] = static_cast<float>(sampling * (1 + std::min(1.0, static_cast<double>(contrast))) / 2);
  });
}

} // namespace eigencrust
