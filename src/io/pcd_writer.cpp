// SPDX-License-Identifier: GPL-3.0-or-later
// PCD 0.7, binary, with the names that the Point Cloud Library knows (rgb, normal_x ...).
#include <algorithm>
#include <array>

#include "io/attributes.h"
#include "io/binary_output.h"
#include "io/colours.h"
#include "io/formats.h"
#include "io/precision.h"
#include "io/text_output.h"

namespace eigencrust::io {
namespace {

constexpr std::array<std::pair<const char*, const char*>, 3> normals{
    {{"nx", "normal_x"}, {"ny", "normal_y"}, {"nz", "normal_z"}}};

/// A field of the file: an attribute, or the colour packed into four bytes.
struct Field {
  const Attribute* attribute; ///< null: the colour
  std::string name;
};

/// Colours are packed. Columns that hold more than these bytes, or bytes in another form, stay beside them.
std::vector<Field> make_fields(const PointCloud& cloud, const std::optional<ViewerColours>& colours,
                               std::vector<std::string>& warnings) {
  std::vector<Field> fields;
  UniqueNames unique{"x", "y", "z", "X", "Y", "Z", "_", "rgb", "rgba"};
  const bool replaces = colours && (colours->plain || colours->source.size() == 1);
  const bool is_beside = colours && !replaces;
  if (is_beside) fields.push_back({nullptr, "rgb"});
  for (const Attribute& a : cloud.attributes) {
    if (a.is_list) {
      warnings.push_back("PCD has no room for the list attribute " + a.name);
      continue;
    }
    const bool is_colour = colours && colours->is_source(a);
    const bool is_alpha = is_colour && colours->source.size() == 4 && colours->source[3] == &a;
    if (replaces && is_colour && !is_alpha) {
      if (&a == colours->source[0]) fields.push_back({nullptr, "rgb"});
      continue;
    }
    std::string name;
    for (const char c : a.name) name += static_cast<unsigned char>(c) <= ' ' || c == '\x7f' || c == '#' ? '_' : c;
    if (is_beside && (name == "red" || name == "green" || name == "blue")) name += "_original";
    name = unique(name.empty() ? "field" : name);
    if (name != a.name) warnings.push_back("attribute '" + a.name + "' is written as '" + name + "'");
    for (const auto& [usual, pcl] : normals)
      if (name == usual) name = unique(pcl);
    fields.push_back({&a, name});
  }
  return fields;
}

char type_letter(ScalarType type) {
  if (is_floating(type)) return 'F';
  const bool is_signed = type == ScalarType::int8 || type == ScalarType::int16 || type == ScalarType::int32;
  return is_signed ? 'I' : 'U';
}

std::string make_header(const PointCloud& cloud, const std::vector<Field>& fields, const WriteOptions& options,
                        CoordinateType coordinates) {
  const std::string axis_size = coordinates == CoordinateType::float32 ? " 4" : " 8";
  std::string names = "FIELDS x y z", sizes = std::string("SIZE").append(axis_size).append(axis_size).append(axis_size),
              types = "TYPE F F F", counts = "COUNT 1 1 1";
  for (const Field& f : fields) {
    names.append(" ").append(f.name);
    // As a real number, which all readers of the library's time accept.
    sizes.append(" ").append(std::to_string(f.attribute == nullptr ? 4 : size_of(f.attribute->type)));
    types.append(" ").append(1, f.attribute == nullptr ? 'F' : type_letter(f.attribute->type));
    counts += " 1";
  }
  std::string viewpoint = "0 0 0";
  if (const auto sensor = viewpoint_of(cloud)) {
    viewpoint.clear();
    append_point(viewpoint, *sensor, ' ', false);
  }
  const std::string n = std::to_string(cloud.points.size());
  std::string header = "# .PCD v0.7 - Point Cloud Data file format\n";
  append_comments(header, "# ", options.comments);
  return header + "VERSION 0.7\n" + names + "\n" + sizes + "\n" + types + "\n" + counts + "\nWIDTH " + n +
         "\nHEIGHT 1\nVIEWPOINT " + viewpoint + " 1 0 0 0\nPOINTS " + n + "\nDATA binary\n";
}

std::uint32_t packed_colour(const ViewerColours& colours, std::size_t row) {
  std::uint32_t packed = 0;
  for (std::size_t k = 0; k < 3; ++k) packed = packed << 8 | colours.rgba[k][row];
  return packed;
}

} // namespace

std::optional<Vec3> viewpoint_of(const PointCloud& cloud) {
  const bool one = cloud.sensors.size() == 1 && !cloud.sensors[0].at_infinity && is_finite(cloud.sensors[0].place) &&
                   cloud.sensors[0].place != Vec3{}; // which means "not known" to readers
  const bool all = std::all_of(cloud.sensor_of.begin(), cloud.sensor_of.end(), [](std::uint32_t s) { return s == 0; });
  return one && all && !cloud.sensor_of.empty() ? std::optional(cloud.sensors[0].place) : std::nullopt;
}

Body prepare_pcd(const PointCloud& cloud, const WriteOptions& options, WriteResult& result) {
  result.coordinates = choose_coordinates(cloud.points, options.spacing, options);
  const auto colours = find_colours(cloud.attributes);
  const std::vector<Field> fields = make_fields(cloud, colours, result.warnings);
  const std::string header = make_header(cloud, fields, options, result.coordinates);
  return
      [&cloud, colours, fields, header, as_float = result.coordinates == CoordinateType::float32](std::ostream& out) {
        BinaryBuffer buffer(out);
        buffer.append_values(reinterpret_cast<const std::byte*>(header.data()), header.size(), 1);
        for (std::size_t i = 0; i < cloud.points.size(); ++i) {
          for (const double v : {cloud.points[i].x, cloud.points[i].y, cloud.points[i].z}) {
            if (as_float)
              buffer.append(static_cast<float>(v));
            else
              buffer.append(v);
          }
          for (const Field& f : fields) {
            if (f.attribute == nullptr) {
              buffer.append(packed_colour(*colours, i));
              continue;
            }
            const std::size_t size = size_of(f.attribute->type);
            buffer.append_values(f.attribute->values.data() + i * size, 1, size);
          }
        }
      };
}

} // namespace eigencrust::io
