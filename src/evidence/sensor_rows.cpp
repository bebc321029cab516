// SPDX-License-Identifier: GPL-3.0-or-later
#include "evidence/sensor_rows.h"

#include <bit>
#include <cstdint>
#include <unordered_map>

namespace eigencrust {
namespace {

struct PlaceHash {
  std::size_t operator()(const Vec3& p) const {
    std::uint64_t hash = 0;
    for (const double c : {p.x, p.y, p.z}) // multiply by the golden ratio, fold the upper bits in
      hash = (hash ^ std::bit_cast<std::uint64_t>(c == 0 ? 0.0 : c)) * 0x9e3779b97f4a7c15u, hash ^= hash >> 29;
    return hash;
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
