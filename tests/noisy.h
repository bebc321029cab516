// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Noise on point clouds.
#pragma once

#include <cstdint>

#include "clouds.h"
#include "counter_random.h"

namespace eigencrust::clouds {

/// Every coordinate moved by a normal deviate.
inline Points noisy(Points points, double sigma, std::uint64_t seed) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const tools::CounterRandom random(seed, 0, i);
    points[i] = points[i] + Vec3{sigma * random.normal(0), sigma * random.normal(2), sigma * random.normal(4)};
  }
  return points;
}

} // namespace eigencrust::clouds
