// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Rigid motions from a scan's own frame to that of the file, and the sensors they tell of.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <eigencrust/types.h>

namespace eigencrust::io {

/// p -> R p + translation
struct Pose {
  std::array<Vec3, 3> rows{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}; ///< of R
  Vec3 translation;

  [[nodiscard]] bool rotates() const { return rows != Pose{}.rows; }
  [[nodiscard]] bool is_identity() const { return !rotates() && translation == Vec3{}; }
  [[nodiscard]] Vec3 rotate(const Vec3& p) const { return {dot(rows[0], p), dot(rows[1], p), dot(rows[2], p)}; }
};

/// The rotation of the quaternion w + xi + yj + zk, which need not have unit length.
/// \return false, and no rotation, when its length is zero or not finite
bool set_rotation(Pose& pose, double w, double x, double y, double z);

/// Moves the points, and turns the normals nx ny nz if there are three such attributes of floating-point
/// type. Without a rotation the points are only shifted.
void apply(const Pose& pose, PointCloud& cloud);

/// Says that one sensor saw all points.
void set_sensor(PointCloud& cloud, const Sensor& sensor);

/// Appends the sensors of `next`, whose points are about to follow those of `cloud`.
void append_sensors(PointCloud& cloud, const PointCloud& next);

} // namespace eigencrust::io
