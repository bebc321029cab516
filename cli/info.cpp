// SPDX-License-Identifier: GPL-3.0-or-later
#include <iostream>
#include <nlohmann/json.hpp>

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

nlohmann::ordered_json collect(const PointCloud& cloud, const std::vector<InputFile>& files, const Threads& threads) {
  nlohmann::ordered_json json;
  for (const InputFile& f : files)
    json["files"].push_back({{"path", f.path}, {"sha256", f.sha256}, {"points", f.points}});
  json["points"] = cloud.points.size();
  std::uint32_t scans = cloud.points.empty() ? 0 : 1;
  for (const std::uint32_t scan : cloud.scan_index) scans = std::max(scans, scan + 1);
  json["scans"] = scans;
  json["attributes"] = nlohmann::ordered_json::array();
  for (const Attribute& a : cloud.attributes)
    json["attributes"].push_back({{"name", a.name}, {"type", name_of(a.type)}, {"list", a.is_list}});
  const Samples samples = prepare_samples(cloud.points, threads);
  const Box3& b = samples.bounds;
  json["distinct"] = samples.positions.size();
  json["duplicates"] = samples.duplicates;
  json["nonfinite"] = samples.nonfinite;
  json["bounds"] = {
      {"min", {b.min.x, b.min.y, b.min.z}}, {"max", {b.max.x, b.max.y, b.max.z}}, {"diagonal", b.diagonal()}};
  json["spacing"] = median_spacing(samples, cloud.points, {}, threads);
  json["grid_spacing"] = resolve_grid_spacing({}, samples, cloud.points, cloud.scan_index, threads);
  return json;
}

std::string show(const nlohmann::ordered_json& v) {
  return "(" + rounded(v[0].get<double>()) + ", " + rounded(v[1].get<double>()) + ", " + rounded(v[2].get<double>()) +
         ")";
}

void print(const nlohmann::ordered_json& j) {
  for (const auto& f : j["files"])
    std::cout << f["path"].get<std::string>() << ": " << grouped(f["points"].get<std::uint64_t>()) << " points\n";
  std::cout << "  distinct " << grouped(j["distinct"].get<std::uint64_t>()) << ", duplicates "
            << grouped(j["duplicates"].get<std::uint64_t>()) << ", not finite "
            << grouped(j["nonfinite"].get<std::uint64_t>()) << ", scans " << j["scans"] << "\n";
  std::cout << "  bounds " << show(j["bounds"]["min"]) << " to " << show(j["bounds"]["max"]) << ", diagonal "
            << rounded(j["bounds"]["diagonal"].get<double>()) << "\n";
  std::cout << "  spacing (median distance to the nearest point) " << rounded(j["spacing"].get<double>()) << "\n";
  const double grid = j["grid_spacing"].get<double>();
  std::cout << "  grid spacing of the scans "
            << (grid > 0 ? rounded(grid) + " (from the scans)" : "not known (the scans are not told apart)") << "\n";
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
  const PointCloud cloud = read_inputs(input, files);
  const Threads team(threads);
  const nlohmann::ordered_json figures = collect(cloud, files, team);
  if (json)
    std::cout << figures.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) << "\n";
  else
    print(figures);
  return 0;
}

} // namespace eigencrust::cli
