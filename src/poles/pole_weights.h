// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The weight of pole pairs, which the pole graph and the vote for the sign share.
#pragma once

#include <eigencrust/types.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace eigencrust {

/// How far poles agree is kept in a byte, see PoleLabels: this is all.
constexpr std::uint8_t full_trust = std::numeric_limits<std::uint8_t>::max();

/// §3.1: what goes with the cosine in the exponents of all weights.
constexpr double steepness = 4;

/// §3.1, opposite sides: -e^(4+4cosφ), where φ is the angle at which the two spheres through s meet.
inline double opposite_weight(const Vec3& s, const Sphere& a, const Sphere& b) {
  const double cosine = -dot(a.centre - s, b.centre - s) / (norm(a.centre - s) * norm(b.centre - s));
  return -std::exp(steepness * (1 + std::clamp(cosine, -1.0, 1.0)));
}

} // namespace eigencrust
