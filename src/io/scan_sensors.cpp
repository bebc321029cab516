// SPDX-License-Identifier: GPL-3.0-or-later
// Where the scanner stood for each scan, or in which direction, as rows of text.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <eigencrust/io.h>

#include "io/scan_files.h"
#include "io/text.h"

namespace eigencrust {
namespace {

constexpr const char* remedy =
    "write rows scan,x,y,z or x,y,z; directions under a header with scan,dx,dy,dz or dx,dy,dz";

/// What the columns hold.
struct Layout {
  std::size_t fields = 0, scan = none;
  std::array<std::size_t, 3> place{};
  bool directions = false;

  static constexpr std::size_t none = static_cast<std::size_t>(-1);
};

std::size_t find(const io::Fields& names, const char* name) {
  const auto found =
      std::find_if(names.begin(), names.end(), [&](std::string_view n) { return io::equal_ignoring_case(n, name); });
  return found == names.end() ? Layout::none : static_cast<std::size_t>(found - names.begin());
}

bool find_all(const io::Fields& names, const std::array<const char*, 3>& wanted, std::array<std::size_t, 3>& found) {
  for (std::size_t k = 0; k < 3; ++k) found[k] = find(names, wanted[k]);
  return std::find(found.begin(), found.end(), Layout::none) == found.end();
}

/// From a header. \return false when it does not name the columns
bool read_names(const io::Fields& names, Layout& layout, const io::LineScanner& lines) {
  Layout next;
  next.fields = names.size();
  next.scan = find(names, "scan");
  std::array<std::size_t, 3> positions{};
  const bool has_positions = find_all(names, {"x", "y", "z"}, positions);
  next.directions = find_all(names, {"dx", "dy", "dz"}, next.place);
  if (has_positions && next.directions) lines.fail("the header names positions and directions", remedy);
  if (!has_positions && !next.directions) return false;
  if (has_positions) next.place = positions;
  layout = next;
  return true;
}

Layout usual_layout(std::size_t fields, const io::LineScanner& lines) {
  if (fields == 3) return {3, Layout::none, {0, 1, 2}, false};
  if (fields == 4) return {4, 0, {1, 2, 3}, false};
  lines.fail("the row has " + io::plural(fields, "field") + " and no header names them", remedy);
}

Sensor read_sensor(const io::Fields& fields, const Layout& layout, const io::LineScanner& lines) {
  std::array<double, 3> v{};
  for (std::size_t k = 0; k < 3; ++k)
    if (!io::parse(fields[layout.place[k]], v[k]) || !std::isfinite(v[k]))
      lines.fail(io::shown(fields[layout.place[k]]) + " is no finite number", remedy);
  Sensor sensor{{v[0], v[1], v[2]}, layout.directions};
  if (!layout.directions) return sensor;
  const double length = std::hypot(v[0], v[1], v[2]);
  if (!(length > 0) || !std::isfinite(length)) lines.fail("the direction has no length", remedy);
  sensor.place = {v[0] / length, v[1] / length, v[2] / length};
  return sensor;
}

using SensorOfScan = std::map<std::uint32_t, Sensor>;

SensorOfScan read_rows(const io::FileContent& file, std::uint64_t scans, bool& numbered) {
  SensorOfScan sensors;
  io::LineScanner lines(file);
  io::Fields fields;
  Layout layout;
  while (lines.next_filled()) {
    std::string_view line = lines.line();
    const bool is_comment = line.starts_with('#');
    if (is_comment) line.remove_prefix(1);
    io::split_fields(line, fields);
    double number = 0;
    const bool is_header = layout.fields == 0 && sensors.empty() && !fields.empty() && !io::parse(fields[0], number);
    if (is_header && read_names(fields, layout, lines)) continue;
    if (is_comment) continue;
    if (is_header) lines.fail("the header " + io::shown(line) + " does not name the columns", remedy);
    if (layout.fields == 0) layout = usual_layout(fields.size(), lines);
    if (fields.size() != layout.fields)
      lines.fail("the row has " + io::plural(fields.size(), "field") + " where " + std::to_string(layout.fields) +
                     " are expected",
                 remedy);
    numbered = layout.scan != Layout::none;
    std::uint64_t scan = sensors.size();
    if (numbered && !io::parse(fields[layout.scan], scan))
      lines.fail(io::shown(fields[layout.scan]) + " is no scan number", remedy);
    if (scan >= scans)
      lines.fail("the row is for scan " + std::to_string(scan) + ", the last one is " + std::to_string(scans - 1),
                 "number the scans from 0, in the order of the files or as the scan index does");
    if (!sensors.emplace(static_cast<std::uint32_t>(scan), read_sensor(fields, layout, lines)).second)
      lines.fail("a second row for scan " + std::to_string(scan), "write one row for each scan");
  }
  return sensors;
}

} // namespace

void io::read_scan_sensors(const io::FileContent& file, PointCloud& cloud) {
  std::uint64_t scans = 1;
  for (const std::uint32_t scan : cloud.scan_index) scans = std::max(scans, std::uint64_t{scan} + 1);
  bool numbered = false;
  const SensorOfScan rows = read_rows(file, scans, numbered);
  if (rows.empty()) file.fail("the file has no row", remedy);
  if (!numbered && rows.size() != scans)
    file.fail(io::plural(rows.size(), "row") + " without scan numbers for " + io::plural(scans, "scan"),
              "write one row for each scan, or begin the rows with the scan's number");
  std::map<std::uint32_t, std::uint32_t> number;
  cloud.sensors.clear();
  for (const auto& [scan, sensor] : rows) {
    number[scan] = static_cast<std::uint32_t>(cloud.sensors.size());
    cloud.sensors.push_back(sensor);
  }
  cloud.sensor_of.assign(cloud.points.size(), PointCloud::no_sensor);
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const auto found = number.find(cloud.scan_index.empty() ? 0 : cloud.scan_index[i]);
    if (found != number.end()) cloud.sensor_of[i] = found->second;
  }
}

void read_scan_sensors(const std::filesystem::path& path, PointCloud& cloud) {
  io::read_scan_sensors(io::FileContent(path), cloud);
}

} // namespace eigencrust
