// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A range image knows its camera.
#pragma once

#include <eigencrust/types.h>

namespace eigencrust::io {

/// Where the points of the one grid of a cloud without sensors lie on rays from the origin through equal pixels of a
/// plane, the sensor is at the origin: that is how depth cameras write their frames.
/// \return whether it was set
bool set_sensor_from_grid(PointCloud& cloud);

} // namespace eigencrust::io
