// SPDX-License-Identifier: GPL-3.0-or-later
#include "evidence/sensor_rows.h"

#include <cstdint>
#include <unordered_map>

#include "geometry/place_hash.h"

namespace eigencrust {

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
