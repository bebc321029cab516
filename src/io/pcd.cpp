// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

#include <eigencrust/io.h>

#include "io/attributes.h"
#include "io/colours.h"
#include "io/formats.h"
#include "io/lzf.h"
#include "io/pcd_header.h"
#include "io/point_table.h"
#include "io/pose.h"
#include "io/scan_grid.h"
#include "io/text.h"
#include "surface/scalar.h"

namespace eigencrust::io {
namespace {

static_assert(std::endian::native == std::endian::little, "binary PCD files are little-endian");

bool is_packed_colour(const PcdField& f) {
  return (f.name == "rgb" || f.name == "rgba") && f.size == 4 && f.count == 1;
}
bool is_axis(const PcdField& f, char axis) { return f.name.size() == 1 && (f.name[0] | 32) == axis; }
bool is_axis(const PcdField& f) { return is_axis(f, 'x') || is_axis(f, 'y') || is_axis(f, 'z'); }
bool is_padding(const PcdField& f) { return f.name == "_"; }

ScalarType type_of(const PcdField& f) {
  return attribute_type(f.type == 'F'   ? NumberKind::real
                        : f.type == 'I' ? NumberKind::whole
                                        : NumberKind::natural,
                        f.size);
}

/// Several values per point make a list whose rows are equally long.
void set_count(Attribute& attribute, const PcdField& f, std::size_t points) {
  if (f.count == 1) return;
  attribute.is_list = true;
  attribute.count_type = f.count <= 0xff     ? ScalarType::uint8
                         : f.count <= 0xffff ? ScalarType::uint16
                                             : ScalarType::uint32;
  attribute.offsets.resize(points + 1);
  for (std::size_t i = 0; i <= points; ++i) attribute.offsets[i] = i * f.count;
}

/// Whole numbers of 64 bits, in place, as the nearest doubles.
template <class Integer>
void to_doubles(std::vector<std::byte>& values) {
  for (std::size_t i = 0; i < values.size() / 8; ++i) {
    const auto value = static_cast<double>(load<Integer>(values.data(), i));
    std::memcpy(values.data() + 8 * i, &value, 8);
  }
}

/// The field whose rows lie `stride` bytes apart.
Attribute read_field(const PcdField& f, const char* from, std::size_t stride, std::size_t points) {
  const auto width = static_cast<std::size_t>(f.count) * f.size;
  Attribute attribute;
  attribute.name = f.name;
  attribute.type = type_of(f);
  attribute.values.resize(points * width);
  if (stride == width && points > 0)
    std::memcpy(attribute.values.data(), from, points * width);
  else
    for (std::size_t i = 0; i < points; ++i) std::memcpy(attribute.values.data() + i * width, from + i * stride, width);
  if (f.size == 8 && f.type == 'I') to_doubles<std::int64_t>(attribute.values);
  if (f.size == 8 && f.type == 'U') to_doubles<std::uint64_t>(attribute.values);
  set_count(attribute, f, points);
  return attribute;
}

/// One attribute per field that is no padding, in order.
std::vector<Attribute> read_binary(const FileContent& file, const PcdHeader& header) {
  const std::string_view data = file.bytes().substr(header.data_offset);
  const std::uint64_t row = header.row_bytes();
  if (header.points > data.size() / row)
    file.fail_at_byte(
        file.bytes().size(),
        "the header promises " + plural(header.points, "point") + " of " + plural(row, "byte") + ", but the file ends",
        cut_off);
  std::vector<Attribute> columns;
  const char* from = data.data();
  for (const PcdField& f : header.fields) {
    if (!is_padding(f)) columns.push_back(read_field(f, from, row, header.points));
    from += f.count * f.size;
  }
  return columns;
}

std::uint32_t load_uint32(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

std::vector<Attribute> read_compressed(const FileContent& file, const PcdHeader& header) {
  const std::string_view data = file.bytes().substr(header.data_offset);
  if (header.points == 0) return read_binary(file, header);
  if (data.size() < 8) file.fail_at_byte(file.bytes().size(), "the file ends before the compressed data", cut_off);
  const std::size_t packed_size = load_uint32(data, 0), size = load_uint32(data, 4);
  if (packed_size > data.size() - 8)
    file.fail_at_byte(file.bytes().size(),
                      "the file ends within " + plural(packed_size, "byte") + " of compressed data", cut_off);
  const std::uint64_t row = header.row_bytes();
  if (header.points > size / row || header.points * row != size)
    file.fail_at_byte(
        header.data_offset + 4,
        plural(size, "unpacked byte") + " do not make " + plural(header.points, "point") + " of " + plural(row, "byte"),
        "correct the header, or fetch the file again");
  std::string unpacked;
  std::size_t bad = 0;
  if (!lzf_unpack(data.substr(8, packed_size), size, unpacked, bad))
    file.fail_at_byte(header.data_offset + 8 + bad, "the compressed data are damaged", "fetch the file again");
  std::vector<Attribute> columns;
  const char* from = unpacked.data();
  for (const PcdField& f : header.fields) {
    const auto width = static_cast<std::size_t>(f.count) * f.size;
    if (!is_padding(f)) columns.push_back(read_field(f, from, width, header.points));
    from += width * header.points;
  }
  return columns;
}

class TextRows {
 public:
  TextRows(const FileContent& file, const PcdHeader& header)
      : header_(header), lines_(file, header.data_offset, header.lines) {}

  std::vector<Attribute> read() {
    const std::uint64_t row = header_.row_values();
    // A value takes a digit and the blank or line end behind it; the last line end may be missing.
    if (header_.points > (lines_.remaining() + 1) / 2 / row)
      lines_.fail("the file is too short for the " + plural(header_.points, "point") + " of the header", cut_off);
    values_.resize(header_.fields.size());
    for (std::uint64_t i = 0; i < header_.points; ++i) read_row(i, row);
    if (lines_.next_filled('#'))
      lines_.fail("more rows than the header's " + plural(header_.points, "point"), "correct POINTS, WIDTH and HEIGHT");
    std::vector<Attribute> columns;
    for (std::size_t k = 0; k < header_.fields.size(); ++k) {
      const PcdField& f = header_.fields[k];
      if (is_padding(f)) continue;
      // The text may say more digits of a coordinate than the declared type holds.
      const ScalarType type = is_axis(f) ? ScalarType::float64 : is_packed_colour(f) ? ScalarType::uint32 : type_of(f);
      columns.push_back(make_attribute(f.name, type, values_[k]));
      set_count(columns.back(), f, header_.points);
      values_[k] = {};
    }
    return columns;
  }

 private:
  void read_row(std::uint64_t i, std::uint64_t row) {
    if (!lines_.next_filled('#'))
      lines_.fail(
          "the header promises " + plural(header_.points, "point") + ", but only " + std::to_string(i) + " follow",
          cut_off);
    split_fields(lines_.line(), words_);
    drop_empty_end(words_, row);
    if (words_.size() != row)
      lines_.fail("the row has " + plural(words_.size(), "value") + " where the header names " + std::to_string(row),
                  "correct the row, or FIELDS and COUNT");
    check_decimal_commas(lines_);
    std::size_t word = 0;
    for (std::size_t k = 0; k < header_.fields.size(); ++k)
      for (std::uint64_t c = 0; c < header_.fields[k].count; ++c) read_value(header_.fields[k], k, words_[word++]);
  }

  void read_value(const PcdField& f, std::size_t k, std::string_view word) {
    if (is_padding(f)) return;
    double value = 0;
    bool good = parse(word, value);
    if (good && is_packed_colour(f)) {
      value = packed_colour(value);
    } else if (good && f.type != 'F' && !is_axis(f)) {
      const double span = std::ldexp(1.0, static_cast<int>(8 * f.size) - (f.type == 'I' ? 1 : 0));
      good = value == std::floor(value) && value < span && value >= (f.type == 'I' ? -span : 0);
    }
    if (!good) lines_.fail(shown(word) + " is no value of field " + shown(f.name), "correct it, or TYPE and SIZE");
    values_[k].push_back(value);
  }

  const PcdHeader& header_;
  LineScanner lines_;
  Fields words_;
  std::vector<std::vector<double>> values_;
};

void unpack_colour(const Attribute& packed, UniqueNames& unique, std::vector<Attribute>& attributes) {
  const bool has_alpha = packed.name == "rgba";
  const std::size_t points = packed.rows();
  for (const auto& [name, shift] :
       {std::pair{"red", 16}, std::pair{"green", 8}, std::pair{"blue", 0}, std::pair{"alpha", 24}}) {
    if (shift == 24 && !has_alpha) continue;
    Attribute channel;
    channel.name = unique(name);
    channel.type = ScalarType::uint8;
    channel.values.resize(points);
    for (std::size_t i = 0; i < points; ++i)
      channel.values[i] = static_cast<std::byte>((load<std::uint32_t>(packed.values.data(), i) >> shift) & 0xff);
    attributes.push_back(std::move(channel));
  }
}

std::string usual_name(const std::string& name) {
  for (const auto& [pcl, usual] : {std::pair{"normal_x", "nx"}, {"normal_y", "ny"}, {"normal_z", "nz"}})
    if (name == pcl) return usual;
  return name;
}

/// Coordinates, colours and all else from the columns.
PointCloud assemble(std::vector<Attribute> columns, const PcdHeader& header) {
  PointCloud cloud;
  cloud.points.resize(header.points);
  UniqueNames unique;
  std::size_t k = 0;
  for (const PcdField& f : header.fields) {
    if (is_padding(f)) continue;
    Attribute& column = columns[k++];
    if (is_axis(f)) {
      double Vec3::*const axis = is_axis(f, 'x') ? &Vec3::x : is_axis(f, 'y') ? &Vec3::y : &Vec3::z;
      with_scalar(column.type, [&]<class T>(std::type_identity<T>) {
        for (std::size_t i = 0; i < cloud.points.size(); ++i)
          cloud.points[i].*axis = static_cast<double>(load<T>(column.values.data(), i));
      });
    } else if (is_packed_colour(f)) {
      unpack_colour(column, unique, cloud.attributes);
    } else {
      column.name = unique(usual_name(column.name));
      cloud.attributes.push_back(std::move(column));
    }
    column = {};
  }
  return cloud;
}

void check_axes(const FileContent& file, const PcdHeader& header) {
  for (const char axis : {'x', 'y', 'z'}) {
    int found = 0;
    for (const PcdField& f : header.fields) {
      if (!is_axis(f, axis)) continue;
      ++found;
      if (f.count != 1) file.fail("field " + shown(f.name) + " has more than one value", "use COUNT 1 for x, y and z");
    }
    if (found != 1)
      file.fail(std::string(found == 0 ? "no field" : "more than one field") + " is named " + axis,
                "name x, y and z once each in FIELDS");
  }
}

/// Programs differ in what they mean by VIEWPOINT: see PcdViewpoint.
void use_viewpoint(PointCloud& cloud, const PcdHeader& header, PcdViewpoint mode, const FileContent& file,
                   std::vector<std::string>& notes) {
  if (!header.viewpoint) {
    notes.emplace_back("no VIEWPOINT: the sensor's position is not known");
    return;
  }
  const auto& v = *header.viewpoint;
  Pose pose;
  pose.translation = {v[0], v[1], v[2]};
  std::string place = "VIEWPOINT (";
  for (std::size_t i = 0; i < 3; ++i) {
    if (i > 0) place += ", ";
    append_number(place, v[i]);
  }
  place += ")";
  if (mode == PcdViewpoint::none) {
    notes.push_back(place + " not used");
  } else if (mode == PcdViewpoint::automatic && pose.translation == Vec3{}) {
    notes.push_back(place + " read as not known");
  } else if (mode == PcdViewpoint::pose) {
    if (!set_rotation(pose, v[3], v[4], v[5], v[6]))
      file.fail_at_line(header.viewpoint_line, "the quaternion of VIEWPOINT has no direction",
                        "write qw qx qy qz, 1 0 0 0 for no rotation");
    apply(pose, cloud);
    set_sensor(cloud, {pose.translation, false});
    notes.push_back(place + " read as the scan's pose: points and normals were moved by it");
  } else {
    set_sensor(cloud, {pose.translation, false});
    notes.push_back(place + " read as the sensor's position: the points were not moved");
  }
}

} // namespace

PointCloud read_pcd(const FileContent& file, const ReadOptions& options, std::vector<std::string>& notes) {
  const PcdHeader header = read_pcd_header(file);
  check_axes(file, header);
  std::vector<Attribute> columns;
  switch (header.encoding) {
    case PcdEncoding::ascii:
      columns = TextRows(file, header).read();
      break;
    case PcdEncoding::binary:
      columns = read_binary(file, header);
      break;
    case PcdEncoding::binary_compressed:
      columns = read_compressed(file, header);
      break;
  }
  PointCloud cloud = assemble(std::move(columns), header);
  if (header.height > 1 && header.width > 1) {
    std::vector<std::uint64_t> cells(cloud.points.size());
    std::iota(cells.begin(), cells.end(), std::uint64_t{0});
    add_grid_columns(cloud, cells, header.width);
  }
  use_viewpoint(cloud, header, options.pcd_viewpoint, file, notes);
  return cloud;
}

bool looks_like_pcd(const FileContent& file) {
  LineScanner lines(file);
  while (lines.next()) {
    std::string_view line = lines.line();
    if (line.starts_with('#') && lines.number() <= 100) continue;
    const std::string_view word = next_word(line);
    double version = 0;
    if (word == "VERSION") return parse(next_word(line), version);
    return word == "FIELDS" || word == "COLUMNS";
  }
  return false;
}

} // namespace eigencrust::io
