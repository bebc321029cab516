// SPDX-License-Identifier: GPL-3.0-or-later
// E57 (ASTM E2807): scans, each in its own frame with the pose that puts it in that of the file.
#include <algorithm>
#include <cmath>
#include <set>

#include <eigencrust/io.h>

#include "io/attributes.h"
#include "io/colours.h"
#include "io/e57_columns.h"
#include "io/e57_header.h"
#include "io/e57_pages.h"
#include "io/formats.h"
#include "io/text.h"

namespace eigencrust::io {
namespace {

using Kind = E57Field::Kind;

constexpr std::array<const char*, 3> cartesian = {"cartesianX", "cartesianY", "cartesianZ"};
constexpr std::array<const char*, 3> spherical = {"sphericalRange", "sphericalAzimuth", "sphericalElevation"};
constexpr std::array<const char*, 3> colour = {"colorRed", "colorGreen", "colorBlue"};

/// Name of the attribute: the usual one where there is one.
std::string attribute_name(const std::string& name) {
  const std::string_view local = std::string_view(name).substr(name.find(':') + 1); // npos + 1 is 0
  for (const auto& [e57, usual] :
       {std::pair{"colorRed", "red"}, std::pair{"colorGreen", "green"}, std::pair{"colorBlue", "blue"},
        std::pair{"normalX", "nx"}, std::pair{"normalY", "ny"}, std::pair{"normalZ", "nz"}})
    if (local == e57) return usual;
  return name;
}

/// The smallest type that holds the field.
ScalarType attribute_type(const E57Field& f) {
  if (f.kind == Kind::float32) return ScalarType::float32;
  if (f.kind != Kind::integer) return ScalarType::float64;
  const auto within = [&](std::int64_t lowest, std::int64_t largest) {
    return f.minimum >= lowest && f.maximum <= largest;
  };
  if (within(0, 0xff)) return ScalarType::uint8;
  if (within(-0x80, 0x7f)) return ScalarType::int8;
  if (within(0, 0xffff)) return ScalarType::uint16;
  if (within(-0x8000, 0x7fff)) return ScalarType::int16;
  if (within(0, 0xffffffff)) return ScalarType::uint32;
  if (within(-0x80000000LL, 0x7fffffff)) return ScalarType::int32;
  return ScalarType::float64;
}

/// The columns of one scan, each of which is taken once.
class Columns {
 public:
  Columns(const E57Pages& pages, const E57Scan& scan, E57Budget& budget)
      : scan_(scan), streams_(read_e57_streams(pages, scan, budget)), taken_(scan.fields.size(), false) {
    for (std::size_t i = 0; i < taken_.size(); ++i) taken_[i] = scan.fields[i].kind == Kind::text;
  }

  [[nodiscard]] bool has(const char* name) const { return find(name) < taken_.size(); }
  [[nodiscard]] bool has_all(const std::array<const char*, 3>& names) const {
    return has(names[0]) && has(names[1]) && has(names[2]);
  }
  /// Empty when there is no such column.
  std::vector<double> take(const char* name) {
    const std::size_t i = find(name);
    return i < taken_.size() ? take(i) : std::vector<double>();
  }
  std::vector<Attribute> take_rest() {
    std::vector<Attribute> attributes = take_real_colours();
    UniqueNames unique;
    for (const Attribute& a : attributes) unique(a.name);
    for (std::size_t i = 0; i < taken_.size(); ++i) {
      if (taken_[i]) continue;
      const E57Field& f = scan_.fields[i];
      attributes.push_back(make_attribute(unique(attribute_name(f.name)), attribute_type(f), take(i)));
    }
    return attributes;
  }

 private:
  [[nodiscard]] std::size_t find(const char* name) const {
    for (std::size_t i = 0; i < taken_.size(); ++i)
      if (!taken_[i] && scan_.fields[i].name == name) return i;
    return taken_.size();
  }
  std::vector<double> take(std::size_t i) {
    taken_[i] = true;
    std::vector<double> values = unpack_e57(scan_.fields[i], streams_[i], scan_.records);
    streams_[i] = {};
    return values;
  }
  /// Colours that are no whole numbers: of 0 to 1 or 0 to 255, which the values tell.
  std::vector<Attribute> take_real_colours() {
    if (!has_all(colour)) return {};
    for (const char* channel : colour)
      if (scan_.fields[find(channel)].kind == Kind::integer) return {};
    std::vector<double> rgb(3 * scan_.records);
    double largest = 0;
    bool whole = true;
    for (std::size_t c = 0; c < 3; ++c) {
      const std::vector<double> channel = take(colour[c]);
      for (std::size_t i = 0; i < channel.size(); ++i) {
        rgb[3 * i + c] = channel[i];
        largest = std::max(largest, channel[i]);
        whole = whole && channel[i] == std::floor(channel[i]);
      }
    }
    return colour_attributes(rgb, 3, whole && largest > 1);
  }

  const E57Scan& scan_;
  std::vector<std::string> streams_;
  std::vector<bool> taken_;
};

std::vector<Vec3> take_points(const E57Pages& pages, const E57Scan& scan, Columns& columns) {
  std::vector<Vec3> points(scan.records);
  constexpr std::array<double Vec3::*, 3> members = {&Vec3::x, &Vec3::y, &Vec3::z};
  const bool is_cartesian = columns.has_all(cartesian);
  if (!is_cartesian && !columns.has_all(spherical))
    pages.fail_at(scan.xml, "a scan without cartesian or spherical coordinates", "use a file whose scans have points");
  for (std::size_t k = 0; k < 3; ++k) {
    const std::vector<double> values = columns.take(is_cartesian ? cartesian[k] : spherical[k]);
    for (std::size_t i = 0; i < points.size(); ++i) points[i].*members[k] = values[i];
  }
  if (!is_cartesian)
    for (Vec3& p : points) {
      const double range = p.x, azimuth = p.y, elevation = p.z;
      p = {range * std::cos(elevation) * std::cos(azimuth), range * std::cos(elevation) * std::sin(azimuth),
           range * std::sin(elevation)};
    }
  return points;
}

/// Rows whose coordinates the scanner did not mark as invalid (1: a direction only, 2: nothing).
std::vector<std::uint32_t> valid_rows(const std::vector<double>& invalid_state) {
  std::vector<std::uint32_t> rows;
  for (std::size_t i = 0; i < invalid_state.size(); ++i)
    if (invalid_state[i] == 0) rows.push_back(static_cast<std::uint32_t>(i));
  return rows;
}

/// One scan in the frame of the file. \param dropped is increased by the number of invalid points
PointCloud read_scan(const E57Pages& pages, const E57Scan& scan, E57Budget& budget, std::uint64_t& dropped) {
  Columns columns(pages, scan, budget);
  const bool is_cartesian = columns.has_all(cartesian);
  const std::vector<double> state = columns.take(is_cartesian ? "cartesianInvalidState" : "sphericalInvalidState");
  PointCloud cloud;
  cloud.points = take_points(pages, scan, columns);
  cloud.attributes = columns.take_rest();
  if (std::any_of(state.begin(), state.end(), [](double s) { return s != 0; })) {
    const std::vector<std::uint32_t> rows = valid_rows(state);
    dropped += cloud.points.size() - rows.size();
    keep_rows(cloud, rows);
  }
  if (scan.pose) apply(*scan.pose, cloud);
  return cloud;
}

/// Scans with different columns get all of each other's: few bytes could ask for much memory.
class ColumnLimit {
 public:
  explicit ColumnLimit(const E57Pages& pages) : pages_(pages), most_(4096 + 256 * (pages.bytes().size() / 8)) {}

  void add(const E57Scan& scan) {
    for (const E57Field& f : scan.fields) names_.insert(f.name);
    rows_ += scan.records;
    if (scan.records > 0 && rows_ > most_ / names_.size())
      pages_.fail_at(scan.xml,
                     plural(rows_, "point") + " with " + plural(names_.size(), "column") +
                         " are more than a file of this size can hold,",
                     "leave out constant columns, or split the file");
  }

 private:
  const E57Pages& pages_;
  std::uint64_t most_, rows_ = 0;
  std::set<std::string> names_;
};

void add_notes(const std::vector<E57Scan>& scans, std::uint64_t dropped, bool poses_known,
               std::vector<std::string>& notes) {
  if (dropped > 0) notes.push_back(plural(dropped, "point") + " marked as invalid left out");
  for (std::size_t s = 0; s < scans.size(); ++s)
    if (scans[s].has_bad_rotation)
      notes.push_back("scan " + std::to_string(s + 1) +
                      ": the rotation of its pose is 0 0 0 0 and was read as no rotation");
  if (!poses_known) notes.emplace_back("no pose, or only the identity: the sensor's position is not known");
}

} // namespace

PointCloud read_e57(const FileContent& file, std::vector<std::string>& notes) {
  const E57Pages pages(file);
  const std::vector<E57Scan> scans = read_e57_header(pages);
  // Writers that know no pose write the identity; it means something where other scans were moved.
  const bool poses_known =
      std::any_of(scans.begin(), scans.end(), [](const E57Scan& s) { return s.pose && !s.pose->is_identity(); });
  E57Budget budget{pages.bytes().size(), pages.bytes().size()};
  ColumnLimit limit(pages);
  std::uint64_t dropped = 0;
  PointCloud cloud;
  std::vector<std::uint32_t> scan_index;
  for (std::size_t s = 0; s < scans.size(); ++s) {
    limit.add(scans[s]);
    PointCloud next = read_scan(pages, scans[s], budget, dropped);
    if (poses_known && scans[s].pose) set_sensor(next, {scans[s].pose->translation, false});
    if (s == 0)
      cloud = std::move(next);
    else
      append_rows(cloud, std::move(next));
    scan_index.resize(cloud.points.size(), static_cast<std::uint32_t>(s));
  }
  if (scans.size() > 1) cloud.scan_index = std::move(scan_index);
  add_notes(scans, dropped, poses_known, notes);
  return cloud;
}

} // namespace eigencrust::io
