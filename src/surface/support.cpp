// SPDX-License-Identifier: GPL-3.0-or-later
// How well the samples bear out each triangle (not in the paper; docs/decisions/0004).
#include <algorithm>

#include <eigencrust/stages.h>

#include "parallel/threads.h"
#include "surface/support.h"
#include "surface/triangle_support.h"

namespace eigencrust {
namespace {

/// Across the triangle of v that has no other vertex of `inside`.
TetrahedronIndex across(const Tetrahedralization& t, TetrahedronIndex inside, const std::array<SampleIndex, 3>& v) {
  for (std::size_t k = 0; k < 4; ++k)
    if (std::find(v.begin(), v.end(), t.tetrahedra[inside][k]) == v.end()) return t.neighbours[inside][k];
  return {};
}

} // namespace

void measure_support(const Tetrahedralization& t, const TetrahedronLabels& labels, const SampleModel& model,
                     std::span<const float> grid_spacing, Surface& surface, const Threads& threads) {
  const TriangleSupport support(t, labels, model, grid_spacing);
  surface.support.resize(surface.mesh.triangles.size());
  for_each_index(threads, surface.support.size(), [&](std::size_t i) {
    std::array<SampleIndex, 3> v;
    for (std::size_t k = 0; k < 3; ++k) v[k] = surface.sample_of[surface.mesh.triangles[i][k]];
    surface.support[i] = support(v, surface.inside[i], across(t, surface.inside[i], v));
  });
}

} // namespace eigencrust
