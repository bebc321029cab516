// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What coordinates tell of how they were written: values that mean "no data", 32 bits far from 0, degrees.
#pragma once

#include <string>
#include <vector>

#include <eigencrust/types.h>

namespace eigencrust::io {

/// Leaves out the points of which a coordinate is -9999 (or one of its like), far from all others, or the largest
/// float. \return a sentence where there were any
std::vector<std::string> drop_no_data(PointCloud& cloud);

/// A sentence for each thing that is odd about the coordinates: steps of 32-bit numbers, degrees beside metres.
std::vector<std::string> doubt_coordinates(const std::vector<Vec3>& points);

} // namespace eigencrust::io
