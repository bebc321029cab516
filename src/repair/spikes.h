// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Spikes to isolated samples.
#pragma once

#include <eigencrust/stages.h>

#include "samples/neighbourhoods.h"

namespace eigencrust {

/// Cuts off spikes (and fills pits) that end in an isolated sample: where no triangle at it has a support of 0.1 (see
/// measure_support) and the first stage (`first`) settled no tetrahedron on one side of its star, that side changes,
/// if the surface stays a manifold with as many handles and pieces (not in the paper).
struct SpikeCounts {
  std::uint64_t cut = 0;
};
SpikeCounts cut_spikes(const Tetrahedralization& tetrahedralization, const VertexStars& stars, const Poles& poles,
                       const Labels& first, const Labels& known, const Neighbourhoods& neighbourhoods,
                       std::span<const float> grid_spacing, ManifoldRule rule, TetrahedronLabels& labels);

} // namespace eigencrust
