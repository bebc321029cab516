// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// May these coordinates be stored as float32?
#pragma once

#include <span>
#include <string>
#include <vector>

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

/// Formats that hold float32 only: what is subtracted so that no vertex moves by more than allowed and different ones
/// stay apart; nothing where that is true without. A warning where it is not enough for the first.
/// \param spacing median distance of neighbours; 0: the median edge
/// \throws Error{guarantee} where it is not enough for the second
Vec3 offset_for_float(const TriangleMesh& mesh, double spacing, const std::string& format,
                      std::vector<std::string>& warnings);

/// \throws Error{input} where a vertex is not finite
void require_finite(const TriangleMesh& mesh, const std::string& format);

/// float32 where it neither moves a point by much nor makes different points equal, unless the options say which.
/// \param spacing median distance of neighbours; 0: not known
CoordinateType choose_coordinates(std::span<const Vec3> points, double spacing, const WriteOptions& options);

} // namespace eigencrust::io
