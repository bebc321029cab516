// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Leaving out rows of a cloud before the work: --crop and --thin.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <eigencrust/types.h>

namespace eigencrust::cli {

/// What is kept: a box with its sides along the axes, or all that lies above and below a polygon in x and y.
struct Crop {
  Box3 box;                                   ///< sides included; used where there are no corners
  std::vector<std::array<double, 2>> corners; ///< of the polygon, in order

  [[nodiscard]] bool holds(const Vec3& p) const;
};
/// Two corners of a box, x,y,z,x,y,z or x,y,x,y for all heights; a polygon x,y;x,y;x,y; or a file with a row x y for
/// each of its corners. \throws Error
Crop parse_crop(const std::string& text);

/// Rows that lie in it, in order; rows that are not finite do not.
std::vector<std::uint32_t> rows_within(const std::vector<Vec3>& points, const Crop& crop);

/// Of each cube of the grid with this edge the row nearest to its middle (of several the one with the smallest
/// coordinates), in order: the same points for any order of the rows. Rows that are not finite go.
/// \throws Error{usage} where the edge is too short for the coordinates
std::vector<std::uint32_t> thinned_rows(const std::vector<Vec3>& points, double edge);

/// Leaves these rows, which increase, of points, attributes, scan numbers and sensors.
void keep_rows(PointCloud& cloud, const std::vector<std::uint32_t>& rows);

} // namespace eigencrust::cli
