// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The volume within triangles, and how many of its digits are true.
#pragma once

#include <cmath>
#include <limits>

#include <eigencrust/types.h>

namespace eigencrust {

/// By the divergence theorem: the sum over the triangles of the volumes under them.
struct SignedVolume {
  double value = 0;
  double rounding = 0; ///< how wrong `value` may be: needles have volumes that no digit of the sum shows

  /// \param a, b, c relative to one origin for all triangles
  void add(const Vec3& a, const Vec3& b, const Vec3& c) {
    // Each of the ten roundings of a product is at most half a unit of the last place of its largest term.
    constexpr double roundings = 10 * std::numeric_limits<double>::epsilon();
    const Vec3 u = b - a, v = c - a;
    value += dot(a, cross(u, v)) / 6;
    rounding += roundings * norm(a) * norm(u) * norm(v) / 6;
  }
  friend SignedVolume operator+(const SignedVolume& a, const SignedVolume& b) {
    return {a.value + b.value, a.rounding + b.rounding};
  }

  /// 0 where rounding hides it.
  [[nodiscard]] double known() const { return std::fabs(value) > rounding ? value : 0; }
};

} // namespace eigencrust
