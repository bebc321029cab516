// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <limits>
#include <memory>

#include <eigencrust/error.h>

#include "io/attributes.h"
#include "io/binary_output.h"
#include "io/colours.h"
#include "io/formats.h"
#include "io/ply.h"
#include "io/precision.h"
#include "io/text_output.h"

namespace eigencrust::io {
namespace {

/// A row of a list may be longer than the type of its length allows; then the type is widened.
ScalarType count_type_of(const Attribute& list) {
  std::uint64_t longest = 0;
  for (std::size_t i = 0; i + 1 < list.offsets.size(); ++i)
    longest = std::max(longest, list.offsets[i + 1] - list.offsets[i]);
  const bool fits = !is_floating(list.count_type) && with_scalar(list.count_type, [&]<class T>(std::type_identity<T>) {
    return static_cast<double>(longest) <= static_cast<double>(std::numeric_limits<T>::max());
  });
  return fits ? list.count_type : ScalarType::uint32;
}

/// A property of the file: an attribute under a name that PLY can hold.
struct Property {
  const Attribute* attribute;
  std::string name;
  ScalarType count_type;
};

std::vector<Property> make_properties(const std::vector<Attribute>& attributes, UniqueNames unique,
                                      std::vector<std::string>& warnings) {
  std::vector<Property> properties;
  for (const Attribute& attribute : attributes) {
    std::string name;
    for (const char c : attribute.name) name += static_cast<unsigned char>(c) <= ' ' || c == '\x7f' ? '_' : c;
    name = unique(name.empty() ? "attribute" : name);
    if (name != attribute.name) warnings.push_back("attribute '" + attribute.name + "' is written as '" + name + "'");
    properties.push_back({&attribute, name, count_type_of(attribute)});
  }
  return properties;
}

/// The colours that viewers expect, where the attributes have them in another form, and the attributes behind them.
struct VertexColumns {
  std::vector<Attribute> colours;
  std::vector<Property> properties;
};

/// Attributes whose names the colours take get the suffix _original.
std::shared_ptr<const VertexColumns> make_vertex_columns(const std::vector<Attribute>& attributes,
                                                         std::vector<std::string>& warnings) {
  auto columns = std::make_shared<VertexColumns>();
  const auto colours = find_colours(attributes);
  UniqueNames unique{"x", "y", "z"};
  if (!colours || colours->plain) {
    columns->properties = make_properties(attributes, std::move(unique), warnings);
    return columns;
  }
  columns->colours = colours->attributes();
  columns->properties = make_properties(columns->colours, unique, warnings);
  for (const Attribute& colour : columns->colours) unique(colour.name);
  std::vector<std::string> renamed;
  for (Property& property : make_properties(attributes, unique, renamed)) {
    const std::string& name = property.attribute->name;
    if (find_attribute(columns->colours, name) != nullptr) property.name = unique(name + "_original");
    if (property.name != name) warnings.push_back("attribute '" + name + "' is written as '" + property.name + "'");
    columns->properties.push_back(std::move(property));
  }
  return columns;
}

void append_declarations(std::string& header, const std::vector<Property>& properties) {
  for (const Property& property : properties) {
    header += "property ";
    if (property.attribute->is_list) header += std::string("list ") + ply_type_name(property.count_type) + ' ';
    header += std::string(ply_type_name(property.attribute->type)) + ' ' + property.name + '\n';
  }
}

void append_row(BinaryBuffer& buffer, const Property& property, std::size_t row) {
  const Attribute& attribute = *property.attribute;
  const std::size_t size = size_of(attribute.type);
  if (!attribute.is_list) {
    buffer.append_values(attribute.values.data() + row * size, 1, size);
    return;
  }
  const std::uint64_t begin = attribute.offsets[row], entries = attribute.offsets[row + 1] - begin;
  with_scalar(property.count_type, [&]<class T>(std::type_identity<T>) { buffer.append(static_cast<T>(entries)); });
  buffer.append_values(attribute.values.data() + begin * size, entries, size);
}

std::string start_header(std::span<const Vec3> points, const std::vector<Property>& properties,
                         const WriteOptions& options, CoordinateType coordinates) {
  std::string header = "ply\nformat binary_little_endian 1.0\n";
  append_comments(header, "comment ", options.comments);
  header += "element vertex " + std::to_string(points.size()) + '\n';
  for (const char* axis : {"x", "y", "z"})
    header += std::string("property ") + (coordinates == CoordinateType::float32 ? "float " : "double ") + axis + '\n';
  append_declarations(header, properties);
  return header;
}

void append_vertices(BinaryBuffer& buffer, std::span<const Vec3> points, const std::vector<Property>& properties,
                     CoordinateType coordinates) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (const double v : {points[i].x, points[i].y, points[i].z}) {
      if (coordinates == CoordinateType::float32)
        buffer.append(static_cast<float>(v));
      else
        buffer.append(v);
    }
    for (const Property& property : properties) append_row(buffer, property, i);
  }
}

void append_header(BinaryBuffer& buffer, const std::string& header) {
  buffer.append_values(reinterpret_cast<const std::byte*>(header.data()), header.size(), 1);
}

} // namespace

Body prepare_ply(const TriangleMesh& mesh, const WriteOptions& options, WriteResult& result) {
  result.coordinates =
      choose_coordinates(mesh.vertices, options.spacing > 0 ? options.spacing : median_edge(mesh), options);
  if (options.coordinates == CoordinateType::float32 && !distinct_as_float(mesh.vertices))
    throw Error(ErrorKind::guarantee, "PLY", "32-bit coordinates would make different vertices equal",
                "write 64-bit coordinates");
  const auto vertex = make_vertex_columns(mesh.vertex_attributes, result.warnings);
  const auto face = make_properties(mesh.triangle_attributes, {"vertex_indices", "vertex_index"}, result.warnings);
  const bool wide = mesh.vertices.size() > std::size_t{1} << 31;
  std::string header = start_header(mesh.vertices, vertex->properties, options, result.coordinates);
  header += "element face " + std::to_string(mesh.triangles.size()) + '\n';
  header += std::string("property list uchar ") + (wide ? "uint" : "int") + " vertex_indices\n";
  append_declarations(header, face);
  header += "end_header\n";
  return [&mesh, vertex, face, header, coordinates = result.coordinates](std::ostream& out) {
    BinaryBuffer buffer(out);
    append_header(buffer, header);
    append_vertices(buffer, mesh.vertices, vertex->properties, coordinates);
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
      buffer.append(std::uint8_t{3});
      for (const std::uint32_t corner : mesh.triangles[i]) buffer.append(corner);
      for (const Property& property : face) append_row(buffer, property, i);
    }
  };
}

Body prepare_ply(const PointCloud& cloud, const WriteOptions& options, WriteResult& result) {
  result.coordinates = choose_coordinates(cloud.points, options.spacing, options);
  if (options.coordinates == CoordinateType::float32 && !distinct_as_float(cloud.points))
    result.warnings.emplace_back("32-bit coordinates make different points equal");
  const auto vertex = make_vertex_columns(cloud.attributes, result.warnings);
  const std::string header =
      start_header(cloud.points, vertex->properties, options, result.coordinates) + "end_header\n";
  return [&cloud, vertex, header, coordinates = result.coordinates](std::ostream& out) {
    BinaryBuffer buffer(out);
    append_header(buffer, header);
    append_vertices(buffer, cloud.points, vertex->properties, coordinates);
  };
}

} // namespace eigencrust::io
