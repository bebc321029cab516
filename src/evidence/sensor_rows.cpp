// SPDX-License-Identifier: GPL-3.0-or-later
#include "evidence/sensor_rows.h"

#include <array>
#include <cstdint>
#include <functional>
#include <string_view>
#include <unordered_map>

namespace eigencrust {
namespace {

struct PlaceHash {
  std::size_t operator()(const Vec3& p) const {
    const std::array key{p.x + 0.0, p.y + 0.0, p.z + 0.0}; // -0 is 0
    return std::hash<std::string_view>()({reinterpret_cast<const char*>(key.data()), sizeof key});
  }
};

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

} // namespace eigencrust
