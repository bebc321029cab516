// SPDX-License-Identifier: GPL-3.0-or-later
#include "tetrahedra/circumsphere.h"

#include <CGAL/Exact_rational.h>
#include <CGAL/Simple_cartesian.h>

#include "geometry/predicates.h"

namespace eigencrust {
namespace {

Vec3 exact_circumcentre(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  using Exact = CGAL::Simple_cartesian<CGAL::Exact_rational>;
  const auto exact = [](const Vec3& p) { return Exact::Point_3(p.x, p.y, p.z); };
  const Exact::Point_3 centre = CGAL::circumcenter(exact(a), exact(b), exact(c), exact(d));
  return {CGAL::to_double(centre.x()), CGAL::to_double(centre.y()), CGAL::to_double(centre.z())};
}

} // namespace

Vec3 circumcentre(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 u = b - a, v = c - a, w = d - a;
  const Vec3 vw = cross(v, w), wu = cross(w, u), uv = cross(u, v);
  const double volume = dot(u, vw); // six times the signed volume
  // The rounding error of `volume` is a few ulp of |u||v||w|.
  // Negated, so that underflow and NaN also take the exact way.
  const double uu = squared_norm(u), vv = squared_norm(v), ww = squared_norm(w);
  if (!(volume * volume > half_the_digits * half_the_digits * uu * vv * ww)) return exact_circumcentre(a, b, c, d);
  const Vec3 numerator = uu * vw + (vv * wu + ww * uv);
  return a + (1 / (2 * volume)) * numerator;
}

} // namespace eigencrust
