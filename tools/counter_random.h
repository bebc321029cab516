// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Random numbers named by counters: the same numbers in any order, on any number of threads, with any
/// standard library.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

namespace eigencrust::tools {

/// The random numbers of one ray. A number depends on seed, sensor, ray and draw alone.
class CounterRandom {
 public:
  CounterRandom(std::uint64_t seed, std::uint64_t sensor, std::uint64_t ray)
      : key_(mix(mix(mix(seed) + step * (sensor + 1)) + step * (ray + 1))) {}

  /// Uniform in [0, 1).
  [[nodiscard]] double uniform(std::uint64_t draw) const {
    return static_cast<double>(mix(key_ + step * (draw + 1)) >> 11) * 0x1p-53;
  }

  /// Standard normal (Box and Muller 1958); uses draws `draw` and `draw + 1`.
  [[nodiscard]] double normal(std::uint64_t draw) const {
    const double radius = std::sqrt(-2 * std::log(1 - uniform(draw))); // 1 - u is in (0, 1]
    return radius * std::cos(2 * std::numbers::pi * uniform(draw + 1));
  }

 private:
  /// Increment and finalizer of SplitMix64 (Steele, Lea and Flood 2014).
  static constexpr std::uint64_t step = 0x9e3779b97f4a7c15;
  static constexpr std::uint64_t mix(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
    z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
    return z ^ (z >> 31);
  }

  std::uint64_t key_;
};

} // namespace eigencrust::tools
