// SPDX-License-Identifier: GPL-3.0-or-later
#include "tetrahedra/circumsphere.h"

#include <CGAL/Exact_rational.h>
#include <CGAL/Mpzf.h>
#include <CGAL/Simple_cartesian.h>

#include <array>
#include <limits>

#include "geometry/predicates.h"

namespace eigencrust {
namespace {

#ifdef CGAL_HAS_MPZF
using Number = CGAL::Mpzf;
#else
using Number = CGAL::Exact_rational;
#endif

/// The circumcentre as seen from the first point.
struct Centre {
  Vec3 position;
  double squared_loss; ///< of the digits lost: 1 where the rounding of double is all
};

Centre rational_centre(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  using Exact = CGAL::Simple_cartesian<CGAL::Exact_rational>;
  const auto exact = [](const Vec3& p) { return Exact::Point_3(p.x, p.y, p.z); };
  const Exact::Vector_3 centre = CGAL::circumcenter(exact(a), exact(b), exact(c), exact(d)) - exact(a);
  return {{CGAL::to_double(centre.x()), CGAL::to_double(centre.y()), CGAL::to_double(centre.z())}, 1};
}

/// Sums and products without rounding, only the last division has it. Much faster than fractions, which are reduced.
Centre exact_centre(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
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
  const Vec3 centre{offset(0), offset(1), offset(2)};
  // Products of four lengths may be more or less than double holds.
  constexpr double least = 1e-300;
  const bool is_held = is_finite(centre) && std::fabs(twice_volume) * norm(b - a) > least;
  return is_held ? Centre{centre, 1} : rational_centre(a, b, c, d);
}

Centre centre_seen_from_first(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 u = b - a, v = c - a, w = d - a;
  const Vec3 vw = cross(v, w), wu = cross(w, u), uv = cross(u, v);
  const double volume = dot(u, vw); // six times the signed volume
  const double uu = squared_norm(u), vv = squared_norm(v), ww = squared_norm(w);
  // The rounding error of `volume` is a few ulp of |u||v||w|.
  // Negated, so that underflow and NaN also take the exact way.
  const double largest = uu * vv * ww, square = volume * volume;
  if (!(square > half_the_digits * half_the_digits * largest)) return exact_centre(a, b, c, d);
  const Vec3 numerator = uu * vw + (vv * wu + ww * uv);
  return {(1 / (2 * volume)) * numerator, largest / square};
}

} // namespace

Vec3 circumcentre(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return a + centre_seen_from_first(a, b, c, d).position;
}

Circumsphere circumsphere(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Centre centre = centre_seen_from_first(a, b, c, d);
  const double radius = norm(centre.position);
  // A radius without bounds, as of four points nearly in a plane, says nothing.
  if (!(radius * radius <= std::numeric_limits<double>::max())) return {a, {}, std::numeric_limits<double>::infinity()};
  // Edges are chords: |u||v||w| (|u| + |v| + |w|) / |2 volume| is at most three times the radius times the loss, and
  // each of its parts has about ten roundings. The same again is for those of what is compared with the sphere.
  constexpr double roundings = 64 * std::numeric_limits<double>::epsilon();
  return {a, centre.position, roundings * std::sqrt(centre.squared_loss) * radius};
}

} // namespace eigencrust
