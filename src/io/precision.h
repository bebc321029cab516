// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// May these coordinates be stored as float32?
#pragma once

#include <span>

#include <eigencrust/io.h>
#include <eigencrust/types.h>

namespace eigencrust::io {

/// Rounding may move a point by this part of the spacing.
constexpr double allowed_rounding = 1e-3;

/// Median length of the triangles' edges; 0 without any of finite length.
double median_edge(const TriangleMesh& mesh);

/// The longest way that rounding p - offset to float32 moves a point of finite coordinates; infinite
/// where a coordinate exceeds the range of float32.
double rounding_error(std::span<const Vec3> points, const Vec3& offset = {});

/// Do points that differ still differ as float32(p - offset)? (0 and -0 are equal.)
bool distinct_as_float(std::span<const Vec3> points, const Vec3& offset = {});

/// float32 where it neither moves a point by much nor makes different points equal, unless the options say which.
/// \param spacing median distance of neighbours; 0: not known
CoordinateType choose_coordinates(std::span<const Vec3> points, double spacing, const WriteOptions& options);

} // namespace eigencrust::io
