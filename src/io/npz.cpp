// SPDX-License-Identifier: GPL-3.0-or-later
// Points as arrays of NumPy: one (.npy), or several by name in a zip archive (.npz).
#include <algorithm>
#include <array>
#include <map>
#include <optional>

#include "evidence/sensor_rows.h"
#include "io/attributes.h"
#include "io/formats.h"
#include "io/npy.h"
#include "io/point_table.h"
#include "io/sensor_columns.h"
#include "io/text.h"
#include "io/zip.h"

namespace eigencrust::io {
namespace {

constexpr const char* name_the_points = "save the points with the name points: numpy.savez(FILE, points=...)";
constexpr std::string_view ending = ".npy";
constexpr std::uint64_t most_columns = 4; ///< of an array that becomes attributes

void check_points(const NpyArray& array, std::uint64_t largest) {
  if (!array.is_numeric())
    array.fail("the type " + shown(array.type_text()) + " is not one of numbers", "save floating-point numbers");
  if (array.shape().size() != 2 || array.columns() < 3 || array.columns() > largest)
    array.fail("the shape " + array.shape_text() + " is not that of points", "save an array of shape (N, 3)");
}

/// The rest of the rows, as in a text file without a header.
void add_columns(const NpyArray& array, PointCloud& cloud) {
  const std::vector<std::string> names = complete_names({}, array.columns());
  for (std::uint64_t k = 3; k < array.columns(); ++k) cloud.attributes.push_back(array.column(k, names[k]));
}

class Archive {
 public:
  Archive(const FileContent& file, std::vector<std::string>& notes)
      : file_(file), notes_(notes), members_(read_zip_directory(file)), budget_(zip_budget(file.bytes().size())) {
    for (const ZipMember& member : members_) {
      if (!member.name.ends_with(ending)) continue;
      const std::string name = member.name.substr(0, member.name.size() - ending.size());
      if (!by_name_.emplace(name, &member).second)
        file.fail_at_byte(member.header, "the array " + shown(name) + " is there twice, the second", name_the_points);
      names_.push_back(name);
    }
  }

  PointCloud read() {
    PointCloud cloud;
    const std::string points = name_of_points();
    {
      const std::string bytes = unpack(points);
      const NpyArray array(file_, bytes, points);
      check_points(array, 3);
      cloud.points = array.points();
    }
    UniqueNames unique;
    for (const std::string& name : names_)
      if (name != points && name != sensors) add_attributes(name, cloud, unique);
    if (by_name_.contains(sensors)) add_sensors(cloud);
    return cloud;
  }

 private:
  static constexpr const char* sensors = "sensor_position";

  std::string name_of_points() const {
    if (by_name_.contains("points")) return "points";
    if (names_.size() == 1) return names_.front();
    if (names_.empty()) file_.fail("the zip archive holds no array of NumPy (.npy)", "unpack it, or use an .npz file");
    constexpr std::size_t most_listed = 8;
    std::string listed;
    for (std::size_t i = 0; i < std::min(most_listed, names_.size()); ++i)
      listed += (i > 0 ? ", " : "") + shown(names_[i]);
    if (names_.size() > most_listed) listed += ", ...";
    file_.fail("no array is named 'points' among " + listed, name_the_points);
  }

  std::string unpack(const std::string& name) { return unpack_zip_member(file_, *by_name_.at(name), budget_); }

  void add_attributes(const std::string& name, PointCloud& cloud, UniqueNames& unique) {
    const std::string bytes = unpack(name);
    const NpyArray array(file_, bytes, name);
    const std::uint64_t columns = array.columns();
    if (!array.is_numeric() || array.rows() != cloud.points.size() || columns == 0 || columns > most_columns) {
      notes_.push_back("array " + shown(name) + " of shape " + array.shape_text() + " left out: it does not go with " +
                       plural(cloud.points.size(), "point"));
      return;
    }
    std::array<std::string, most_columns> names = {name};
    if (columns > 1)
      for (std::size_t k = 0; k < columns; ++k) names[k] = name + "_" + std::to_string(k);
    if (columns == 3 && name == "normals") names = {"nx", "ny", "nz"};
    if (columns == 3 && (name == "colors" || name == "rgb")) names = {"red", "green", "blue"};
    for (std::size_t k = 0; k < columns; ++k) cloud.attributes.push_back(array.column(k, unique(names[k])));
  }

  /// One place per point, or one for all.
  void add_sensors(PointCloud& cloud) {
    const std::string bytes = unpack(sensors);
    const NpyArray array(file_, bytes, sensors);
    const bool single = array.shape() == std::vector<std::uint64_t>{3};
    if (array.is_numeric() && (single || (array.columns() == 3 && array.rows() == 1))) {
      Vec3 place;
      if (single) {
        const Attribute values = array.column(0, {});
        place = {attribute_value(values, 0), attribute_value(values, 1), attribute_value(values, 2)};
      } else {
        place = array.points().front();
      }
      set_sensor_rows(cloud, std::vector<Vec3>(cloud.points.size(), place));
      return;
    }
    check_points(array, 3);
    if (array.rows() != cloud.points.size())
      array.fail("there are " + plural(array.rows(), "position") + " for " + plural(cloud.points.size(), "point"),
                 "save one position per point, or one for all");
    set_sensor_rows(cloud, array.points());
  }

  const FileContent& file_;
  std::vector<std::string>& notes_;
  std::vector<ZipMember> members_;
  std::uint64_t budget_;
  std::map<std::string, const ZipMember*> by_name_;
  std::vector<std::string> names_; ///< in the order of the archive
};

} // namespace

PointCloud read_npy(const FileContent& file) {
  constexpr std::uint64_t widest_row = 64;
  const NpyArray array(file, file.bytes());
  check_points(array, widest_row);
  PointCloud cloud;
  cloud.points = array.points();
  add_columns(array, cloud);
  return cloud;
}

PointCloud read_npz(const FileContent& file, std::vector<std::string>& notes) { return Archive(file, notes).read(); }

} // namespace eigencrust::io
