// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Sensors that are told point by point.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <eigencrust/types.h>

namespace eigencrust::io {

/// Says where the sensor of each point stood; equal places are one sensor, in the order in which they first
/// appear. Points whose place is not finite have none.
/// \param places as many as there are points
void set_sensor_rows(PointCloud& cloud, std::span<const Vec3> places);

/// Attributes that say where the sensor of each point stood.
struct SensorColumns {
  std::string names;        ///< as the file has them, for messages
  std::vector<Vec3> places; ///< one per point, perhaps not finite
};
/// The attributes sx sy sz, x_origin y_origin z_origin or vp_x vp_y vp_z (in upper or lower case), if the
/// cloud has them.
std::optional<SensorColumns> find_sensor_columns(const PointCloud& cloud);

} // namespace eigencrust::io
