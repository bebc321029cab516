// SPDX-License-Identifier: GPL-3.0-or-later
#include "sensors.h"

#include <cmath>
#include <numbers>

#include <eigencrust/error.h>

namespace eigencrust::tools {
namespace {

constexpr std::uint32_t max_rays_across = 65536;
constexpr double degree = std::numbers::pi / 180;

Vec3 unit(const Vec3& a) { return (1 / norm(a)) * a; }

/// A unit vector square to `axis`, as near to `wish` as can be; another axis serves where wish ∥ axis.
Vec3 square_to(const Vec3& axis, const Vec3& wish) {
  for (const Vec3& candidate : {wish, Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}) {
    const double length = norm(candidate);
    if (!(length > 0) || !std::isfinite(length)) continue;
    const Vec3 rest = (1 / length) * candidate - (dot(candidate, axis) / length) * axis;
    if (norm(rest) > 1e-6) return unit(rest);
  }
  return {1, 0, 0}; // not reached: two of the three axes are far from any one vector
}

/// Right-handed frame whose third axis is `up`.
struct Frame {
  Vec3 x, y, z;
};
Frame frame_around(const Vec3& up) {
  const double length = norm(up);
  if (!(length > 0) || !std::isfinite(length))
    throw Error(ErrorKind::usage, "--up", "the up vector has no direction", "give a finite vector that is not zero");
  const Vec3 z = unit(up);
  const Vec3 x = square_to(z, {1, 0, 0});
  return {x, cross(z, x), z};
}

void check(const Sensor& s) {
  const auto refuse = [](const char* cause, const char* remedy) {
    throw Error(ErrorKind::usage, "sensor", cause, remedy);
  };
  if (!is_finite(s.position) || !is_finite(s.target))
    refuse("its position or target is not finite", "give finite numbers");
  if (!(distance(s.position, s.target) > 0)) refuse("it stands on its target", "move the sensor or --look-at");
  if (s.columns < 1 || s.rows < 1 || s.columns > max_rays_across || s.rows > max_rays_across)
    refuse("the ray grid is empty or too large", "ask for 1 to 65536 rays each way");
  if (s.projection == Projection::pinhole && !(s.field_of_view > 0 && s.field_of_view < 180))
    refuse("the field of view is out of range", "give more than 0 and less than 180 degrees");
  if (s.projection == Projection::parallel && !(s.spacing > 0 && std::isfinite(s.spacing)))
    refuse("the ray spacing is not positive", "give a length above 0");
}

} // namespace

RayGrid::RayGrid(const Sensor& sensor) : sensor_(sensor), cell_(sensor.spacing) {
  check(sensor);
  forward_ = unit(sensor.target - sensor.position);
  const Vec3 up = square_to(forward_, sensor.up);
  right_ = cross(forward_, up);
  down_ = -1 * up;
  if (sensor.projection == Projection::pinhole)
    cell_ = 2 * std::tan(0.5 * degree * sensor.field_of_view) / sensor.columns;
}

Ray RayGrid::ray(std::uint64_t index) const {
  const double column = static_cast<double>(index % sensor_.columns) - 0.5 * (sensor_.columns - 1.0);
  const double row = static_cast<double>(index / sensor_.columns) - 0.5 * (sensor_.rows - 1.0);
  const Vec3 offset = (cell_ * column) * right_ + (cell_ * row) * down_;
  if (sensor_.projection == Projection::parallel) return {sensor_.position + offset, forward_};
  return {sensor_.position, unit(forward_ + offset)};
}

std::vector<Vec3> fibonacci_directions(std::uint32_t count, const Vec3& up) {
  const Frame frame = frame_around(up);
  const double golden_angle = std::numbers::pi * (3 - std::sqrt(5.0));
  std::vector<Vec3> result;
  for (std::uint32_t i = 0; i < count; ++i) {
    const double z = 1 - (2.0 * i + 1) / count;
    const double r = std::sqrt(1 - z * z);
    result.push_back((r * std::cos(golden_angle * i)) * frame.x + (r * std::sin(golden_angle * i)) * frame.y +
                     z * frame.z);
  }
  return result;
}

std::vector<Vec3> ring_directions(std::uint32_t count, double elevation, double azimuth, const Vec3& up) {
  const Frame frame = frame_around(up);
  const double z = std::sin(degree * elevation), r = std::cos(degree * elevation);
  std::vector<Vec3> result;
  for (std::uint32_t i = 0; i < count; ++i) {
    const double angle = degree * (azimuth + 360.0 * i / count);
    result.push_back((r * std::cos(angle)) * frame.x + (r * std::sin(angle)) * frame.y + z * frame.z);
  }
  return result;
}

Sensor aim_pinhole(const Vec3& target, const Vec3& direction, double radius, double distance, std::uint32_t resolution,
                   const Vec3& up) {
  if (!(distance > radius))
    throw Error(ErrorKind::usage, "sensor", "a sensor stands within the object's bounding sphere",
                "move it away (--distance above 1) or say what it sees (--field-of-view)");
  Sensor sensor;
  sensor.position = target + distance * direction;
  sensor.target = target;
  sensor.up = up;
  sensor.columns = sensor.rows = resolution;
  sensor.field_of_view = 2 / degree * std::asin(radius / distance);
  return sensor;
}

Sensor aim_parallel(const Vec3& target, const Vec3& direction, double radius, double distance, double spacing,
                    const Vec3& up) {
  const double across = std::ceil(2 * radius / spacing) + 1;
  if (!(spacing > 0 && across <= max_rays_across))
    throw Error(ErrorKind::usage, "--parallel", "the ray spacing takes more than 65536 rays across the object",
                "give a larger spacing");
  Sensor sensor = aim_pinhole(target, direction, radius, distance, static_cast<std::uint32_t>(across), up);
  sensor.projection = Projection::parallel;
  sensor.spacing = spacing;
  return sensor;
}

std::vector<Sensor> all_around(const Vec3& place, std::uint32_t rays) {
  std::vector<Sensor> views;
  for (int axis = 0; axis < 6; ++axis) {
    Sensor view;
    view.position = place;
    view.target = place + direction_of(static_cast<Axis>(axis));
    view.columns = view.rows = rays;
    view.field_of_view = 90;
    views.push_back(view);
  }
  return views;
}

} // namespace eigencrust::tools
