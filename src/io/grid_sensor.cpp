// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/grid_sensor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "io/pose.h"
#include "numerics/quantile.h"

namespace eigencrust::io {
namespace {

// So few points fit anything.
constexpr std::size_t least_points = 100;
// Lenses bend rays by less than a pixel where the camera is calibrated; nearly all must be that near.
constexpr double most_pixels = 1, nearly_all = 0.95;

/// A value at a pixel.
struct Seen {
  double column, row, value;
};

/// How far, in pixels, nearly all values are from a linear function of column and row (least squares); infinite where
/// there is none, or it does not change.
double pixels_from_linear(const std::vector<Seen>& seen) {
  Vec3 mean;
  for (const Seen& s : seen) mean = mean + (1 / static_cast<double>(seen.size())) * Vec3{s.column, s.row, s.value};
  double cc = 0, cr = 0, rr = 0, cv = 0, rv = 0;
  for (const Seen& s : seen) {
    const double c = s.column - mean.x, r = s.row - mean.y, v = s.value - mean.z;
    cc += c * c;
    cr += c * r;
    rr += r * r;
    cv += c * v;
    rv += r * v;
  }
  const double all = cc * rr - cr * cr;
  const double per_column = (cv * rr - rv * cr) / all, per_row = (rv * cc - cv * cr) / all;
  const double per_pixel = std::hypot(per_column, per_row);
  if (!(all > 0) || !(per_pixel > 0)) return HUGE_VAL;
  std::vector<double> off;
  off.reserve(seen.size());
  for (const Seen& s : seen)
    off.push_back(std::fabs(s.value - mean.z - per_column * (s.column - mean.x) - per_row * (s.row - mean.y)) /
                  per_pixel);
  return quantile(off, nearly_all);
}

/// The same for the two other coordinates, each divided by `divisor` of its point.
template <class Divisor>
double pixels_off(const PointCloud& cloud, int depth, Divisor&& divisor) {
  double worst = 0;
  for (int axis = 0; axis < 3; ++axis) {
    if (axis == depth) continue;
    std::vector<Seen> seen;
    for (std::size_t i = 0; i < cloud.points.size(); ++i) {
      const Vec3& p = cloud.points[i];
      if (cloud.cell[i] == no_index || !is_finite(p)) continue;
      const std::array<double, 3> x{p.x, p.y, p.z};
      const std::uint32_t columns = cloud.grids.front().columns;
      seen.push_back({static_cast<double>(cloud.cell[i] % columns), static_cast<double>(cloud.cell[i] / columns),
                      x[static_cast<std::size_t>(axis)] / divisor(x[static_cast<std::size_t>(depth)])});
    }
    if (seen.size() < least_points) return HUGE_VAL;
    worst = std::max(worst, pixels_from_linear(seen));
  }
  return worst;
}

/// All on one side of the camera's plane.
bool has_one_sign(const PointCloud& cloud, int axis) {
  bool above = false, below = false;
  for (const Vec3& p : cloud.points) {
    const double x = axis == 0 ? p.x : axis == 1 ? p.y : p.z;
    if (!is_finite(p)) continue;
    above = above || x >= 0;
    below = below || x <= 0;
  }
  return above != below;
}

} // namespace

bool set_sensor_from_grid(PointCloud& cloud) {
  if (!cloud.sensor_of.empty() || cloud.grids.size() != 1 || cloud.cell.size() != cloud.points.size()) return false;
  for (int axis = 0; axis < 3; ++axis) {
    if (!has_one_sign(cloud, axis)) continue;
    const double rays = pixels_off(cloud, axis, [](double depth) { return depth; });
    // Where a plane was seen, or heights over a map, parallel rays fit as well.
    if (!(rays <= most_pixels) || pixels_off(cloud, axis, [](double) { return 1.0; }) <= most_pixels) continue;
    set_sensor(cloud, {{0, 0, 0}, false});
    return true;
  }
  return false;
}

} // namespace eigencrust::io
