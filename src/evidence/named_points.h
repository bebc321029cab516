// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What the user's points say beyond the tetrahedra that hold them.
#pragma once

#include <eigencrust/stages.h>

namespace eigencrust {

/// A pole's ball holds no sample, so what is deep within it (nearer to its centre than half the radius) is on the
/// pole's side of the surface: poles without a label take that of the user's points there, unless they disagree.
void name_poles(const Tetrahedralization& tetrahedralization, const Poles& poles, std::span<const Vec3> outside_points,
                std::span<const Vec3> inside_points, const Threads& threads, Labels& known);

} // namespace eigencrust
