// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/camera.h"

#include <cmath>
#include <numbers>

#include <eigencrust/error.h>

namespace eigencrust {
namespace {

Vec3 normalized(const Vec3& v) { return (1 / norm(v)) * v; }

} // namespace

View make_view(const RenderOptions& options) {
  const double length = norm(options.up);
  if (!(length > 0) || !std::isfinite(length))
    throw Error(ErrorKind::usage, "render", "the up axis has no direction", "give an axis such as 0,1,0");
  for (const double angle : {options.azimuth, options.elevation, options.roll})
    if (!std::isfinite(angle))
      throw Error(ErrorKind::usage, "render", "an angle of the camera is not a number", "give degrees");
  const Vec3 up = (1 / length) * options.up;
  // At azimuth 0 the x axis runs to the right (the y axis where x is up).
  const Vec3 sideways = std::fabs(up.x) < 0.9 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const Vec3 right0 = normalized(sideways - dot(sideways, up) * up);
  const Vec3 front0 = cross(right0, up);

  constexpr double degree = std::numbers::pi / 180;
  const double azimuth = options.azimuth * degree, elevation = options.elevation * degree, roll = options.roll * degree;
  const Vec3 level_back = std::cos(azimuth) * front0 + std::sin(azimuth) * right0;
  View view;
  view.back = std::cos(elevation) * level_back + std::sin(elevation) * up;
  const Vec3 right = std::cos(azimuth) * right0 - std::sin(azimuth) * front0;
  const Vec3 above = cross(view.back, right);
  // The camera turns clockwise, so the picture turns the other way.
  view.right = std::cos(roll) * right - std::sin(roll) * above;
  view.up = std::cos(roll) * above + std::sin(roll) * right;
  view.width = options.width;
  view.height = options.height;
  return view;
}

} // namespace eigencrust
