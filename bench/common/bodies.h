// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Surfaces that are known: what a cloud was sampled from and what a result is held against.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include <eigencrust/types.h>

namespace eigencrust::bench {

/// What is known of the true surface. Lengths are in the unit of the cloud.
struct Truth {
  std::shared_ptr<const TriangleMesh> mesh; ///< outward, maybe in pieces that overlap; null: not known
  double volume = 0;                        ///< of the solid; 0: not known
  std::uint32_t components = 1;             ///< of the surface
  std::int64_t genus = 0;                   ///< sum over the components
  std::function<bool(const Vec3&)> inside;  ///< null unless it is known by formula
  double area = 0;                          ///< of the surface; 0: not known
};

/// Radius of the bumpy sphere in the direction of the unit vector u:
///
///     r(u) = 1 + 0.1/3 (sin(6 u.x + 1) + sin(5 u.y + 2) + sin(7 u.z))
///
/// Three waves of one direction each: between 0.9 and 1.1, star-shaped about the origin.
double bumpy_radius(const Vec3& u);

/// p moved along its direction from `centre` onto the bumpy sphere around it.
Vec3 on_bumpy_sphere(const Vec3& p, const Vec3& centre = {});

/// The bumpy sphere as 20 · 4^levels triangles, vertices on the surface.
Truth bumpy_sphere(const Vec3& centre = {}, unsigned levels = 7);

/// Torus around an axis parallel to z.
Truth torus(double major, double minor, const Vec3& centre = {});

/// A ball with a concentric cavity: two components.
Truth nested_spheres(double outer, double inner);

/// The unit ball united with a flat square plate through its centre: 3 × 3, `thickness` along y. The mesh is
/// the outer surface but for one row of fine triangles along the seam; it is not closed there.
Truth ball_with_sheet(double thickness);

/// Both bodies; they must not touch.
Truth side_by_side(const Truth& a, const Truth& b);

/// A closed mesh as the truth; one that faces inward is turned.
Truth truth_of(TriangleMesh mesh);

} // namespace eigencrust::bench
