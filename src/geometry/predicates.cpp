// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/predicates.h"

#include "geometry/exact_points.h"

namespace eigencrust {

int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return static_cast<int>(CGAL::orientation(to_cgal(a), to_cgal(b), to_cgal(c), to_cgal(d)));
}

int side_of_sphere(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, const Vec3& p) {
  return static_cast<int>(CGAL::side_of_oriented_sphere(to_cgal(a), to_cgal(b), to_cgal(c), to_cgal(d), to_cgal(p)));
}

bool collinear(const Vec3& a, const Vec3& b, const Vec3& c) {
  return CGAL::collinear(to_cgal(a), to_cgal(b), to_cgal(c));
}

int normal_sign(const Vec3& a, const Vec3& b, const Vec3& c) {
  using Point = ExactPredicates::Point_2;
  int sign = static_cast<int>(CGAL::orientation(Point(a.y, a.z), Point(b.y, b.z), Point(c.y, c.z)));
  if (sign == 0) sign = static_cast<int>(CGAL::orientation(Point(a.z, a.x), Point(b.z, b.x), Point(c.z, c.x)));
  if (sign == 0) sign = static_cast<int>(CGAL::orientation(Point(a.x, a.y), Point(b.x, b.y), Point(c.x, c.y)));
  return sign;
}

int affine_dimension(std::span<const Vec3> points) {
  if (points.empty()) return -1;
  const Vec3& a = points.front();
  std::size_t i = 1;
  while (i < points.size() && points[i] == a) ++i;
  if (i == points.size()) return 0;
  const Vec3& b = points[i];
  while (i < points.size() && collinear(a, b, points[i])) ++i;
  if (i == points.size()) return 1;
  const Vec3& c = points[i];
  while (i < points.size() && orientation(a, b, c, points[i]) == 0) ++i;
  return i == points.size() ? 2 : 3;
}

} // namespace eigencrust
