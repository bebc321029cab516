// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Circumcentres of tetrahedra, also of slivers.
#pragma once

#include <cmath>

#include <eigencrust/types.h>

namespace eigencrust {

/// Of a point: its squared distance from the centre of a sphere less the squared radius, and by how much it may be off.
struct Power {
  double value, doubt;
};

/// As seen from a point on it: of spheres that are nearly planes, through a few samples and one far away, radius and
/// centre say nothing about what is near those samples.
struct Circumsphere {
  Vec3 eye;     ///< a point on the sphere
  Vec3 centre;  ///< as seen from there
  double doubt; ///< by how much each of the centre's coordinates may be off; infinite where it may be anywhere

  [[nodiscard]] Power power(const Vec3& p) const {
    const Vec3 seen = p - eye;
    return {dot(seen, seen - 2 * centre), 2 * doubt * (std::fabs(seen.x) + std::fabs(seen.y) + std::fabs(seen.z))};
  }
  /// No point of a convex body has less, wherever in its bounds the centre is.
  /// \param power of the body's point nearest to the centre
  [[nodiscard]] double least_of_body(const Power& power) const { return power.value - power.doubt - 6 * doubt * doubt; }
};

/// Through four points that are not coplanar, seen from the first.
Circumsphere circumsphere(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// Centre of the sphere through four points that are not coplanar. Computed in double; where that
/// would lose more than half of the digits, exactly and then rounded.
Vec3 circumcentre(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

} // namespace eigencrust
