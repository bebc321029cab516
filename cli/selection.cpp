// SPDX-License-Identifier: GPL-3.0-or-later
#include "selection.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <tuple>

#include <eigencrust/eigencrust.h>

namespace eigencrust::cli {
namespace {

[[noreturn]] void fail(const std::string& cause, const std::string& remedy) {
  throw Error(ErrorKind::usage, "--crop", cause, remedy);
}

/// The finite numbers of a text, separated by commas or blanks; none: it holds something else.
std::optional<std::vector<double>> numbers(std::string_view text) {
  std::vector<double> values;
  while (true) {
    const std::size_t begin = text.find_first_not_of(" \t\r,");
    if (begin == std::string_view::npos) return values;
    text.remove_prefix(begin);
    if (text.front() == '+') text.remove_prefix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || !std::isfinite(value)) return std::nullopt;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    if (!text.empty() && text.find_first_of(" \t\r,") != 0) return std::nullopt;
    values.push_back(value);
  }
}

void add_corner(Crop& crop, std::string_view text, const std::string& place) {
  const auto values = numbers(text);
  if (!values || values->size() != 2)
    fail(place + " is no corner: '" + std::string(text) + "'", "write x,y for each corner of the polygon");
  crop.corners.push_back({(*values)[0], (*values)[1]});
}

Crop check_polygon(Crop crop) {
  if (crop.corners.size() > 1 && crop.corners.front() == crop.corners.back()) crop.corners.pop_back();
  if (crop.corners.size() < 3)
    fail("a polygon of " + std::to_string(crop.corners.size()) + " corners holds nothing", "name three or more");
  return crop;
}

Crop read_polygon(const std::string& path) {
  std::ifstream file(path);
  if (!file || std::filesystem::is_directory(path))
    fail("'" + path + "' is neither numbers nor a file that can be read",
         "give x,y,z,x,y,z (two corners of a box), x,y;x,y;x,y (a polygon) or a file of rows x y");
  Crop crop;
  std::string line;
  for (std::size_t number = 1; std::getline(file, line); ++number) {
    line.erase(std::min(line.find('#'), line.size()));
    if (line.find_first_not_of(" \t\r,") == std::string::npos) continue;
    add_corner(crop, line, path + ":" + std::to_string(number));
  }
  return check_polygon(std::move(crop));
}

/// The cube of the grid that holds a point, and how far from the middle of it the point is.
struct Placed {
  std::array<double, 3> cube; ///< whole numbers
  double squared_distance;
  Vec3 point;
  std::uint32_t row;

  [[nodiscard]] auto order() const { return std::tie(cube, squared_distance, point, row); }
};

} // namespace

bool Crop::holds(const Vec3& p) const {
  if (corners.empty())
    return p.x >= box.min.x && p.x <= box.max.x && p.y >= box.min.y && p.y <= box.max.y && p.z >= box.min.z &&
           p.z <= box.max.z;
  if (!is_finite(p)) return false;
  // A ray along +x crosses the outline an odd number of times.
  bool inside = false;
  for (std::size_t i = 0, j = corners.size() - 1; i < corners.size(); j = i++) {
    const auto& [ax, ay] = corners[i];
    const auto& [bx, by] = corners[j];
    if ((ay > p.y) != (by > p.y) && p.x < ax + (bx - ax) * ((p.y - ay) / (by - ay))) inside = !inside;
  }
  return inside;
}

Crop parse_crop(const std::string& text) {
  Crop crop;
  if (text.find(';') != std::string::npos) {
    std::string_view rest = text;
    while (!rest.empty()) {
      const std::size_t end = std::min(rest.find(';'), rest.size());
      add_corner(crop, rest.substr(0, end), "the polygon's part");
      rest.remove_prefix(std::min(end + 1, rest.size()));
    }
    return check_polygon(std::move(crop));
  }
  const auto values = numbers(text);
  if (!values) return read_polygon(text);
  const std::size_t n = values->size();
  if (n != 4 && n != 6)
    fail("'" + text + "' has " + std::to_string(n) + " numbers", "give two corners of a box: x,y,z,x,y,z or x,y,x,y");
  constexpr double everywhere = std::numeric_limits<double>::max();
  const std::vector<double>& v = *values;
  for (const Vec3& corner :
       {Vec3{v[0], v[1], n == 6 ? v[2] : -everywhere}, Vec3{v[n / 2], v[n / 2 + 1], n == 6 ? v[5] : everywhere}})
    crop.box.add(corner);
  return crop;
}

std::vector<std::uint32_t> rows_within(const std::vector<Vec3>& points, const Crop& crop) {
  std::vector<std::uint32_t> rows;
  for (std::uint32_t i = 0; i < points.size(); ++i)
    if (crop.holds(points[i])) rows.push_back(i);
  return rows;
}

std::vector<std::uint32_t> thinned_rows(const std::vector<Vec3>& points, double edge) {
  constexpr double most_cubes = 9007199254740992; // 2^53: beyond it doubles skip whole numbers
  std::vector<Placed> placed;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    if (!is_finite(points[i])) continue;
    const Vec3 scaled = (1 / edge) * points[i];
    const Vec3 cube{std::floor(scaled.x), std::floor(scaled.y), std::floor(scaled.z)};
    for (const double c : {cube.x, cube.y, cube.z})
      if (!(std::fabs(c) < most_cubes))
        throw Error(ErrorKind::usage, "--thin", "cubes so small cannot be counted at these coordinates",
                    "give a longer edge");
    placed.push_back({{cube.x, cube.y, cube.z}, squared_norm(scaled - cube - Vec3{0.5, 0.5, 0.5}), points[i], i});
  }
  std::sort(placed.begin(), placed.end(), [](const Placed& a, const Placed& b) { return a.order() < b.order(); });
  std::vector<std::uint32_t> rows;
  for (std::size_t i = 0; i < placed.size(); ++i)
    if (i == 0 || placed[i].cube != placed[i - 1].cube) rows.push_back(placed[i].row);
  std::sort(rows.begin(), rows.end());
  return rows;
}

void keep_rows(PointCloud& cloud, const std::vector<std::uint32_t>& rows) {
  for (Attribute& attribute : cloud.attributes) attribute = gather(attribute, rows);
  for (auto* index : {&cloud.scan_index, &cloud.sensor_of, &cloud.cell}) {
    if (index->empty()) continue;
    for (std::size_t i = 0; i < rows.size(); ++i) (*index)[i] = (*index)[rows[i]]; // rows increase
    index->resize(rows.size());
  }
  for (std::size_t i = 0; i < rows.size(); ++i) cloud.points[i] = cloud.points[rows[i]];
  cloud.points.resize(rows.size());
}

} // namespace eigencrust::cli
