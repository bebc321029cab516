// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The point of a triangle that is nearest to another; degenerate triangles are welcome.
#pragma once

#include <array>

#include <eigencrust/types.h>

namespace eigencrust {

using Corners = std::array<Vec3, 3>;

inline Vec3 nearest_on_segment(const Vec3& a, const Vec3& b, const Vec3& p) {
  const Vec3 ab = b - a;
  const double length2 = squared_norm(ab);
  if (!(length2 > 0)) return a;
  const double t = dot(p - a, ab) / length2;
  if (t <= 0) return a;
  if (t >= 1) return b;
  return a + t * ab;
}

inline Vec3 nearest_on_triangle(const Corners& c, const Vec3& p) {
  const Vec3 ab = c[1] - c[0], ac = c[2] - c[0];
  const Vec3 n = cross(ab, ac);
  const double n2 = squared_norm(n);
  // Below this aspect the normal is rounding noise and the edges say it all.
  if (n2 > 1e-24 * squared_norm(ab) * squared_norm(ac)) {
    const Vec3 pa = p - c[0], pb = p - c[1];
    if (dot(cross(ab, pa), n) >= 0 && dot(cross(c[2] - c[1], pb), n) >= 0 && dot(cross(pa, ac), n) >= 0)
      return p - (dot(pa, n) / n2) * n;
  }
  Vec3 best = nearest_on_segment(c[0], c[1], p);
  for (const Vec3& q : {nearest_on_segment(c[1], c[2], p), nearest_on_segment(c[2], c[0], p)})
    if (squared_norm(q - p) < squared_norm(best - p)) best = q;
  return best;
}

} // namespace eigencrust
