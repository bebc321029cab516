// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Sensors that are told point by point.
#pragma once

#include <span>

#include <eigencrust/types.h>

namespace eigencrust {

/// Says where the sensor of each point stood; equal places are one sensor, in the order in which they first
/// appear. Points whose place is not finite have none.
/// \param places as many as there are points
void set_sensor_rows(PointCloud& cloud, std::span<const Vec3> places);

} // namespace eigencrust
