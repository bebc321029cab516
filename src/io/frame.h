// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Affine maps by which scenes place their parts.
#pragma once

#include <array>

#include <eigencrust/types.h>

namespace eigencrust::io {

/// p -> rows · p + place.
struct Frame {
  std::array<Vec3, 3> rows = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  Vec3 place;

  [[nodiscard]] Vec3 turned(const Vec3& v) const { return {dot(rows[0], v), dot(rows[1], v), dot(rows[2], v)}; }
  [[nodiscard]] Vec3 operator()(const Vec3& p) const { return turned(p) + place; }
  /// Below 0: a mirror, which turns triangles inside out.
  [[nodiscard]] double determinant() const { return dot(rows[0], cross(rows[1], rows[2])); }
  [[nodiscard]] bool finite() const {
    return is_finite(rows[0]) && is_finite(rows[1]) && is_finite(rows[2]) && is_finite(place);
  }
  /// Directions at right angles to a surface keep that: by the cofactors, so that flat maps need no care. Not unit.
  [[nodiscard]] Vec3 turned_normal(const Vec3& n) const {
    return {dot(cross(rows[1], rows[2]), n), dot(cross(rows[2], rows[0]), n), dot(cross(rows[0], rows[1]), n)};
  }
};

/// First `inner`, then `outer`.
inline Frame operator*(const Frame& outer, const Frame& inner) {
  const auto& r = inner.rows;
  Frame both;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3& o = outer.rows[i];
    both.rows[i] = {o.x * r[0].x + o.y * r[1].x + o.z * r[2].x, o.x * r[0].y + o.y * r[1].y + o.z * r[2].y,
                    o.x * r[0].z + o.y * r[1].z + o.z * r[2].z};
  }
  both.place = outer(inner.place);
  return both;
}

} // namespace eigencrust::io
