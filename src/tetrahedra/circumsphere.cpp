// SPDX-License-Identifier: GPL-3.0-or-later
#include "tetrahedra/circumsphere.h"

#include <CGAL/Exact_rational.h>
#include <CGAL/Mpzf.h>
#include <CGAL/Simple_cartesian.h>

#include <array>

#include "geometry/predicates.h"

namespace eigencrust {
namespace {

#ifdef CGAL_HAS_MPZF
using Number = CGAL::Mpzf;
#else
using Number = CGAL::Exact_rational;
#endif

Vec3 rational_circumcentre(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  using Exact = CGAL::Simple_cartesian<CGAL::Exact_rational>;
  const auto exact = [](const Vec3& p) { return Exact::Point_3(p.x, p.y, p.z); };
  const Exact::Point_3 centre = CGAL::circumcenter(exact(a), exact(b), exact(c), exact(d));
  return {CGAL::to_double(centre.x()), CGAL::to_double(centre.y()), CGAL::to_double(centre.z())};
}

/// Sums and products without rounding, only the last division has it. Much faster than fractions, which are reduced.
Vec3 exact_circumcentre(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  using Vector = std::array<Number, 3>;
  const auto from_a = [&](const Vec3& p) {
    return Vector{Number(p.x) - Number(a.x), Number(p.y) - Number(a.y), Number(p.z) - Number(a.z)};
  };
  const auto product = [](const Vector& p, const Vector& q) { return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]; };
  const auto across = [](const Vector& p, const Vector& q) {
    return Vector{p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]};
  };
  const Vector u = from_a(b), v = from_a(c), w = from_a(d);
  const Vector vw = across(v, w), wu = across(w, u), uv = across(u, v);
  const double twice_volume = 2 * CGAL::to_double(product(u, vw));
  const Number uu = product(u, u), vv = product(v, v), ww = product(w, w);
  const auto offset = [&](std::size_t k) {
    return CGAL::to_double(uu * vw[k] + vv * wu[k] + ww * uv[k]) / twice_volume;
  };
  const Vec3 centre = a + Vec3{offset(0), offset(1), offset(2)};
  // Products of four lengths may be more or less than double holds.
  constexpr double least = 1e-300;
  const bool is_held = is_finite(centre) && std::fabs(twice_volume) * norm(b - a) > least;
  return is_held ? centre : rational_circumcentre(a, b, c, d);
}

} // namespace

Vec3 circumcentre(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 u = b - a, v = c - a, w = d - a;
  const Vec3 vw = cross(v, w), wu = cross(w, u), uv = cross(u, v);
  const double volume = dot(u, vw); // six times the signed volume
  const double uu = squared_norm(u), vv = squared_norm(v), ww = squared_norm(w);
  // The rounding error of `volume` is a few ulp of |u||v||w|.
  // Negated, so that underflow and NaN also take the exact way.
  if (!(volume * volume > half_the_digits * half_the_digits * uu * vv * ww)) return exact_circumcentre(a, b, c, d);
  const Vec3 numerator = uu * vw + (vv * wu + ww * uv);
  return a + (1 / (2 * volume)) * numerator;
}

} // namespace eigencrust
