// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Topology of the part of the surface around some samples, without building the surface.
#pragma once

#include <cstdint>
#include <vector>

#include <eigencrust/types.h>

namespace eigencrust {

/// Of a whole closed surface, euler = 2 (pieces - genus). When only what touches the samples changes, the
/// differences of both members tell what that did to the genus, as long as no piece falls in two elsewhere.
struct SurfacePart {
  std::int64_t euler = 0;         ///< vertices among the samples - edges + triangles that touch them
  std::int64_t closed_pieces = 0; ///< pieces all of whose vertices are among the samples
};

/// \param samples increasing, distinct
SurfacePart surface_part(const Tetrahedralization& tetrahedralization, const VertexStars& stars, const Labels& labels,
                         const std::vector<std::uint32_t>& samples);

} // namespace eigencrust
