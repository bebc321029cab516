// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// How far a surface is from the true one, and how wrongly it is turned.
#pragma once

#include <eigencrust/types.h>

namespace eigencrust::bench {

struct SurfaceError {
  double to_truth = 0, from_truth = 0; ///< mean distance of points spread over one surface to the other
  double normals = 0;                  ///< mean angle between the normals at those pairs of points, degrees
};

/// Of 100,000 points on each surface.
SurfaceError surface_error(const TriangleMesh& mesh, const TriangleMesh& truth, unsigned threads);

} // namespace eigencrust::bench
