// SPDX-License-Identifier: GPL-3.0-or-later
// What is in a cloud, in numbers.
#include <algorithm>
#include <nlohmann/json.hpp>

#include <eigencrust/error.h>
#include <eigencrust/memory_forecast.h>
#include <eigencrust/stages.h>

namespace eigencrust {
namespace {

using Json = nlohmann::ordered_json;

const char* name_of(ScalarType type) {
  switch (type) {
    case ScalarType::int8:
      return "int8";
    case ScalarType::uint8:
      return "uint8";
    case ScalarType::int16:
      return "int16";
    case ScalarType::uint16:
      return "uint16";
    case ScalarType::int32:
      return "int32";
    case ScalarType::uint32:
      return "uint32";
    case ScalarType::float32:
      return "float32";
    case ScalarType::float64:
      return "float64";
  }
  return "?";
}

constexpr std::size_t most_sensors = 1000; ///< listed one by one

void collect_sensors(const PointCloud& cloud, Json& json) {
  std::vector<std::uint64_t> seen(cloud.sensors.size(), 0);
  std::uint64_t without = cloud.sensor_of.empty() ? cloud.points.size() : 0;
  for (const std::uint32_t sensor : cloud.sensor_of)
    if (sensor == PointCloud::no_sensor)
      ++without;
    else
      ++seen[sensor];
  json["sensor_count"] = cloud.sensors.size();
  json["points_without_sensor"] = without;
  json["sensors"] = Json::array();
  for (std::size_t i = 0; i < std::min(most_sensors, cloud.sensors.size()); ++i) {
    const Sensor& s = cloud.sensors[i];
    json["sensors"].push_back(
        {{s.at_infinity ? "direction" : "position", {s.place.x, s.place.y, s.place.z}}, {"points", seen[i]}});
  }
}

Json json_of(const Forecast& f) { return {{"memory_bytes", f.memory_bytes}, {"seconds", f.seconds}}; }

Json json_of(const Box3& b) {
  return {{"min", {b.min.x, b.min.y, b.min.z}}, {"max", {b.max.x, b.max.y, b.max.z}}, {"diagonal", b.diagonal()}};
}

/// What can be said of points that no surface can be made of.
void collect_unusable(const std::vector<Vec3>& points, const Error& why, Json& json) {
  std::vector<Vec3> finite;
  Box3 box;
  for (const Vec3& p : points)
    if (is_finite(p)) {
      finite.push_back(p);
      box.add(p);
    }
  json["nonfinite"] = points.size() - finite.size();
  const std::size_t rows = finite.size();
  std::sort(finite.begin(), finite.end());
  finite.erase(std::unique(finite.begin(), finite.end()), finite.end());
  json["distinct"] = finite.size();
  json["duplicates"] = rows - finite.size();
  json["bounds"] = rows > 0 ? json_of(box) : Json();
  json["spacing"] = json["grid_spacing"] = nullptr;
  json["unusable"] = why.cause() + "; " + why.remedy();
}

void collect_samples(const PointCloud& cloud, const Threads& threads, Json& json) {
  try {
    const Samples samples = prepare_samples(cloud.points, threads);
    json["distinct"] = samples.positions.size();
    json["duplicates"] = samples.duplicates;
    json["nonfinite"] = samples.nonfinite;
    json["bounds"] = json_of(samples.bounds);
    json["spacing"] = median_spacing(samples, cloud.points, {}, threads);
    json["grid_spacing"] = resolve_grid_spacing({}, samples, cloud.points, cloud.scan_index, threads);
    json["unusable"] = nullptr;
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::input) throw;
    collect_unusable(cloud.points, error, json);
  }
}

} // namespace

std::string info_json(const PointCloud& cloud, unsigned threads) {
  const Threads team(threads);
  Json json;
  json["points"] = cloud.points.size();
  std::uint32_t scans = cloud.points.empty() ? 0 : 1;
  for (const std::uint32_t scan : cloud.scan_index) scans = std::max(scans, scan + 1);
  json["scans"] = scans;
  collect_sensors(cloud, json);
  json["attributes"] = Json::array();
  for (const Attribute& a : cloud.attributes)
    json["attributes"].push_back({{"name", a.name}, {"type", name_of(a.type)}, {"list", a.is_list}});
  collect_samples(cloud, team, json);
  json["forecast"] = json_of(forecast(cloud));
  json["forecast"]["memory_available_bytes"] = available_memory_bytes();
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

} // namespace eigencrust
