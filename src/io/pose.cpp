// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/pose.h"

#include <cmath>
#include <cstring>

#include "surface/scalar.h"

namespace eigencrust::io {
namespace {

Attribute* find_normal(PointCloud& cloud, const char* name) {
  for (Attribute& attribute : cloud.attributes)
    if (attribute.name == name && !attribute.is_list && is_floating(attribute.type)) return &attribute;
  return nullptr;
}

void store(Attribute& attribute, std::size_t row, double value) {
  with_scalar(attribute.type, [&]<class T>(std::type_identity<T>) {
    const T narrow = static_cast<T>(value);
    std::memcpy(attribute.values.data() + row * sizeof(T), &narrow, sizeof(T));
  });
}

void rotate_normals(const Pose& pose, PointCloud& cloud) {
  Attribute* const x = find_normal(cloud, "nx");
  Attribute* const y = find_normal(cloud, "ny");
  Attribute* const z = find_normal(cloud, "nz");
  if (x == nullptr || y == nullptr || z == nullptr) return;
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const auto value = [i](const Attribute* a) { return load_as_double(a->type, a->values.data(), i); };
    const Vec3 normal = pose.rotate({value(x), value(y), value(z)});
    store(*x, i, normal.x);
    store(*y, i, normal.y);
    store(*z, i, normal.z);
  }
}

} // namespace

bool set_rotation(Pose& pose, double w, double x, double y, double z) {
  const double length = std::hypot(std::hypot(w, x), std::hypot(y, z));
  if (!std::isfinite(length) || length == 0) return false;
  w /= length;
  x /= length;
  y /= length;
  z /= length;
  pose.rows = {{{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
                {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
                {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}}};
  return true;
}

void apply(const Pose& pose, PointCloud& cloud) {
  if (pose.is_identity()) return;
  if (!pose.rotates()) {
    for (Vec3& p : cloud.points) p = p + pose.translation;
    return;
  }
  for (Vec3& p : cloud.points) p = pose.rotate(p) + pose.translation;
  rotate_normals(pose, cloud);
}

void set_sensor(PointCloud& cloud, const Sensor& sensor) {
  cloud.sensors.assign(1, sensor);
  cloud.sensor_of.assign(cloud.points.size(), 0);
}

void append_sensors(PointCloud& cloud, const PointCloud& next) {
  if (cloud.sensor_of.empty() && next.sensor_of.empty()) {
    cloud.sensors.insert(cloud.sensors.end(), next.sensors.begin(), next.sensors.end());
    return;
  }
  const auto first = static_cast<std::uint32_t>(cloud.sensors.size());
  cloud.sensor_of.resize(cloud.points.size(), PointCloud::no_sensor);
  cloud.sensors.insert(cloud.sensors.end(), next.sensors.begin(), next.sensors.end());
  if (next.sensor_of.empty()) cloud.sensor_of.resize(cloud.points.size() + next.points.size(), PointCloud::no_sensor);
  for (const std::uint32_t sensor : next.sensor_of)
    cloud.sensor_of.push_back(sensor == PointCloud::no_sensor ? sensor : first + sensor);
}

} // namespace eigencrust::io
