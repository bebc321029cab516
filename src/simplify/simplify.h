// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Fewer triangles, as near as may be to the surface (not in the paper; docs/decisions/0041).
#pragma once

#include <cstdint>

#include <eigencrust/report.h>
#include <eigencrust/types.h>

#include "parallel/threads.h"
#include "simplify/deviation.h"

namespace eigencrust {

/// What is asked for; either or both.
struct SimplifyGoal {
  std::size_t triangles = 0; ///< as few as these; 0: as few as may be
  double max_error = 0;      ///< the largest distance either way, as it is measured; infinity: any
};

/// A mesh with other triangles.
struct OtherTriangles {
  TriangleMesh mesh;          ///< without attributes
  DeviationReport deviation;  ///< from the one before
  std::uint64_t held = 0;     ///< vertices before that stay where triangles would cross or be too far off
  std::uint64_t crossing = 0; ///< pairs of triangles that cross all the same, and degenerate triangles
};

/// Collapses edges until the goal is reached or nothing more can go: the mesh stays as closed, as manifold and of the
/// genus that it is, with all its pieces and rims. Where triangles cross afterwards or are too far off, the vertices
/// that these were made from stay, and it is done again.
/// \param full    manifold, oriented
/// \param surface of `full`
/// \param spacing coordinates are rounded to float where that moves them by less than a thousandth of it
OtherTriangles simplify(const TriangleMesh& full, const FullSurface& surface, const SimplifyGoal& goal, double spacing,
                        const Threads& threads);

} // namespace eigencrust
