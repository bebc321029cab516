// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Principal axes of a neighbourhood.
#pragma once

#include <array>
#include <span>

#include <eigencrust/types.h>

namespace eigencrust {

/// Mean and principal axes of some points.
struct LocalFrame {
  Vec3 mean;
  std::array<Vec3, 3> axis;         ///< unit, orthogonal; by increasing variance: axis[0] is the normal of a flat place
  std::array<double, 3> variance{}; ///< along the axes, increasing, >= 0

  /// Is the neighbourhood wider than it is thick?
  [[nodiscard]] bool is_flat() const { return variance[0] < flat_ratio * flat_ratio * variance[1]; }

 private:
  static constexpr double flat_ratio = 0.5; // thickness over the second deviation
};

/// Of points[index[0]], points[index[1]] ...; computed relative to `near`, so that nothing cancels.
/// \param weight of each index; empty: all the same
LocalFrame local_frame(std::span<const Vec3> points, std::span<const std::uint32_t> index, const Vec3& near,
                       std::span<const double> weight = {});

} // namespace eigencrust
