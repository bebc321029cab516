// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "io/attributes.h"
#include "io/colours.h"
#include "io/formats.h"
#include "io/polygons.h"
#include "io/text_output.h"

namespace eigencrust::io {
namespace {

/// Joins lines that end in a backslash.
class ObjLines {
 public:
  explicit ObjLines(const FileContent& file) : lines_(file) {}

  bool next() {
    if (!lines_.next()) return false;
    line_ = trim(lines_.line());
    number_ = lines_.number();
    if (!line_.ends_with('\\')) return true;
    joined_.clear();
    while (line_.ends_with('\\')) {
      joined_ += line_.substr(0, line_.size() - 1);
      joined_ += ' ';
      line_ = lines_.next() ? trim(lines_.line()) : std::string_view{};
    }
    joined_ += line_;
    line_ = joined_;
    return true;
  }
  [[nodiscard]] std::string_view line() const { return line_; }
  /// Of the first of the joined lines.
  [[nodiscard]] std::uint64_t number() const { return number_; }

 private:
  LineScanner lines_;
  std::string_view line_;
  std::string joined_;
  std::uint64_t number_ = 0;
};

class ObjReader {
 public:
  explicit ObjReader(const FileContent& file) : file_(file), lines_(file) {}

  TriangleMesh read() {
    while (lines_.next()) {
      std::string_view rest = lines_.line();
      const std::string_view keyword = next_word(rest);
      if (keyword == "v")
        read_vertex(rest);
      else if (keyword == "f")
        read_face(rest);
    }
    if (mesh_.vertices.empty()) file_.fail("the file has no vertex lines", "use an OBJ file that holds points");
    check_vertex_count(mesh_, file_);
    // A face may come before its vertices, so that the largest index is judged last.
    if (largest_index_ >= mesh_.vertices.size()) fail_index(largest_line_, largest_index_ + 1);
    if (!colours_.empty()) {
      colours_.resize(3 * mesh_.vertices.size(), 1.0);
      const bool bytes = std::any_of(colours_.begin(), colours_.end(), [](double c) { return c > 1; });
      mesh_.vertex_attributes = colour_attributes(colours_, 3, bytes);
    }
    return std::move(mesh_);
  }

 private:
  /// x y z, x y z w, x y z r g b or x y z r g b a; the weight w only matters to curves.
  void read_vertex(std::string_view text) {
    split_words(text.substr(0, text.find('#')), fields_);
    const std::size_t count = fields_.size();
    if (count < 3 || count == 5 || count > 7)
      fail("a vertex has " + plural(count, "value"), "write v x y z or v x y z red green blue");
    std::array<double, 7> values{};
    for (std::size_t k = 0; k < count; ++k)
      if (!parse(fields_[k], values[k])) fail(shown(fields_[k]) + " is no number", "correct the vertex");
    if (count >= 6) {
      colours_.resize(3 * mesh_.vertices.size(), 1.0); // those without a colour are white
      colours_.insert(colours_.end(), {values[3], values[4], values[5]});
    }
    mesh_.vertices.push_back({values[0], values[1], values[2]});
  }

  void read_face(std::string_view text) {
    text = text.substr(0, text.find('#'));
    corners_.clear();
    for (std::string_view word = next_word(text); !word.empty(); word = next_word(text)) {
      // v, v/t, v//n or v/t/n: only v is of interest.
      const std::string_view number = word.substr(0, word.find('/'));
      std::int64_t index = 0;
      if (!parse(number, index) || index == 0)
        fail(shown(word) + " is no vertex of a face", "write the vertices' numbers, counted from 1");
      const auto known = static_cast<std::int64_t>(mesh_.vertices.size());
      if (index < -known || index > std::int64_t{SampleIndex::none}) fail_index(lines_.number(), index);
      const auto corner = static_cast<std::uint32_t>(index < 0 ? known + index : index - 1);
      if (corner >= largest_index_ || largest_line_ == 0) {
        largest_index_ = corner;
        largest_line_ = lines_.number();
      }
      corners_.push_back(corner);
    }
    add_polygon(mesh_, corners_);
  }

  template <class Integer>
  [[noreturn]] void fail_index(std::uint64_t line, Integer index) const {
    file_.fail_at_line(line,
                       "a face names vertex " + std::to_string(index) + " of " + std::to_string(mesh_.vertices.size()),
                       "repair the mesh: vertices are counted from 1");
  }
  [[noreturn]] void fail(const std::string& cause, const std::string& remedy) const {
    file_.fail_at_line(lines_.number(), cause, remedy);
  }

  const FileContent& file_;
  ObjLines lines_;
  TriangleMesh mesh_;
  Fields fields_;
  std::vector<double> colours_; ///< 3 per vertex, up to the last vertex that has a colour
  std::vector<std::uint32_t> corners_;
  std::uint32_t largest_index_ = 0;
  std::uint64_t largest_line_ = 0; ///< 0: no face yet
};

/// `v x y z`, with the colour where there is one.
void append_vertex(std::string& text, const Vec3& p, const std::optional<ViewerColours>& colours, std::size_t row,
                   bool as_float) {
  text += "v ";
  append_point(text, p, ' ', as_float);
  if (colours) {
    for (std::size_t k = 0; k < 3; ++k) {
      text += ' ';
      // A float's own digits: as a double it would have eight more that mean nothing.
      append_coordinate(text, colours->fraction(k, row), colours->source[0]->type == ScalarType::float32);
    }
  }
  text += '\n';
}

/// nx, ny and nz; empty: they are not all there.
std::vector<const Attribute*> find_normals(const std::vector<Attribute>& attributes) {
  std::vector<const Attribute*> normals;
  for (const char* name : {"nx", "ny", "nz"}) {
    const Attribute* column = find_attribute(attributes, name);
    if (column == nullptr || column->is_list) return {};
    normals.push_back(column);
  }
  return normals;
}

} // namespace

TriangleMesh read_obj(const FileContent& file) { return ObjReader(file).read(); }

Body prepare_obj(const TriangleMesh& mesh, const WriteOptions& options, WriteResult& result) {
  const bool as_float = options.coordinates == CoordinateType::float32;
  result.coordinates = as_float ? CoordinateType::float32 : CoordinateType::float64;
  const auto colours = find_colours(mesh.vertex_attributes);
  warn_lost_attributes(mesh.vertex_attributes, "vertices", colours ? &*colours : nullptr, false, "OBJ",
                       result.warnings);
  warn_lost_attributes(mesh.triangle_attributes, "triangles", nullptr, false, "OBJ", result.warnings);
  return [&mesh, comments = options.comments, colours, as_float](std::ostream& out) {
    TextBuffer buffer(out);
    append_comments(buffer.text(), "# ", comments);
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
      append_vertex(buffer.text(), mesh.vertices[i], colours, i, as_float);
      buffer.flush_if_full();
    }
    for (const auto& triangle : mesh.triangles) {
      buffer.text() += 'f';
      for (const std::uint32_t vertex : triangle) {
        buffer.text() += ' ';
        append_number(buffer.text(), std::int64_t{vertex} + 1);
      }
      buffer.text() += '\n';
      buffer.flush_if_full();
    }
  };
}

Body prepare_obj(const PointCloud& cloud, const WriteOptions& options, WriteResult& result) {
  const bool as_float = options.coordinates == CoordinateType::float32;
  result.coordinates = as_float ? CoordinateType::float32 : CoordinateType::float64;
  const std::vector<const Attribute*> normals = find_normals(cloud.attributes);
  const auto colours = find_colours(cloud.attributes);
  warn_lost_attributes(cloud.attributes, "points", colours ? &*colours : nullptr, false, "OBJ", result.warnings,
                       normals);
  return [&cloud, comments = options.comments, colours, normals, as_float](std::ostream& out) {
    TextBuffer buffer(out);
    append_comments(buffer.text(), "# ", comments);
    for (std::size_t i = 0; i < cloud.points.size(); ++i) {
      append_vertex(buffer.text(), cloud.points[i], colours, i, as_float);
      if (!normals.empty()) {
        buffer.text() += "vn ";
        const Vec3 n{attribute_value(*normals[0], i), attribute_value(*normals[1], i), attribute_value(*normals[2], i)};
        append_point(buffer.text(), n, ' ', true);
        buffer.text() += '\n';
      }
      buffer.flush_if_full();
    }
  };
}

} // namespace eigencrust::io
