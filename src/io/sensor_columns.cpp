// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/sensor_columns.h"

#include <array>
#include <bit>
#include <cstdint>
#include <unordered_map>

#include <eigencrust/io.h>

#include "io/text.h"

namespace eigencrust::io {
namespace {

struct PlaceHash {
  std::size_t operator()(const Vec3& p) const {
    std::uint64_t hash = 0;
    for (const double c : {p.x, p.y, p.z}) // multiply by the golden ratio, fold the upper bits in
      hash = (hash ^ std::bit_cast<std::uint64_t>(c == 0 ? 0.0 : c)) * 0x9e3779b97f4a7c15u, hash ^= hash >> 29;
    return hash;
  }
};

/// Names of columns by which programs tell where the sensor stood.
constexpr std::array<std::array<const char*, 3>, 3> usual_names = {
    {{"sx", "sy", "sz"}, {"x_origin", "y_origin", "z_origin"}, {"vp_x", "vp_y", "vp_z"}}};

const Attribute* find_column(const PointCloud& cloud, const char* name) {
  for (const Attribute& attribute : cloud.attributes)
    if (!attribute.is_list && equal_ignoring_case(attribute.name, name)) return &attribute;
  return nullptr;
}

} // namespace

void set_sensor_rows(PointCloud& cloud, std::span<const Vec3> places) {
  std::unordered_map<Vec3, std::uint32_t, PlaceHash> numbers;
  cloud.sensors.clear();
  cloud.sensor_of.assign(places.size(), PointCloud::no_sensor);
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (!is_finite(places[i])) continue;
    if (i > 0 && places[i] == places[i - 1]) {
      cloud.sensor_of[i] = cloud.sensor_of[i - 1];
      continue;
    }
    const auto [found, is_new] = numbers.try_emplace(places[i], static_cast<std::uint32_t>(cloud.sensors.size()));
    if (is_new) cloud.sensors.push_back({places[i], false});
    cloud.sensor_of[i] = found->second;
  }
  if (cloud.sensors.empty()) cloud.sensor_of.clear();
}

std::optional<SensorColumns> find_sensor_columns(const PointCloud& cloud) {
  for (const auto& names : usual_names) {
    std::array<const Attribute*, 3> columns{};
    for (std::size_t k = 0; k < 3; ++k) columns[k] = find_column(cloud, names[k]);
    if (columns[0] == nullptr || columns[1] == nullptr || columns[2] == nullptr) continue;
    SensorColumns found{columns[0]->name + " " + columns[1]->name + " " + columns[2]->name, {}};
    found.places.resize(cloud.points.size());
    for (std::size_t i = 0; i < found.places.size(); ++i)
      found.places[i] = {attribute_value(*columns[0], i), attribute_value(*columns[1], i),
                         attribute_value(*columns[2], i)};
    return found;
  }
  return std::nullopt;
}

} // namespace eigencrust::io
