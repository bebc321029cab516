// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/coordinate_checks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <eigencrust/io.h>

#include "io/attributes.h"
#include "io/text.h"

namespace eigencrust {
namespace io {
namespace {

using Axis = double Vec3::*;
constexpr std::array<Axis, 3> axes = {&Vec3::x, &Vec3::y, &Vec3::z};
constexpr std::array<char, 3> letters = {'x', 'y', 'z'};

std::string number(double value) {
  std::string text;
  append_number(text, value);
  return text;
}

/// Three digits.
std::string rough(double value) {
  const double unit = std::pow(10, std::floor(std::log10(value)) - 2);
  return number(unit < 1 ? std::round(value / unit) / std::round(1 / unit) : std::round(value / unit) * unit);
}

/// The largest 32-bit float, and half of it (ESRI's grids), as printed with five digits or more.
bool is_largest_float(double value) {
  const double size = std::abs(value);
  return (size > 3.4027e38 && size < 3.4029e38) || (size > 1.7014e38 && size < 1.7015e38);
}

bool is_usual_sentinel(double value) {
  return value == -9999 || value == -99999 || value == -999999 || value == -32768 || value == -32767;
}

/// The value that means "no data" on this axis: below everything else by more than the extent of everything else.
double find_sentinel(const std::vector<Vec3>& points, Axis axis) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  double least = std::numeric_limits<double>::infinity();
  for (const Vec3& p : points)
    if (!is_largest_float(p.*axis)) least = std::fmin(least, p.*axis);
  if (!is_usual_sentinel(least)) return none;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Vec3& p : points) {
    const double value = p.*axis;
    if (!std::isfinite(value) || value == least || is_largest_float(value)) continue;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  return low - least > high - low ? least : none;
}

/// Distance of the 32-bit numbers next to the largest value of the axis.
double float_step(double largest) { return std::ldexp(1.0, std::ilogb(largest) - 23); }

/// What the values of an axis are where all are 32-bit numbers far from 0.
struct Steps {
  std::size_t values = 0; ///< different ones; 0: there is nothing odd
  double step = 0;
};

Steps find_steps(const std::vector<Vec3>& points, Axis axis, double low, double high) {
  const double largest = std::max(std::abs(low), std::abs(high));
  constexpr double beyond = 1e30; // no coordinates, and not all of them 32-bit numbers
  if (!(largest > 0) || !(high > low) || largest > beyond) return {};
  const double step = float_step(largest), n = static_cast<double>(points.size());
  // Steps matter that are not much smaller than the distance between points of a surface.
  constexpr double matters = 0.1;
  if (step < matters * (high - low) / std::sqrt(n)) return {};
  std::vector<bool> used(static_cast<std::size_t>((high - low) / step) + 2);
  for (const Vec3& p : points) {
    if (!is_finite(p)) continue; // the extent is that of the others
    const double place = (p.*axis - low) / step;
    if (place != std::floor(place) || static_cast<double>(static_cast<float>(p.*axis)) != p.*axis) return {};
    used[static_cast<std::size_t>(place)] = true;
  }
  Steps steps{static_cast<std::size_t>(std::count(used.begin(), used.end(), true)), step};
  bool neighbours = false;
  for (std::size_t i = 0; i + 1 < used.size(); ++i) neighbours = neighbours || (used[i] && used[i + 1]);
  // A grid may have wider steps by itself; and few points for each value prove nothing.
  return neighbours && 4 * steps.values <= points.size() ? steps : Steps{};
}

/// Is the axis, too, on a raster of that step?
bool lies_on_raster(const std::vector<Vec3>& points, Axis axis, double step) {
  double low = std::numeric_limits<double>::infinity();
  for (const Vec3& p : points)
    if (is_finite(p)) low = std::min(low, p.*axis);
  return std::all_of(points.begin(), points.end(), [&](const Vec3& p) {
    const double place = (p.*axis - low) / step;
    return !is_finite(p) || place == std::floor(place);
  });
}

std::string doubt_precision(const std::vector<Vec3>& points, const Box3& box) {
  std::string text;
  for (std::size_t k = 0; k < 3; ++k) {
    const Steps steps = find_steps(points, axes[k], box.min.*axes[k], box.max.*axes[k]);
    if (steps.values == 0) continue;
    bool raster = false; // heights on a raster have its steps along both axes
    for (const std::size_t other : {0u, 1u}) {
      const double largest = std::max(std::abs(box.min.*axes[other]), std::abs(box.max.*axes[other]));
      raster = raster || (other != k && largest > 0 && steps.step > float_step(largest) &&
                          lies_on_raster(points, axes[other], steps.step));
    }
    if (raster) continue;
    text += (text.empty() ? std::string() : std::string(", ")) + letters[k] + " takes only " +
            std::to_string(steps.values) + " values, steps of " + number(steps.step);
  }
  return text.empty()
             ? text
             : text + ": exported in 32 bits; export 64-bit coordinates, or subtract an offset before the export";
}

/// x and y that are degrees beside a height in metres: a degree is 111 km.
std::string doubt_degrees(const Box3& box) {
  constexpr double slender = 100, away = 3;
  const double dx = box.max.x - box.min.x, dy = box.max.y - box.min.y, dz = box.max.z - box.min.z;
  const bool in_range = box.min.x >= -180 && box.max.x <= 180 && box.min.y >= -90 && box.max.y <= 90;
  const Vec3 middle = box.centre();
  const bool is_away = std::abs(middle.x) > away * dx && std::abs(middle.y) > away * dy;
  if (!in_range || !is_away || !(dx > 0) || !(dy > 0) || dz < slender * std::max(dx, dy)) return {};
  return "x and y look like degrees of longitude and latitude beside heights in metres; project the points to metres "
         "first (UTM)";
}

} // namespace

std::vector<std::string> drop_no_data(PointCloud& cloud) {
  std::array<double, 3> sentinel{};
  for (std::size_t k = 0; k < 3; ++k) sentinel[k] = find_sentinel(cloud.points, axes[k]);
  const auto is_odd = [](const Vec3& p) {
    return is_largest_float(p.x) || is_largest_float(p.y) || is_largest_float(p.z);
  };
  const bool has_sentinel = std::any_of(sentinel.begin(), sentinel.end(), [](double s) { return !std::isnan(s); });
  if (!has_sentinel && std::none_of(cloud.points.begin(), cloud.points.end(), is_odd)) return {};
  std::vector<std::uint32_t> rows;
  std::string example;
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    bool has_data = true;
    for (std::size_t k = 0; k < 3; ++k) {
      const double value = cloud.points[i].*axes[k];
      if (value != sentinel[k] && !is_largest_float(value)) continue;
      if (example.empty()) example = std::string(1, letters[k]) + " = " + number(value);
      has_data = false;
    }
    if (has_data) rows.push_back(static_cast<std::uint32_t>(i));
  }
  const std::size_t dropped = cloud.points.size() - rows.size();
  if (dropped == 0 || rows.empty()) return {};
  keep_rows(cloud, rows);
  return {plural(dropped, "point") + " without data left out: " + example};
}

std::vector<std::string> doubt_coordinates(const std::vector<Vec3>& points) {
  Box3 box;
  for (const Vec3& p : points)
    if (is_finite(p)) box.add(p);
  std::vector<std::string> doubts;
  if (box.empty()) return doubts;
  for (const std::string& text : {doubt_precision(points, box), doubt_degrees(box)})
    if (!text.empty()) doubts.push_back(text);
  return doubts;
}

} // namespace io

Extent extent_of(std::span<const Vec3> points) {
  constexpr double tail = 0.02; // outliers
  Extent extent;
  std::array<std::vector<double>, 3> values;
  for (const Vec3& p : points) {
    if (!is_finite(p)) continue;
    extent.bounds.add(p);
    for (std::size_t k = 0; k < 3; ++k) values[k].push_back(p.*io::axes[k]);
  }
  if (values[0].empty()) return extent;
  const auto cut = static_cast<std::ptrdiff_t>(tail * static_cast<double>(values[0].size()));
  for (std::size_t k = 0; k < 3; ++k) {
    std::nth_element(values[k].begin(), values[k].begin() + cut, values[k].end());
    extent.bulk.min.*io::axes[k] = values[k][static_cast<std::size_t>(cut)];
    std::nth_element(values[k].begin(), values[k].end() - 1 - cut, values[k].end());
    extent.bulk.max.*io::axes[k] = *(values[k].end() - 1 - cut);
  }
  return extent;
}

std::vector<std::string> compare_extents(std::span<const std::string> names, std::span<const Extent> extents) {
  constexpr double same_thing = 300; // scans of one object differ by less in size
  constexpr double apart = 0.1;      // scans meet; a gap is a part of the larger of the two
  std::vector<std::string> doubts;
  double least = std::numeric_limits<double>::infinity();
  std::size_t smallest = 0, largest = 0;
  for (std::size_t i = 0; i < extents.size(); ++i) {
    const double size = extents[i].bulk.diagonal();
    if (!(size > 0)) continue;
    if (size < least) {
      least = size;
      smallest = i;
    }
    if (size > extents[largest].bulk.diagonal()) largest = i;
  }
  const double ratio = extents.empty() ? 0 : extents[largest].bulk.diagonal() / least;
  if (std::isfinite(ratio) && ratio > same_thing) {
    std::string words;
    for (const Extent& e : extents) words += e.bulk.diagonal() > same_thing * least ? " --unit mm" : " --unit m";
    doubts.push_back(names[largest] + " is " + io::number(std::round(ratio)) + " times as large as " + names[smallest] +
                     ": if one is in millimetres and one in metres, type" + words);
    return doubts;
  }
  for (std::size_t i = 0; i < extents.size(); ++i) {
    double nearest = std::numeric_limits<double>::infinity(), size = 0;
    for (std::size_t j = 0; j < extents.size(); ++j) {
      const Box3 &a = extents[i].bounds, &b = extents[j].bounds;
      if (i == j || a.empty() || b.empty()) continue;
      const Vec3 gap{std::max({0.0, a.min.x - b.max.x, b.min.x - a.max.x}),
                     std::max({0.0, a.min.y - b.max.y, b.min.y - a.max.y}),
                     std::max({0.0, a.min.z - b.max.z, b.min.z - a.max.z})};
      nearest = std::min(nearest, norm(gap));
      size = std::max({size, a.diagonal(), b.diagonal()});
    }
    if (std::isfinite(nearest) && nearest > apart * size)
      doubts.push_back(names[i] + " does not overlap any other input: it is " + io::rough(nearest) +
                       " away from the nearest, more than a tenth of the largest diagonal; several inputs have to be "
                       "scans of one scene in one frame");
  }
  return doubts;
}

} // namespace eigencrust
