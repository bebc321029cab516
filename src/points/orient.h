// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Which way the samples look.
#pragma once

#include "points/classify.h"

namespace eigencrust {

/// Unit normals of the inliers, outward by the labels: angle-weighted triangle normals, averaged over as
/// many neighbours as the noise asks for; between the vertices of its place for a sample beside the surface.
/// NaN for the others.
IndexedArray<SampleIndex, Vec3> orient_samples(const Tetrahedralization& tetrahedralization, const Surface& surface,
                                               const Classification& samples, SampleLengthsView grid_spacing,
                                               const Threads& threads);

} // namespace eigencrust
