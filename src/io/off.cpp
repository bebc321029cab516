// SPDX-License-Identifier: GPL-3.0-or-later
// Geomview's OFF format: [ST][C][N]OFF, the counts, the vertices one per line, the faces one per line.
#include <algorithm>

#include "io/attributes.h"
#include "io/colours.h"
#include "io/formats.h"
#include "io/polygons.h"
#include "io/text_output.h"

namespace eigencrust::io {
namespace {

constexpr const char* wrong_counts = "correct the counts, or fetch the file again if it is cut off";

class OffReader {
 public:
  explicit OffReader(const FileContent& file) : file_(file), lines_(file) {}

  TriangleMesh read() {
    if (!lines_.next_filled('#')) file_.fail("the file is empty", "use an OFF file that holds points");
    std::string_view rest = read_keyword(lines_.line());
    if (trim(rest).empty() && !lines_.next_filled('#')) fail_end("before the counts");
    if (trim(rest).empty()) rest = lines_.line();
    read_counts(rest);
    for (std::uint64_t i = 0; i < vertex_count_; ++i) {
      if (!lines_.next_filled('#'))
        fail_end("after " + plural(i, "vertex row") + " of " + std::to_string(vertex_count_));
      read_vertex();
    }
    check_vertex_count(mesh_, file_);
    for (std::uint64_t i = 0; i < face_count_; ++i) {
      if (!lines_.next_filled('#')) fail_end("after " + plural(i, "face row") + " of " + std::to_string(face_count_));
      read_face();
    }
    if (lines_.next_filled('#')) lines_.fail("more rows than the counts say", "correct the counts");
    add_attributes();
    return std::move(mesh_);
  }

 private:
  [[noreturn]] void fail_end(const std::string& where) const {
    lines_.fail("the OFF file ends " + where, wrong_counts);
  }

  /// Reads the letters before "OFF"; what follows on the line, perhaps without a blank, are the counts.
  std::string_view read_keyword(std::string_view line) {
    std::string_view prefix = line.substr(0, std::min(line.find("OFF"), line.size()));
    // The keyword may be missing altogether.
    if (prefix.size() == line.size() && is_digit(line[0])) return line;
    const std::string_view rest = line.substr(std::min(prefix.size() + 3, line.size()));
    const auto take = [&](std::string_view letters) {
      const bool there = prefix.starts_with(letters);
      if (there) prefix.remove_prefix(letters.size());
      return there;
    };
    has_texture_ = take("ST");
    take("C"); // colours are recognized by the number of values
    has_normals_ = take("N");
    if (!prefix.empty())
      lines_.fail("this is no OFF file of points in space: it begins with " + shown(line),
                  "use OFF, COFF, NOFF, CNOFF or STOFF");
    if (trim(rest).starts_with("BINARY"))
      lines_.fail("binary OFF files are not read", "save the file as text, or as PLY");
    return rest;
  }

  void read_counts(std::string_view text) {
    split_words(text, fields_);
    if (fields_.size() < 2 || fields_.size() > 3 || !parse(fields_[0], vertex_count_) ||
        !parse(fields_[1], face_count_))
      lines_.fail("the counts of vertices and faces are expected, not " + shown(trim(text)), "repair the header");
    // The shortest rows are "0 0 0" and "0"; the last line end may be missing.
    const std::uint64_t left = lines_.remaining() + 1;
    if (vertex_count_ > left / 6 || face_count_ > left / 2)
      lines_.fail("the file is too short to hold " + plural(vertex_count_, "vertex row") + " and " +
                      plural(face_count_, "face row"),
                  wrong_counts);
  }

  void read_vertex() {
    split_words(lines_.line(), fields_);
    if (mesh_.vertices.empty()) find_layout();
    if (fields_.size() != row_length_)
      lines_.fail(
          "a vertex has " + plural(fields_.size(), "value") + " where " + std::to_string(row_length_) + " are expected",
          "give all vertices the same values");
    values_.resize(row_length_);
    for (std::size_t k = 0; k < row_length_; ++k)
      if (!parse(fields_[k], values_[k])) lines_.fail(shown(fields_[k]) + " is no number", "correct the vertex");
    mesh_.vertices.push_back({values_[0], values_[1], values_[2]});
    std::size_t k = 3;
    for (std::size_t c = 0; c < normals_.size(); ++c)
      if (has_normals_) normals_[c].push_back(values_[k++]);
    for (std::size_t c = 0; c < channels_; ++c) {
      whole_colours_ = whole_colours_ && fields_[k].find_first_of(".eE") == std::string_view::npos;
      colours_.push_back(values_[k++]);
    }
    for (std::size_t c = 0; c < texture_.size(); ++c)
      if (has_texture_) texture_[c].push_back(values_[k++]);
  }

  /// x y z [normal] [colour of 3 or 4 values] [texture coordinates], in this order.
  void find_layout() {
    row_length_ = fields_.size();
    const std::size_t others = 3 + (has_normals_ ? 3u : 0u) + (has_texture_ ? 2u : 0u);
    channels_ = row_length_ >= others ? row_length_ - others : 1;
    if (channels_ != 0 && channels_ != 3 && channels_ != 4)
      lines_.fail("a vertex has " + plural(row_length_, "value"),
                  "write x y z, then what the first line announces: normal, colour, texture coordinates");
  }

  void read_face() {
    std::string_view rest = lines_.line();
    std::uint64_t corners = 0;
    std::string_view word = next_word(rest);
    if (!parse(word, corners))
      lines_.fail("a face begins with the number of its vertices, not " + shown(word), "repair the face");
    corners_.clear();
    for (std::uint64_t k = 0; k < corners; ++k) {
      word = next_word(rest);
      std::uint64_t index = 0;
      if (word.empty())
        lines_.fail("the face ends before the last of its " + plural(corners, "vertex number"), wrong_counts);
      if (!parse(word, index) || index >= mesh_.vertices.size())
        lines_.fail("a face names vertex " + shown(word) + " of " + std::to_string(mesh_.vertices.size()),
                    "repair the mesh: vertices are counted from 0");
      corners_.push_back(static_cast<std::uint32_t>(index));
    }
    add_polygon(mesh_, corners_);
  }

  void add_attributes() {
    if (mesh_.vertices.empty()) return;
    auto& attributes = mesh_.vertex_attributes;
    const auto add = [&](const char* name, const std::vector<double>& values) {
      attributes.push_back(make_attribute(name, ScalarType::float64, values));
    };
    if (has_normals_) {
      add("nx", normals_[0]);
      add("ny", normals_[1]);
      add("nz", normals_[2]);
    }
    if (channels_ > 0)
      for (Attribute& channel : colour_attributes(colours_, channels_, whole_colours_))
        attributes.push_back(std::move(channel));
    if (has_texture_) {
      add("s", texture_[0]);
      add("t", texture_[1]);
    }
  }

  const FileContent& file_;
  LineScanner lines_;
  TriangleMesh mesh_;
  Fields fields_;
  std::vector<double> values_, colours_;
  std::array<std::vector<double>, 3> normals_;
  std::array<std::vector<double>, 2> texture_;
  std::vector<std::uint32_t> corners_;
  std::uint64_t vertex_count_ = 0, face_count_ = 0;
  std::size_t row_length_ = 3, channels_ = 0;
  bool has_normals_ = false, has_texture_ = false;
  bool whole_colours_ = true; ///< written as integers, so that 255 is the brightest
};

/// Whole numbers mean 0..255 in this format, so that a fraction must show its point.
void append_fraction(std::string& out, double value) {
  const std::size_t begin = out.size();
  append_number(out, static_cast<float>(value));
  if (out.find_first_of(".en", begin) == std::string::npos) out += ".0";
}

void append_colour(std::string& out, const ViewerColours& colours, std::size_t row) {
  for (std::size_t k = 0; k < 4; ++k) {
    out += ' ';
    const bool is_there = k < 3 || colours.has_alpha();
    if (colours.exact)
      append_number(out, std::int64_t{is_there ? colours.rgba[k][row] : std::uint8_t{255}});
    else
      append_fraction(out, is_there ? colours.fraction(k, row) : 1.0);
  }
}

} // namespace

TriangleMesh read_off(const FileContent& file) { return OffReader(file).read(); }

Body prepare_off(const TriangleMesh& mesh, const WriteOptions& options, WriteResult& result) {
  const bool as_float = options.coordinates == CoordinateType::float32;
  result.coordinates = as_float ? CoordinateType::float32 : CoordinateType::float64;
  const auto colours = find_colours(mesh.vertex_attributes);
  warn_lost_attributes(mesh.vertex_attributes, "vertices", colours ? &*colours : nullptr, true, "OFF", result.warnings);
  warn_lost_attributes(mesh.triangle_attributes, "triangles", nullptr, false, "OFF", result.warnings);
  return [&mesh, comments = options.comments, colours, as_float](std::ostream& out) {
    TextBuffer buffer(out);
    std::string& text = buffer.text();
    text += colours ? "COFF\n" : "OFF\n";
    append_comments(text, "# ", comments);
    append_number(text, static_cast<std::int64_t>(mesh.vertices.size()));
    text += ' ';
    append_number(text, static_cast<std::int64_t>(mesh.triangles.size()));
    text += " 0\n";
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
      append_point(text, mesh.vertices[i], ' ', as_float);
      if (colours) append_colour(text, *colours, i);
      text += '\n';
      buffer.flush_if_full();
    }
    for (const auto& triangle : mesh.triangles) {
      text += '3';
      for (const std::uint32_t vertex : triangle) {
        text += ' ';
        append_number(text, std::int64_t{vertex});
      }
      text += '\n';
      buffer.flush_if_full();
    }
  };
}

} // namespace eigencrust::io
