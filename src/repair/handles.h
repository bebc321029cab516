// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Handles of the size of the noise.
#pragma once

#include <eigencrust/stages.h>

namespace eigencrust {

/// Closes handles that no pole vouches for: along short loops of the surface the tetrahedra that the first stage
/// left open (`first`) change sides, if that takes a handle away and leaves a manifold; the cheaper of filling and
/// cutting, by Σ |value|. Expects a manifold (not in the paper).
struct HandleCounts {
  std::uint64_t closed = 0;
};
HandleCounts close_handles(const Tetrahedralization& tetrahedralization, const VertexStars& stars, const Poles& poles,
                           const Labels& first, const Labels& known, std::span<const float> grid_spacing,
                           ManifoldRule rule, TetrahedronLabels& labels, const Threads& threads,
                           const Checkpoint& checkpoint = {});

} // namespace eigencrust
