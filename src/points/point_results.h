// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What is said of each input row: is it on the surface, and which way does it look.
#pragma once

#include <eigencrust/eigencrust.h>
#include <eigencrust/stages.h>

namespace eigencrust {

/// Fills result.inlier, confidence and normals.
/// \param grid_spacing a length per sample, or empty
void add_point_results(const PointCloud& cloud, const Tetrahedralization& tetrahedralization, const Surface& surface,
                       std::span<const float> grid_spacing, const Threads& threads, Result& result);

} // namespace eigencrust
