// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Coordinates that a file of floats holds as they are.
#pragma once

#include <cmath>

#include <eigencrust/types.h>

namespace eigencrust {

// Rounding may move a vertex by so small a share of the spacing: what the writer of files allows, too.
constexpr double rounding_shares = 1000;

/// The nearest float where that moves it by less than a thousandth of the spacing.
inline double as_float(double x, double spacing) {
  const auto result = static_cast<double>(static_cast<float>(x));
  return std::fabs(result - x) < spacing / rounding_shares ? result : x;
}
inline Vec3 as_floats(const Vec3& p, double spacing) {
  return {as_float(p.x, spacing), as_float(p.y, spacing), as_float(p.z, spacing)};
}

} // namespace eigencrust
