// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Noise on point clouds, and what is thin beside it.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

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

/// A sample for each unit of the area of eight square bars between two rails, four spacings thick, five apart.
inline Points fence() {
  constexpr double bar = 4, apart = 9, height = 60, width = 7 * apart + bar;
  std::vector<std::array<Vec3, 2>> parts{{Vec3{0, 0, 0}, Vec3{width, bar, bar}},
                                         {Vec3{0, 0, height}, Vec3{width, bar, height + bar}}};
  for (double x = 0; x < width; x += apart) parts.push_back({Vec3{x, 0, bar}, Vec3{x + bar, bar, height}});
  Random random(3);
  Points points;
  for (const auto& [lo, hi] : parts) {
    const Vec3 size = hi - lo, x{size.x, 0, 0}, y{0, size.y, 0}, z{0, 0, size.z};
    for (const auto& [u, v] : {std::pair{x, y}, std::pair{y, z}, std::pair{x, z}})
      for (const Vec3& corner : {lo, hi - u - v}) cover(corner, u, v, random, points);
  }
  std::erase_if(points, [&](const Vec3& p) {
    return std::count_if(parts.begin(), parts.end(), [&](const auto& part) {
             const auto& [lo, hi] = part;
             return p.x >= lo.x && p.x <= hi.x && p.y >= lo.y && p.y <= hi.y && p.z >= lo.z && p.z <= hi.z;
           }) > 1;
  });
  return points;
}
inline constexpr double volume_of_fence = 4 * 4 * (2 * 67 + 8 * 56);

} // namespace eigencrust::clouds
