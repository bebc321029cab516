// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <limits>
#include <nlohmann/json.hpp>

#include <eigencrust/memory_forecast.h>

#include "command.h"
#include "picture.h"
#include "standard_streams.h"

namespace eigencrust::cli {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const Forecast& f) { return {{"memory_bytes", f.memory_bytes}, {"seconds", f.seconds}}; }

Json json_of(const Box3& b) {
  return {{"min", {b.min.x, b.min.y, b.min.z}}, {"max", {b.max.x, b.max.y, b.max.z}}, {"diagonal", b.diagonal()}};
}

Json collect(const PointCloud& cloud, const ReadReport& read, unsigned threads) {
  Json json;
  const std::vector<InputFile>& files = read.files;
  for (std::size_t i = 0; i < files.size(); ++i) {
    // Columns are told of all files together; each has its part of them.
    const double share = static_cast<double>(files[i].points) / std::max(1.0, static_cast<double>(cloud.points.size()));
    const auto further = static_cast<std::uint64_t>(share * static_cast<double>(further_bytes(cloud)));
    json["files"].push_back({{"path", files[i].path},
                             {"sha256", files[i].sha256},
                             {"points", files[i].points},
                             {"bounds", read.bounds[i].empty() ? Json() : json_of(read.bounds[i])},
                             {"notes", read.notes[i].notes},
                             {"warnings", read.notes[i].warnings},
                             {"forecast", json_of(forecast(files[i].points, further))}});
  }
  json["warnings"] = read.together;
  json["grids"] = Json::array();
  if (const auto grids = find_grids(cloud))
    for (const ScanGrid& size : grids->sizes) json["grids"].push_back({{"columns", size.columns}, {"rows", size.rows}});
  json.update(Json::parse(info_json(cloud, threads)));
  return json;
}

/// "bounds (0, 0, 0) to (1, 1, 1), diagonal 1.732": with the digits that tell the ends apart.
std::string show_bounds(const Json& bounds) {
  const auto vec = [](const Json& v) { return Vec3{v[0].get<double>(), v[1].get<double>(), v[2].get<double>()}; };
  const Vec3 low = vec(bounds["min"]), high = vec(bounds["max"]);
  double extent = std::numeric_limits<double>::infinity(); // of the shortest side that is one
  for (const double side : {high.x - low.x, high.y - low.y, high.z - low.z})
    if (side > 0) extent = std::min(extent, side);
  if (!std::isfinite(extent)) extent = 0;
  return "bounds " + show_point(low, extent) + " to " + show_point(high, extent) + ", diagonal " +
         rounded(bounds["diagonal"].get<double>());
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

/// Equal grids are told once.
void print_grids(const Json& grids) {
  for (std::size_t i = 0; i < grids.size(); ++i) {
    const auto& g = grids[i];
    if (g["rows"] == 0 || (i > 0 && g == grids[i - 1])) continue;
    std::cout << "  grid of " << g["columns"] << " columns and " << g["rows"] << " rows\n";
  }
}

void print_samples(const Json& j) {
  std::cout << "  distinct " << grouped(j["distinct"].get<std::uint64_t>()) << ", duplicates "
            << grouped(j["duplicates"].get<std::uint64_t>()) << ", not finite "
            << grouped(j["nonfinite"].get<std::uint64_t>()) << ", scans " << j["scans"] << "\n";
  if (!j["bounds"].is_null()) std::cout << "  " << show_bounds(j["bounds"]) << "\n";
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
    std::cout << printable(f["path"].get<std::string>()) << ": " << grouped(f["points"].get<std::uint64_t>())
              << " points";
    if (j["files"].size() > 1) std::cout << ", forecast " << show_forecast(f["forecast"]);
    std::cout << "\n";
    if (j["files"].size() > 1 && !f["bounds"].is_null()) std::cout << "  " << show_bounds(f["bounds"]) << "\n";
    for (const auto& note : f["notes"]) std::cout << "  " << printable(note.get<std::string>()) << "\n";
    for (const auto& warning : f["warnings"])
      std::cout << "  warning: " << printable(warning.get<std::string>()) << "\n";
  }
  for (const auto& warning : j["warnings"]) std::cout << "warning: " << printable(warning.get<std::string>()) << "\n";
  print_samples(j);
  print_forecast(j);
  print_grids(j["grids"]);
  print_sensors(j);
  if (j["attributes"].empty()) return;
  std::cout << "  attributes";
  for (const auto& a : j["attributes"])
    std::cout << " " << printable(a["name"].get<std::string>()) << ":" << a["type"].get<std::string>()
              << (a["list"].get<bool>() ? "[]" : "");
  std::cout << "\n";
}

/// From a corner, the front, the right and above; z, which is the height in most clouds, points up.
void draw(const std::string& path, PointCloud cloud) {
  TriangleMesh points;
  points.vertices = std::move(cloud.points);
  points.vertex_attributes = std::move(cloud.attributes);
  RenderOptions options;
  options.width = 800;
  options.height = 600;
  options.point_size = 3;
  options.up = {0, 0, 1};
  std::vector<RenderOptions> sides;
  for (const char* side : {"corner", "front", "right", "top"}) sides.push_back(seen_from(side, options));
  write_picture(path, render_sides({points}, sides), 1, sides.size());
}

void check_drawing(const std::string& path) {
  if (path.empty()) return;
  if (is_standard_output(path))
    throw Error(ErrorKind::usage, "--render", "standard output is for the figures", "name a file that ends in .png");
  check_picture(path);
}

} // namespace

int info_verb(const Arguments& arguments) {
  InputOptions input;
  std::string picture;
  bool json = false;
  unsigned threads = 0;
  OptionTable app("What is in a point cloud.", "eigencrust info");
  add_input_options(app, input);
  app.begin_chapter("Results");
  app.add_option("--render", picture, "PNG to write: the points from a corner, the front, the right and above, z up")
      ->type_name(file_to_write);
  app.begin_chapter("Running");
  app.add_flag("--json", json, "Print the figures as JSON");
  app.add_option("--threads", threads, "Threads, 0 for all cores")->capture_default_str();
  if (const Parsed parsed = parse(app, arguments); parsed.done) return parsed.status;
  check_drawing(picture);
  ReadReport read;
  PointCloud cloud = read_inputs(input, read);
  const Json figures = collect(cloud, read, threads);
  if (json)
    std::cout << figures.dump(2, ' ', false, Json::error_handler_t::replace) << "\n";
  else
    print(figures);
  if (!picture.empty()) draw(picture, std::move(cloud));
  return 0;
}

} // namespace eigencrust::cli
