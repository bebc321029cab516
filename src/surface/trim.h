// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What was invented.
#pragma once

#include <eigencrust/report.h>
#include <eigencrust/stages.h>

#include "samples/sample_model.h"
#include "samples/scales.h"
#include "surface/range_grid.h"

namespace eigencrust {

/// In spacings: edges twice as long as a surface has them lead over what was not sampled.
inline constexpr double longest_kept = 2 * longest_edge;
/// Cosine of 85°: a scanner sees no surface at a flatter angle; triangles that do lie so lead from one depth to
/// another.
inline constexpr double flattest_seen = 0.08716;

/// The triangles that the samples do not bear out (1): their support is below 1/4, or their longest edge exceeds 10
/// times the smallest local spacing of their vertices (of isolated ones: that of the surface nearest to them), or no
/// line of sight of their vertices meets their front within 85° of the normal, in a one-sided scan: none of some vertex
/// (not in the paper; docs/decisions/0020). Where a scanner's grid knows all three vertices it decides instead of
/// support and lines. Expects surface.support. \param lines as sight_lines() gives them; may be empty
std::vector<std::uint8_t> unsupported_triangles(const Tetrahedralization& tetrahedralization, const SampleModel& model,
                                                std::span<const SightLine> lines, bool one_sided, const RangeGrid& grid,
                                                const Surface& surface, const Threads& threads);
/// The share of the surface's area that is marked.
double share_of_area(const Surface& surface, std::span<const std::uint8_t> marked);
/// Of the triangles marked those that are at the rim, or joined to it by others that are marked.
std::vector<std::uint8_t> marked_at_rim(const TriangleMesh& mesh, std::span<const std::uint8_t> marked);
/// What unsupported_triangles() marked, its share, and where it is wide.
struct UnsupportedTriangles {
  std::vector<std::uint8_t> marked;
  double share_of_area = 0;
  BridgedReport bridged;
};
/// The places where marked triangles hang together along edges. \param origin of the surface's coordinates
BridgedReport bridged_places(const Surface& surface, std::span<const std::uint8_t> marked, const SampleModel& model,
                             const Vec3& origin, const Threads& threads);
/// Takes away the triangles marked, and then, at vertices with several fans, all but the largest fan: an oriented
/// manifold surface stays one, with boundary.
void trim(std::vector<std::uint8_t> unsupported, Surface& surface);
/// Rims of three edges, in which no sample is missing, get the triangle between them if it is a face and the piece has
/// another rim. Its support is 0, and what was cut away may have left one label on either side of it.
void close_smallest_rims(const Tetrahedralization& tetrahedralization, const VertexStars& stars, Surface& surface);

} // namespace eigencrust
