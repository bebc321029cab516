// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What 64-bit coordinates can tell apart.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include <eigencrust/types.h>

namespace eigencrust {

/// Far from zero neighbouring numbers may be farther apart than that.
/// \param points relative to the origin
inline bool is_resolved(double length, std::span<const Vec3> points, const Vec3& origin) {
  double largest = 0;
  for (const Vec3& p : points)
    for (const double c : {p.x + origin.x, p.y + origin.y, p.z + origin.z}) largest = std::max(largest, std::fabs(c));
  return length > 4 * std::numeric_limits<double>::epsilon() * largest;
}

} // namespace eigencrust
