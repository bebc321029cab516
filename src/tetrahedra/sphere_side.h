// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The two exact signs that a Delaunay tetrahedralization is made with. Most are known after a few dozen operations
/// in double; the others are asked for exactly.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <eigencrust/types.h>

#include "geometry/predicates.h"

namespace eigencrust {

/// Points as seen from another one. Its coordinates have one rounding each.
template <std::size_t N>
struct SeenFrom {
  std::array<double, N> x, y, z;
  SeenFrom(const Vec3& eye, const std::array<const Vec3*, N>& points) {
    for (std::size_t k = 0; k < N; ++k) {
      x[k] = points[k]->x - eye.x;
      y[k] = points[k]->y - eye.y;
      z[k] = points[k]->z - eye.z;
    }
  }
  /// An upper bound of |x y z| for coordinates of any of the points.
  [[nodiscard]] double largest_product() const { return largest(x) * largest(y) * largest(z); }

 private:
  static double largest(const std::array<double, N>& numbers) {
    double result = 0;
    for (const double n : numbers) result = std::max(result, std::fabs(n));
    return result;
  }
};

/// A sign that rounding may have turned is not known, nor one of numbers so small that digits were lost below the
/// smallest, or not a number.
inline bool is_known(double determinant, double error) {
  constexpr double least = 1e-280; // far above what products of the few smallest numbers come to
  return error > least && std::fabs(determinant) > error;
}

/// Is the determinant of the triangle as seen from a point negative, zero, positive: does the point see it clockwise?
/// \return 0 where rounding leaves it open, too
inline int sign_in_double(const SeenFrom<4>& p, std::size_t a, std::size_t b, std::size_t c, double largest_product) {
  const double determinant = p.x[a] * (p.y[b] * p.z[c] - p.z[b] * p.y[c]) +
                             p.x[b] * (p.y[c] * p.z[a] - p.z[c] * p.y[a]) +
                             p.x[c] * (p.y[a] * p.z[b] - p.z[a] * p.y[b]);
  // Six products, in each of them eight roundings of 2^-53 at most: three differences, two products, three sums.
  constexpr double share = 6e-15;
  if (!is_known(determinant, share * largest_product)) return 0;
  return determinant > 0 ? 1 : -1;
}

/// The sign for cospherical points as if each was lifted by an amount of its own, that of points with larger
/// coordinates being beyond all measure larger (Devillers and Teillaud 2011).
bool is_inside_when_moved(const std::array<const Vec3*, 4>& tetrahedron, const Vec3& p);

/// Is p inside the circumsphere of a positively oriented tetrahedron? Among cospherical points the coordinates alone
/// decide, so that it is answered alike for whatever else is known.
inline bool is_inside_sphere(const std::array<const Vec3*, 4>& tetrahedron, const Vec3& p) {
  const SeenFrom<4> v(p, tetrahedron);
  const auto& [ax, bx, cx, dx] = v.x;
  const auto& [ay, by, cy, dy] = v.y;
  const auto& [az, bz, cz, dz] = v.z;
  const double ab = ax * by - bx * ay, bc = bx * cy - cx * by, cd = cx * dy - dx * cy, da = dx * ay - ax * dy;
  const double ac = ax * cy - cx * ay, bd = bx * dy - dx * by;
  std::array<double, 4> squared{};
  for (std::size_t k = 0; k < 4; ++k) squared[k] = v.x[k] * v.x[k] + (v.y[k] * v.y[k] + v.z[k] * v.z[k]);
  const double determinant = (squared[0] * (bz * cd - cz * bd + dz * bc) - squared[1] * (cz * da + dz * ac + az * cd)) +
                             (squared[2] * (dz * ab + az * bd + bz * da) - squared[3] * (az * bc - bz * ac + cz * ab));
  // Four squared lengths times six products, in each of them at most sixteen roundings of 2^-53.
  constexpr double share = 5e-14;
  const double longest = std::max(std::max(squared[0], squared[1]), std::max(squared[2], squared[3]));
  if (is_known(determinant, share * longest * longest * std::sqrt(longest))) return determinant > 0;
  const int sign = side_of_sphere(*tetrahedron[0], *tetrahedron[1], *tetrahedron[2], *tetrahedron[3], p);
  return sign != 0 ? sign > 0 : is_inside_when_moved(tetrahedron, p);
}

} // namespace eigencrust
