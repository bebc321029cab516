// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <nlohmann/json.hpp>

#include <eigencrust/memory_forecast.h>
#include <eigencrust/stages.h>

#include "command.h"

namespace eigencrust::cli {
namespace {

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

using Notes = std::vector<std::vector<std::string>>;

constexpr std::size_t most_sensors = 1000; ///< listed one by one

void collect_sensors(const PointCloud& cloud, nlohmann::ordered_json& json) {
  std::vector<std::uint64_t> seen(cloud.sensors.size(), 0);
  std::uint64_t without = cloud.sensor_of.empty() ? cloud.points.size() : 0;
  for (const std::uint32_t sensor : cloud.sensor_of)
    if (sensor == PointCloud::no_sensor)
      ++without;
    else
      ++seen[sensor];
  json["sensor_count"] = cloud.sensors.size();
  json["points_without_sensor"] = without;
  json["sensors"] = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < std::min(most_sensors, cloud.sensors.size()); ++i) {
    const Sensor& s = cloud.sensors[i];
    json["sensors"].push_back(
        {{s.at_infinity ? "direction" : "position", {s.place.x, s.place.y, s.place.z}}, {"points", seen[i]}});
  }
}

using Json = nlohmann::ordered_json;

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

nlohmann::ordered_json collect(const PointCloud& cloud, const std::vector<InputFile>& files, const Notes& notes,
                               const Threads& threads) {
  nlohmann::ordered_json json;
  for (std::size_t i = 0; i < files.size(); ++i) {
    // Columns are told of all files together; each has its part of them.
    const double share = static_cast<double>(files[i].points) / std::max(1.0, static_cast<double>(cloud.points.size()));
    const auto further = static_cast<std::uint64_t>(share * static_cast<double>(further_bytes(cloud)));
    json["files"].push_back({{"path", files[i].path},
                             {"sha256", files[i].sha256},
                             {"points", files[i].points},
                             {"notes", notes[i]},
                             {"forecast", json_of(forecast(files[i].points, further))}});
  }
  json["points"] = cloud.points.size();
  std::uint32_t scans = cloud.points.empty() ? 0 : 1;
  for (const std::uint32_t scan : cloud.scan_index) scans = std::max(scans, scan + 1);
  json["scans"] = scans;
  collect_sensors(cloud, json);
  json["attributes"] = nlohmann::ordered_json::array();
  for (const Attribute& a : cloud.attributes)
    json["attributes"].push_back({{"name", a.name}, {"type", name_of(a.type)}, {"list", a.is_list}});
  collect_samples(cloud, threads, json);
  json["forecast"] = json_of(forecast(cloud));
  json["forecast"]["memory_available_bytes"] = available_memory_bytes();
  return json;
}

std::string show(const nlohmann::ordered_json& v) {
  return "(" + rounded(v[0].get<double>()) + ", " + rounded(v[1].get<double>()) + ", " + rounded(v[2].get<double>()) +
         ")";
}

/// With the digits that tell places far from the origin apart.
std::string show_place(const nlohmann::ordered_json& v) {
  std::array<char, 100> text{};
  std::snprintf(text.data(), text.size(), "(%.10g, %.10g, %.10g)", v[0].get<double>(), v[1].get<double>(),
                v[2].get<double>());
  return text.data();
}

void print_sensors(const nlohmann::ordered_json& j) {
  constexpr std::size_t most_printed = 10;
  const auto count = j["sensor_count"].get<std::uint64_t>(), without = j["points_without_sensor"].get<std::uint64_t>();
  if (count == 0) {
    std::cout << "  sensors: none known\n";
    return;
  }
  std::cout << "  sensors: " << grouped(count);
  const auto& sensors = j["sensors"];
  for (std::size_t i = 0; i < std::min(most_printed, sensors.size()); ++i) {
    const bool at_infinity = sensors[i].contains("direction");
    std::cout << (i == 0 ? " at " : ", ")
              << (at_infinity ? "infinity along " + show_place(sensors[i]["direction"])
                              : show_place(sensors[i]["position"]));
  }
  if (count > most_printed) std::cout << ", ...";
  if (without > 0) std::cout << "; " << grouped(without) << " points without";
  std::cout << "\n";
}

void print_samples(const nlohmann::ordered_json& j) {
  std::cout << "  distinct " << grouped(j["distinct"].get<std::uint64_t>()) << ", duplicates "
            << grouped(j["duplicates"].get<std::uint64_t>()) << ", not finite "
            << grouped(j["nonfinite"].get<std::uint64_t>()) << ", scans " << j["scans"] << "\n";
  if (!j["bounds"].is_null())
    std::cout << "  bounds " << show(j["bounds"]["min"]) << " to " << show(j["bounds"]["max"]) << ", diagonal "
              << rounded(j["bounds"]["diagonal"].get<double>()) << "\n";
  if (!j["unusable"].is_null()) {
    std::cout << "  no surface can be made of it: " << j["unusable"].get<std::string>() << "\n";
    return;
  }
  std::cout << "  spacing (median distance to the nearest point) " << rounded(j["spacing"].get<double>()) << "\n";
  const double grid = j["grid_spacing"].get<double>();
  std::cout << "  grid spacing of the scans "
            << (grid > 0 ? rounded(grid) + " (from the scans)" : "not known (the scans are not told apart)") << "\n";
}

/// "620 MB, about 13 s": a forecast has no more than two digits.
std::string show_forecast(const nlohmann::ordered_json& f) {
  const auto seconds = f["seconds"].get<double>();
  const double unit = seconds > 0 ? std::pow(10, std::floor(std::log10(seconds)) - 1) : 1;
  return describe_bytes(f["memory_bytes"].get<std::uint64_t>()) + ", about " +
         rounded(std::round(seconds / unit) * unit) + " s";
}

void print_forecast(const nlohmann::ordered_json& j) {
  const auto available = j["forecast"]["memory_available_bytes"].get<std::uint64_t>();
  std::cout << "  forecast of reconstruct: " << show_forecast(j["forecast"]);
  if (j["points"] > 0)
    std::cout << " (" << rounded(1e6 * j["forecast"]["seconds"].get<double>() / j["points"].get<double>())
              << " microseconds per point)";
  if (available > 0) std::cout << "; " << describe_bytes(available) << " of memory are available";
  std::cout << "\n";
}

void print(const nlohmann::ordered_json& j) {
  for (const auto& f : j["files"]) {
    std::cout << printable(f["path"].get<std::string>()) << ": " << grouped(f["points"].get<std::uint64_t>())
              << " points";
    if (j["files"].size() > 1) std::cout << ", forecast " << show_forecast(f["forecast"]);
    std::cout << "\n";
    for (const auto& note : f["notes"]) std::cout << "  " << printable(note.get<std::string>()) << "\n";
  }
  print_samples(j);
  print_forecast(j);
  print_sensors(j);
  if (j["attributes"].empty()) return;
  std::cout << "  attributes";
  for (const auto& a : j["attributes"])
    std::cout << " " << printable(a["name"].get<std::string>()) << ":" << a["type"].get<std::string>()
              << (a["list"].get<bool>() ? "[]" : "");
  std::cout << "\n";
}

} // namespace

int info_verb(const Arguments& arguments) {
  InputOptions input;
  bool json = false;
  unsigned threads = 0;
  OptionTable app("What is in a point cloud.", "eigencrust info");
  add_input_options(app, input);
  app.begin_chapter("Running");
  app.add_flag("--json", json, "Print the figures as JSON");
  app.add_option("--threads", threads, "Threads, 0 for all cores")->capture_default_str();
  if (const Parsed parsed = parse(app, arguments); parsed.done) return parsed.status;
  ReadReport read;
  const PointCloud cloud = read_inputs(input, read);
  const Threads team(threads);
  const nlohmann::ordered_json figures = collect(cloud, read.files, read.notes, team);
  if (json)
    std::cout << figures.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) << "\n";
  else
    print(figures);
  return 0;
}

} // namespace eigencrust::cli
