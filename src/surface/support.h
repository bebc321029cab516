// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// How well the samples bear out the surface.
#pragma once

#include <eigencrust/stages.h>

#include "samples/sample_model.h"

namespace eigencrust {

/// The tetrahedron in front of a triangle, across it from the one behind.
TetrahedronIndex outside_of(const Surface& surface, std::size_t triangle, const Tetrahedralization& tetrahedralization);

/// How well the samples bear out each triangle, in [0, 1]: min(1, 2.5 h / e) (1 + min(1, c)) / 2, where e is its
/// longest edge, h the mean over its vertices of the local spacing (of isolated ones: that of the surface nearest to
/// them) or of the grid spacing ℓ if that is larger, and c the contrast |x_out - x_in| of the second stage's values
/// across it (not in the paper).
void measure_support(const Tetrahedralization& tetrahedralization, const TetrahedronLabels& labels,
                     const SampleModel& model, std::span<const float> grid_spacing, Surface& surface,
                     const Threads& threads);

} // namespace eigencrust
