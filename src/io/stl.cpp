// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <bit>
#include <unordered_map>

#include <eigencrust/error.h>

#include "io/attributes.h"
#include "io/binary_output.h"
#include "io/formats.h"
#include "io/offset_file.h"
#include "io/polygons.h"
#include "io/precision.h"
#include "io/text.h"

namespace eigencrust::io {
namespace {

constexpr std::size_t header_size = 84, facet_size = 50;

/// Numbers the distinct positions in order of appearance.
class VertexMerger {
 public:
  explicit VertexMerger(TriangleMesh& mesh) : mesh_(mesh) {}

  std::uint32_t operator()(const Vec3& p) {
    const auto [entry, is_new] = index_.try_emplace(key(p), static_cast<std::uint32_t>(mesh_.vertices.size()));
    if (is_new) mesh_.vertices.push_back(p);
    return entry->second;
  }

 private:
  using Key = std::array<std::uint64_t, 3>;
  struct Hash {
    std::size_t operator()(const Key& k) const {
      std::uint64_t h = 0;
      // Multiplicative mixing with an odd constant of evenly spread bits (2^64 / golden ratio).
      for (const std::uint64_t part : k) h = (std::rotl(h, 23) ^ part ^ (part >> 32)) * 0x9E3779B97F4A7C15u;
      return static_cast<std::size_t>(h ^ (h >> 29));
    }
  };
  static Key key(const Vec3& p) {
    const auto bits = [](double v) { return v == 0 ? 0u : std::bit_cast<std::uint64_t>(v); };
    return {bits(p.x), bits(p.y), bits(p.z)};
  }

  TriangleMesh& mesh_;
  std::unordered_map<Key, std::uint32_t, Hash> index_;
};

float read_float(const char* bytes) {
  std::array<char, 4> value{};
  std::copy_n(bytes, 4, value.begin());
  if constexpr (std::endian::native == std::endian::big) std::reverse(value.begin(), value.end());
  return std::bit_cast<float>(value);
}

std::uint32_t read_count(const char* bytes) { return std::bit_cast<std::uint32_t>(read_float(bytes)); }

TriangleMesh read_binary(const FileContent& file) {
  const std::string_view bytes = file.bytes();
  if (bytes.size() < header_size)
    file.fail_at_byte(bytes.size(), "the binary STL file ends within its header", cut_off);
  const std::uint64_t count = read_count(bytes.data() + 80);
  if (count > (bytes.size() - header_size) / facet_size)
    file.fail_at_byte(bytes.size(), "the file ends before the last of its " + plural(count, "facet"), cut_off);
  TriangleMesh mesh;
  mesh.triangles.reserve(count);
  VertexMerger merge(mesh);
  for (std::uint64_t i = 0; i < count; ++i) {
    const char* facet = bytes.data() + header_size + i * facet_size;
    std::array<std::uint32_t, 3> corners{};
    for (std::size_t k = 0; k < 3; ++k) {
      const char* corner = facet + 12 * (k + 1); // the first three floats are the normal
      corners[k] = merge({double{read_float(corner)}, double{read_float(corner + 4)}, double{read_float(corner + 8)}});
    }
    mesh.triangles.push_back(corners);
  }
  return mesh;
}

/// solid NAME, then facets of an outer loop of vertices each, then endsolid; any case, any blanks.
class AsciiReader {
 public:
  explicit AsciiReader(const FileContent& file) : lines_(file) {}

  TriangleMesh read() {
    VertexMerger merge(mesh_);
    while (lines_.next_filled()) {
      std::string_view rest = lines_.line();
      const std::string word = lower_case(next_word(rest));
      if (word == "solid" && state_ == State::outside)
        state_ = State::solid;
      else if (word == "facet" && state_ == State::solid)
        state_ = State::facet;
      else if (word == "outer" && state_ == State::facet)
        state_ = State::loop;
      else if (word == "vertex" && state_ == State::loop)
        corners_.push_back(merge(read_vertex(rest)));
      else if (word == "endloop" && state_ == State::loop)
        end_loop();
      else if (word == "endfacet" && state_ == State::facet)
        state_ = State::solid;
      else if (word == "endsolid" && state_ == State::solid)
        state_ = State::outside;
      else
        lines_.fail(shown(word) + " is not expected " + place(), "repair the STL file");
    }
    if (state_ != State::outside) lines_.fail("the STL file ends " + std::string(place()), cut_off);
    return std::move(mesh_);
  }

 private:
  enum class State { outside, solid, facet, loop };

  [[nodiscard]] const char* place() const {
    switch (state_) {
      case State::outside:
        return "outside a solid";
      case State::solid:
        return "within a solid";
      case State::facet:
        return "within a facet";
      case State::loop:
        break;
    }
    return "within a loop";
  }

  Vec3 read_vertex(std::string_view rest) {
    split_words(rest, fields_);
    Vec3 p;
    if (fields_.size() != 3 || !parse(fields_[0], p.x) || !parse(fields_[1], p.y) || !parse(fields_[2], p.z))
      lines_.fail("malformed vertex " + shown(lines_.line()), "write: vertex X Y Z");
    return p;
  }

  void end_loop() {
    if (corners_.size() < 3) lines_.fail("a facet has " + plural(corners_.size(), "corner"), "repair the facet");
    add_polygon(mesh_, corners_);
    corners_.clear();
    state_ = State::facet;
  }

  LineScanner lines_;
  TriangleMesh mesh_;
  State state_ = State::outside;
  std::vector<std::uint32_t> corners_;
  Fields fields_;
};

/// A binary file may begin with "solid" too: its size decides, then its zero bytes.
bool is_binary(std::string_view bytes) {
  if (bytes.size() >= header_size) {
    const std::uint64_t count = read_count(bytes.data() + 80);
    if (bytes.size() == header_size + count * facet_size) return true;
  }
  const std::size_t begin = std::min(bytes.find_first_not_of(" \t\r\n"), bytes.size());
  if (!equal_ignoring_case(bytes.substr(begin, 5), "solid")) return true;
  return bytes.substr(0, 512).find('\0') != std::string_view::npos;
}

Vec3 unit_normal(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 n = cross(b - a, c - a);
  const double length = norm(n);
  return length > 0 && std::isfinite(length) ? (1 / length) * n : Vec3{};
}

/// What is subtracted is told.
void choose_offset(const TriangleMesh& mesh, const WriteOptions& options, WriteResult& result) {
  std::vector<std::string> more;
  result.offset = offset_for_float(mesh, options.spacing, "STL", more);
  if (result.offset != Vec3{})
    result.warnings.push_back(
        "STL holds 32-bit coordinates only: this was subtracted from them (see the file .offset.txt beside it): " +
        three_numbers(result.offset));
  result.warnings.insert(result.warnings.end(), more.begin(), more.end());
}

void warn_lost(const TriangleMesh& mesh, WriteResult& result) {
  warn_lost_attributes(mesh.vertex_attributes, "vertices", nullptr, false, "STL", result.warnings);
  warn_lost_attributes(mesh.triangle_attributes, "triangles", nullptr, false, "STL", result.warnings);
  std::vector<bool> used(mesh.vertices.size());
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t vertex : triangle) used[vertex] = true;
  const auto unused = std::count(used.begin(), used.end(), false);
  if (unused > 0)
    result.warnings.push_back("STL has no room for vertices without a triangle: " + std::to_string(unused) + " lost");
}

void append_vector(BinaryBuffer& buffer, const Vec3& v) {
  buffer.append(static_cast<float>(v.x));
  buffer.append(static_cast<float>(v.y));
  buffer.append(static_cast<float>(v.z));
}

} // namespace

TriangleMesh read_stl(const FileContent& file) {
  if (file.bytes().empty()) file.fail("the file is empty", "use an STL file that holds triangles");
  TriangleMesh mesh = is_binary(file.bytes()) ? read_binary(file) : AsciiReader(file).read();
  check_vertex_count(mesh, file);
  return mesh;
}

Body prepare_stl(const TriangleMesh& mesh, const WriteOptions& options, WriteResult& result) {
  if (mesh.triangles.size() > std::numeric_limits<std::uint32_t>::max())
    throw Error(ErrorKind::input, "STL", "STL has no room for more than 4294967295 triangles", "write PLY");
  result.coordinates = CoordinateType::float32;
  if (options.coordinates == CoordinateType::float64) result.warnings.push_back("STL holds 32-bit coordinates only");
  warn_lost(mesh, result);
  choose_offset(mesh, options, result);
  std::string header = "binary STL"; // must not begin with "solid", which marks text
  for (const std::string& comment : options.comments) header += "; " + comment;
  header.resize(80, ' ');
  return [&mesh, header, offset = result.offset](std::ostream& out) {
    BinaryBuffer buffer(out);
    buffer.append_values(reinterpret_cast<const std::byte*>(header.data()), header.size(), 1);
    buffer.append(static_cast<std::uint32_t>(mesh.triangles.size()));
    for (const auto& triangle : mesh.triangles) {
      std::array<Vec3, 3> corners;
      for (std::size_t k = 0; k < 3; ++k) corners[k] = mesh.vertices[triangle[k]] - offset;
      append_vector(buffer, unit_normal(corners[0], corners[1], corners[2]));
      for (const Vec3& corner : corners) append_vector(buffer, corner);
      buffer.append(std::uint16_t{0});
    }
  };
}

} // namespace eigencrust::io
