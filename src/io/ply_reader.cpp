// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <bit>
#include <limits>
#include <numeric>

#include <eigencrust/error.h>

#include "io/attributes.h"
#include "io/formats.h"
#include "io/ply.h"
#include "io/polygons.h"
#include "io/text.h"
#include "surface/scalar.h"

namespace eigencrust::io {
namespace {

constexpr const char* cut_off_or_miscounted = "the file is cut off or its header is wrong: fetch it again";

std::vector<Attribute> empty_columns(const PlyElement& element) {
  std::vector<Attribute> columns;
  for (const PlyProperty& property : element.properties) {
    Attribute column;
    column.name = property.name;
    column.type = property.type;
    column.is_list = property.is_list;
    column.count_type = property.count_type;
    if (property.is_list) column.offsets.push_back(0);
    columns.push_back(std::move(column));
  }
  return columns;
}

void append_bytes(std::vector<std::byte>& values, const char* begin, std::size_t size) {
  const auto* bytes = reinterpret_cast<const std::byte*>(begin);
  values.insert(values.end(), bytes, bytes + size);
}

/// Reads the elements of a binary file one after another.
class BinaryElements {
 public:
  BinaryElements(const FileContent& file, const PlyHeader& header)
      : file_(file),
        bytes_(file.bytes()),
        position_(header.data_offset),
        swap_((header.encoding == PlyEncoding::big_endian) != (std::endian::native == std::endian::big)) {}

  /// The element's columns; none when not `wanted`.
  std::vector<Attribute> read(const PlyElement& element, bool wanted) {
    std::size_t row_size = 0;
    bool has_list = false;
    for (const PlyProperty& property : element.properties) {
      row_size += size_of(property.is_list ? property.count_type : property.type);
      has_list = has_list || property.is_list;
    }
    if (row_size == 0) return {};
    const std::uint64_t left = bytes_.size() - position_;
    if (element.count > left / row_size)
      file_.fail_at_byte(bytes_.size(),
                         "the file ends within element " + shown(element.name) + ", which has " +
                             plural(element.count, "row") + " of " + (has_list ? "at least " : "") +
                             plural(row_size, "byte") + ",",
                         cut_off_or_miscounted);
    std::vector<Attribute> columns;
    if (has_list) {
      columns = read_rows(element, wanted);
    } else {
      if (wanted) columns = read_table(element, row_size);
      position_ += static_cast<std::size_t>(element.count) * row_size;
    }
    if (swap_)
      for (Attribute& column : columns) swap_bytes(column.values, size_of(column.type));
    return columns;
  }

 private:
  std::vector<Attribute> read_table(const PlyElement& element, std::size_t row_size) const {
    std::vector<Attribute> columns = empty_columns(element);
    const auto rows = static_cast<std::size_t>(element.count);
    const char* from = bytes_.data() + position_;
    for (Attribute& column : columns) {
      const std::size_t size = size_of(column.type);
      column.values.resize(rows * size);
      with_scalar(column.type, [&]<class T>(std::type_identity<T>) {
        // The constant size lets the compiler copy with a single move.
        for (std::size_t i = 0; i < rows; ++i)
          std::memcpy(column.values.data() + i * sizeof(T), from + i * row_size, sizeof(T));
      });
      from += size;
    }
    return columns;
  }

  std::vector<Attribute> read_rows(const PlyElement& element, bool wanted) {
    std::vector<Attribute> columns = empty_columns(element);
    for (std::uint64_t row = 0; row < element.count; ++row) {
      for (Attribute& column : columns) {
        const std::size_t size = size_of(column.type);
        const std::size_t entries = column.is_list ? read_length(column, element, row) : 1;
        if (entries > (bytes_.size() - position_) / size) fail_within(element, row);
        if (wanted) {
          append_bytes(column.values, bytes_.data() + position_, entries * size);
          if (column.is_list) column.offsets.push_back(column.values.size() / size);
        }
        position_ += entries * size;
      }
    }
    if (!wanted) columns.clear();
    return columns;
  }

  std::size_t read_length(const Attribute& column, const PlyElement& element, std::uint64_t row) {
    const std::size_t size = size_of(column.count_type);
    if (size > bytes_.size() - position_) fail_within(element, row);
    std::array<std::byte, 8> value{};
    std::memcpy(value.data(), bytes_.data() + position_, size);
    if (swap_) swap_bytes({value.data(), size}, size);
    const double length = load_as_double(column.count_type, value.data(), 0);
    if (length < 0)
      file_.fail_at_byte(position_, "negative list length in " + place(element, row), cut_off_or_miscounted);
    position_ += size;
    return static_cast<std::size_t>(length);
  }

  static std::string place(const PlyElement& element, std::uint64_t row) {
    return "row " + std::to_string(row) + " of element " + shown(element.name);
  }
  [[noreturn]] void fail_within(const PlyElement& element, std::uint64_t row) const {
    file_.fail_at_byte(bytes_.size(), "the file ends within " + place(element, row) + ",", cut_off_or_miscounted);
  }

  const FileContent& file_;
  std::string_view bytes_;
  std::size_t position_;
  bool swap_;
};

/// Reads the elements of a text file one after another, a row per line.
class TextElements {
 public:
  TextElements(const FileContent& file, const PlyHeader& header) : lines_(file, header.data_offset, header.lines) {}

  std::vector<Attribute> read(const PlyElement& element, bool wanted) {
    if (element.properties.empty()) return {};
    // A value takes a digit and the blank or line end behind it; the last line end may be missing.
    const std::uint64_t row_size = 2 * element.properties.size();
    if (element.count > (lines_.remaining() + 1) / row_size) fail_short(element, "too short to hold");
    std::vector<Attribute> columns = empty_columns(element);
    row_lines_.clear();
    for (std::uint64_t row = 0; row < element.count; ++row) {
      if (!lines_.next_filled()) fail_short(element, "the file ends after row " + std::to_string(row) + " of");
      if (!wanted) continue;
      read_row(columns);
      row_lines_.push_back(lines_.number());
    }
    if (!wanted) columns.clear();
    return columns;
  }

  /// The line of each row of the element read last.
  std::vector<std::uint64_t> row_lines() { return std::move(row_lines_); }

  void expect_end() {
    if (lines_.next_filled()) lines_.fail("more rows than the PLY header declares", "correct the counts in the header");
  }

 private:
  void read_row(std::vector<Attribute>& columns) {
    std::string_view rest = lines_.line();
    for (Attribute& column : columns) {
      if (!column.is_list) {
        read_value(column, rest);
        continue;
      }
      std::uint64_t entries = 0;
      const std::string_view word = next_word(rest);
      if (!parse(word, entries)) fail_value(word, column.name);
      if (entries > (rest.size() + 1) / 2) lines_.fail("the list is longer than its line", cut_off_or_miscounted);
      for (std::uint64_t k = 0; k < entries; ++k) read_value(column, rest);
      column.offsets.push_back(column.values.size() / size_of(column.type));
    }
    if (!trim(rest).empty())
      lines_.fail("the line holds more values than the PLY header declares", "correct the properties in the header");
  }

  void read_value(Attribute& column, std::string_view& rest) {
    const std::string_view word = next_word(rest);
    const bool good = with_scalar(column.type, [&]<class T>(std::type_identity<T>) {
      T value{};
      if constexpr (std::is_integral_v<T>) {
        std::int64_t wide = 0;
        if (!parse(word, wide) || !std::in_range<T>(wide)) return false;
        value = static_cast<T>(wide);
      } else if (!parse(word, value)) {
        return false;
      }
      append_bytes(column.values, reinterpret_cast<const char*>(&value), sizeof value);
      return true;
    });
    if (!good) fail_value(word, column.name);
  }

  [[noreturn]] void fail_value(std::string_view word, const std::string& name) const {
    if (word.empty()) lines_.fail("the line ends before property " + shown(name), cut_off_or_miscounted);
    lines_.fail(shown(word) + " is no value of property " + shown(name), "correct the value or the property's type");
  }
  [[noreturn]] void fail_short(const PlyElement& element, const std::string& cause) const {
    lines_.fail(cause + " the " + plural(element.count, "row") + " of element " + shown(element.name),
                cut_off_or_miscounted);
  }

  LineScanner lines_;
  std::vector<std::uint64_t> row_lines_;
};

const PlyElement* find_element(const PlyHeader& header, std::string_view name, const FileContent& file) {
  const PlyElement* found = nullptr;
  for (const PlyElement& element : header.elements) {
    if (element.name != name) continue;
    if (found != nullptr)
      file.fail_at_line(element.line, "element " + shown(name) + " is declared twice", "repair the header");
    found = &element;
  }
  return found;
}

void check_vertex_element(const PlyElement* vertex, const FileContent& file) {
  if (vertex == nullptr) file.fail("the PLY file has no vertex element", "use a file that holds points");
  for (const std::string_view axis : {"x", "y", "z"}) {
    int declared = 0;
    const bool exact = std::any_of(vertex->properties.begin(), vertex->properties.end(),
                                   [&](const PlyProperty& p) { return p.name == axis; });
    for (const PlyProperty& property : vertex->properties) {
      // X counts where there is no x.
      if (exact ? property.name != axis : !equal_ignoring_case(property.name, axis)) continue;
      ++declared;
      if (property.is_list)
        file.fail_at_line(vertex->line, "property " + shown(axis) + " is a list", "declare x, y and z as numbers");
    }
    if (declared == 0)
      file.fail_at_line(vertex->line, "the vertex element has no property " + shown(axis),
                        "use a file whose vertices have x, y and z");
    if (declared > 1)
      file.fail_at_line(vertex->line, "property " + shown(axis) + " is declared twice", "repair the header");
  }
}

struct Tables {
  std::vector<Attribute> vertex, face;
  std::vector<std::uint64_t> face_lines; ///< of a text file: for messages
};

Tables read_tables(const FileContent& file, bool faces_wanted) {
  const PlyHeader header = read_ply_header(file);
  const PlyElement* vertex = find_element(header, "vertex", file);
  const PlyElement* face = find_element(header, "face", file);
  check_vertex_element(vertex, file);
  Tables tables;
  const auto read_all = [&](auto&& elements) {
    for (const PlyElement& element : header.elements) {
      const bool wanted = &element == vertex || (faces_wanted && &element == face);
      std::vector<Attribute> columns = elements.read(element, wanted);
      if (&element == vertex)
        tables.vertex = std::move(columns);
      else if (&element == face)
        tables.face = std::move(columns);
      if constexpr (std::is_same_v<std::remove_reference_t<decltype(elements)>, TextElements>)
        if (wanted && &element == face) tables.face_lines = elements.row_lines();
    }
  };
  if (header.encoding == PlyEncoding::ascii) {
    TextElements elements(file, header);
    read_all(elements);
    elements.expect_end();
  } else {
    read_all(BinaryElements(file, header));
  }
  return tables;
}

/// Takes x, y and z out of the columns.
std::vector<Vec3> take_points(std::vector<Attribute>& columns) {
  std::vector<Vec3> points;
  constexpr std::array<std::pair<const char*, double Vec3::*>, 3> axes = {
      {{"x", &Vec3::x}, {"y", &Vec3::y}, {"z", &Vec3::z}}};
  for (const auto& [name, axis] : axes) {
    auto column = std::find_if(columns.begin(), columns.end(), [n = name](const Attribute& a) { return a.name == n; });
    if (column == columns.end()) // an upper case X, where there is no x
      column = std::find_if(columns.begin(), columns.end(),
                            [n = name](const Attribute& a) { return equal_ignoring_case(a.name, n); });
    points.resize(column->rows());
    with_scalar(column->type, [&, a = axis]<class T>(std::type_identity<T>) {
      for (std::size_t i = 0; i < points.size(); ++i)
        points[i].*a = static_cast<double>(load<T>(column->values.data(), i));
    });
    columns.erase(column);
  }
  UniqueNames unique;
  for (Attribute& column : columns) column.name = unique(column.name);
  return points;
}

[[noreturn]] void fail_index(const FileContent& file, const Tables& tables, std::size_t face, std::size_t vertices) {
  const std::string cause = "face " + std::to_string(face) + " names a vertex that does not exist (there are " +
                            std::to_string(vertices) + ")";
  const char* remedy = "repair the mesh: vertices are counted from 0";
  if (face < tables.face_lines.size()) file.fail_at_line(tables.face_lines[face], cause, remedy);
  file.fail(cause, remedy);
}

/// Splits the polygons and repeats the faces' other properties for each triangle. Lists (of texture
/// coordinates, say) belong to the corners of their polygon: they are kept where all are triangles.
void add_faces(TriangleMesh& mesh, Tables& tables, const FileContent& file) {
  const auto indices = std::find_if(tables.face.begin(), tables.face.end(), [](const Attribute& a) {
    return a.is_list && (a.name == "vertex_indices" || a.name == "vertex_index");
  });
  if (indices == tables.face.end()) return;
  const std::size_t faces = indices->rows();
  std::vector<std::uint32_t> corners, face_of;
  bool all_triangles = true;
  for (std::size_t face = 0; face < faces; ++face) {
    corners.clear();
    for (std::uint64_t k = indices->offsets[face]; k < indices->offsets[face + 1]; ++k) {
      const double index = load_as_double(indices->type, indices->values.data(), k);
      if (!(index >= 0 && index < static_cast<double>(mesh.vertices.size())) || index != std::floor(index))
        fail_index(file, tables, face, mesh.vertices.size());
      corners.push_back(static_cast<std::uint32_t>(index));
    }
    add_polygon(mesh, corners);
    face_of.resize(mesh.triangles.size(), static_cast<std::uint32_t>(face));
    all_triangles = all_triangles && corners.size() == 3;
  }
  tables.face.erase(indices);
  UniqueNames unique;
  for (Attribute& column : tables.face) {
    if (column.is_list && !all_triangles) continue;
    mesh.triangle_attributes.push_back(all_triangles ? std::move(column) : gather(column, face_of));
    mesh.triangle_attributes.back().name = unique(mesh.triangle_attributes.back().name);
  }
}

} // namespace

PointCloud read_ply_cloud(const FileContent& file) {
  Tables tables = read_tables(file, false);
  PointCloud cloud;
  cloud.points = take_points(tables.vertex);
  cloud.attributes = std::move(tables.vertex);
  return cloud;
}

TriangleMesh read_ply_mesh(const FileContent& file) {
  Tables tables = read_tables(file, true);
  TriangleMesh mesh;
  mesh.vertices = take_points(tables.vertex);
  mesh.vertex_attributes = std::move(tables.vertex);
  check_vertex_count(mesh, file);
  add_faces(mesh, tables, file);
  return mesh;
}

} // namespace eigencrust::io
