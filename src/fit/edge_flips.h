// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Of the two ways to draw two triangles between four vertices, the one that lies nearer to the surface that bends
/// through them (not in the paper; docs/decisions/0048).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <eigencrust/stages.h>

#include "parallel/threads.h"

namespace eigencrust {

struct EdgeFlipCounts {
  std::uint64_t triangles = 0; ///< that are other ones now
  std::uint64_t crossings = 0; ///< pairs of triangles that crossed, where edges stayed as they were instead
};

/// Flips edges between two triangles that the samples bear out, where the other diagonal of the four vertices is nearer
/// to the surface that the normals at the vertices tell of (a data-dependent triangulation: Dyn, Levin, Rippa 1990).
/// Vertices, rims, genus and pieces stay; support is the least of the triangles in whose place there is another; no
/// triangle crosses another (exact test) where none did before. \param longest of each vertex: how long an edge of
/// its new triangles may be; 0: none is flipped there
/// \param view of each vertex: which way its sensor is, a unit vector; it must have seen new triangles; zero: unknown;
///        empty: all are
EdgeFlipCounts flip_edges(std::vector<float> longest, std::span<const Vec3> view, Surface& surface,
                          const Threads& threads);

} // namespace eigencrust
