// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Sensors that are told point by point.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <eigencrust/types.h>

namespace eigencrust::io {

/// Attributes that say where the sensor of each point stood.
struct SensorColumns {
  std::string names;        ///< as the file has them, for messages
  std::vector<Vec3> places; ///< one per point, perhaps not finite
};
/// The attributes sx sy sz, x_origin y_origin z_origin, vp_x vp_y vp_z and their like (in upper or lower case), if the
/// cloud has them.
std::optional<SensorColumns> find_sensor_columns(const PointCloud& cloud);

} // namespace eigencrust::io
