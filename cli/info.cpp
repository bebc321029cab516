// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <nlohmann/json.hpp>

#include <eigencrust/memory_forecast.h>

#include "command.h"

namespace eigencrust::cli {
namespace {

using Json = nlohmann::ordered_json;
using Notes = std::vector<std::vector<std::string>>;

Json json_of(const Forecast& f) { return {{"memory_bytes", f.memory_bytes}, {"seconds", f.seconds}}; }

Json collect(const PointCloud& cloud, const std::vector<InputFile>& files, const Notes& notes, unsigned threads) {
  Json json;
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
  json.update(Json::parse(info_json(cloud, threads)));
  return json;
}

std::string show(const Json& v) {
  return "(" + rounded(v[0].get<double>()) + ", " + rounded(v[1].get<double>()) + ", " + rounded(v[2].get<double>()) +
         ")";
}

/// With the digits that tell places far from the origin apart.
std::string show_place(const Json& v) {
  std::array<char, 100> text{};
  std::snprintf(text.data(), text.size(), "(%.10g, %.10g, %.10g)", v[0].get<double>(), v[1].get<double>(),
                v[2].get<double>());
  return text.data();
}

void print_sensors(const Json& j) {
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

void print_samples(const Json& j) {
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
std::string show_forecast(const Json& f) {
  const auto seconds = f["seconds"].get<double>();
  const double unit = seconds > 0 ? std::pow(10, std::floor(std::log10(seconds)) - 1) : 1;
  return describe_bytes(f["memory_bytes"].get<std::uint64_t>()) + ", about " +
         rounded(std::round(seconds / unit) * unit) + " s";
}

void print_forecast(const Json& j) {
  const auto available = j["forecast"]["memory_available_bytes"].get<std::uint64_t>();
  std::cout << "  forecast of reconstruct: " << show_forecast(j["forecast"]);
  if (j["points"] > 0)
    std::cout << " (" << rounded(1e6 * j["forecast"]["seconds"].get<double>() / j["points"].get<double>())
              << " microseconds per point)";
  if (available > 0) std::cout << "; " << describe_bytes(available) << " of memory are available";
  std::cout << "\n";
}

void print(const Json& j) {
  for (const auto& f : j["files"]) {
    std::cout << f["path"].get<std::string>() << ": " << grouped(f["points"].get<std::uint64_t>()) << " points";
    if (j["files"].size() > 1) std::cout << ", forecast " << show_forecast(f["forecast"]);
    std::cout << "\n";
    for (const auto& note : f["notes"]) std::cout << "  " << note.get<std::string>() << "\n";
  }
  print_samples(j);
  print_forecast(j);
  print_sensors(j);
  if (j["attributes"].empty()) return;
  std::cout << "  attributes";
  for (const auto& a : j["attributes"])
    std::cout << " " << a["name"].get<std::string>() << ":" << a["type"].get<std::string>()
              << (a["list"].get<bool>() ? "[]" : "");
  std::cout << "\n";
}

} // namespace

int info_verb(const Arguments& arguments) {
  InputOptions input;
  bool json = false;
  unsigned threads = 0;
  CLI::App app("What is in a point cloud.", "eigencrust info");
  add_input_options(app, input);
  app.add_flag("--json", json, "Print the figures as JSON");
  app.add_option("--threads", threads, "Threads, 0 for all cores")->capture_default_str();
  if (const Parsed parsed = parse(app, arguments); parsed.done) return parsed.status;
  std::vector<InputFile> files;
  Notes notes;
  const PointCloud cloud = read_inputs(input, files, &notes);
  const Json figures = collect(cloud, files, notes, threads);
  if (json)
    std::cout << figures.dump(2, ' ', false, Json::error_handler_t::replace) << "\n";
  else
    print(figures);
  return 0;
}

} // namespace eigencrust::cli
