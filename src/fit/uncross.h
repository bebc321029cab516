// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Vertices that were moved so that triangles run through each other are moved back.
#pragma once

#include <cstdint>
#include <span>

#include <eigencrust/types.h>

#include "parallel/threads.h"
#include "surface/fans.h"

namespace eigencrust {

struct UncrossCounts {
  std::uint64_t crossings = 0; ///< pairs of triangles that crossed
  std::uint64_t eased = 0;     ///< vertices that went to the middle of their neighbours or back
  std::uint64_t left = 0;      ///< pairs that still cross: 0 where none did before the vertices were moved
};

/// Moves vertices until no two triangles cross (exact test) and none is degenerate: first those of such triangles to
/// the centroid of their neighbours, a few times and no farther than they had moved or than a spacing, then step by
/// step back to where they were. \param before the vertices of `mesh` before they were moved; vertices that were not
/// moved stay \param spacing coordinates are rounded to float where that moves them by less than a thousandth of it, so
/// that a
///        file of floats holds what was tested
/// \param fans of `mesh` \param rows of the vertices, which are not rounded there; empty: they are where they were
UncrossCounts uncross(std::span<const Vec3> before, double spacing, const SurfaceFans& fans, TriangleMesh& mesh,
                      const Threads& threads, std::span<const Vec3> rows = {});

} // namespace eigencrust
