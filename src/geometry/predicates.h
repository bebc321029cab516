// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Exact signs (CGAL's filtered predicates).
#pragma once

#include <eigencrust/types.h>
#include <span>

namespace eigencrust {

/// What rounding has not touched is larger than this share of the terms it was made of, by far.
inline const double half_the_digits = std::sqrt(std::numeric_limits<double>::epsilon());

/// Sign of dot(cross(b-a, c-a), d-a): +1 when d sees the triangle abc counter-clockwise, 0 when coplanar.
int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);
/// Of a positively oriented tetrahedron abcd: +1 when p is inside its circumsphere, 0 on it, -1 outside.
int side_of_sphere(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, const Vec3& p);
bool collinear(const Vec3& a, const Vec3& b, const Vec3& c);
/// Sign of the first component of cross(b-a, c-a), x before y before z, that is not 0; 0 when collinear.
int normal_sign(const Vec3& a, const Vec3& b, const Vec3& c);

/// Dimension of the smallest flat that holds all points: -1 (no point) to 3.
int affine_dimension(std::span<const Vec3> points);

} // namespace eigencrust
