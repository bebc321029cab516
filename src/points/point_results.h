// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What is said of each input row: is it on the surface, and which way does it look.
#pragma once

#include <eigencrust/stages.h>

#include "tetrahedra/scene.h"

namespace eigencrust {

/// One entry per row, as in Result; all empty unless the options ask for them.
struct PointResults {
  std::vector<std::uint8_t> inlier;
  std::vector<float> confidence;
  std::vector<Vec3> normals;
};
/// The stage points, if the options ask for it.
PointResults point_results(const PointCloud& cloud, const Scene& scene, const Surface& surface, const Context& context);

} // namespace eigencrust
