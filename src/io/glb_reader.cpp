// SPDX-License-Identifier: GPL-3.0-or-later
// Reads the triangles of glTF 2.0 in one binary file. Not through tinygltf, which trusts the numbers of a file, unpacks
// its pictures and follows names in it: what is needed here is little, and every number of it is checked.
#include <bit>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>

#include "io/bytes.h"
#include "io/formats.h"
#include "io/frame.h"
#include "io/glb.h"
#include "io/polygons.h"
#include "io/pose.h"
#include "io/text.h"
#include "io/vertex_rows.h"

namespace eigencrust::io {
namespace {

using Json = nlohmann::json;

constexpr const char* remedy = "the file does not follow glTF 2.0; export it again with another program";

/// The two chunks of the file that count.
struct Chunks {
  std::string_view json, binary;
};

Chunks split(const FileContent& file) {
  constexpr std::uint32_t json_mark = 0x4e4f534a, binary_mark = 0x004e4942;
  constexpr std::size_t header_size = 12, chunk_header = 8;
  const std::string_view bytes = file.bytes();
  if (bytes.size() < header_size + chunk_header || !bytes.starts_with("glTF"))
    file.fail("this is no GLB file, or only its beginning", cut_off);
  if (const auto version = value_at<std::uint32_t>(bytes, 4); version != 2)
    file.fail_at_byte(4, "glTF of version " + std::to_string(version) + " is not read, it is named",
                      "export the model as glTF 2.0 (.glb)");
  if (value_at<std::uint32_t>(bytes, 8) > bytes.size())
    file.fail_at_byte(8, "the file is shorter than it says", cut_off);
  Chunks chunks;
  for (std::size_t at = header_size; bytes.size() - at >= chunk_header;) {
    const auto size = value_at<std::uint32_t>(bytes, at), mark = value_at<std::uint32_t>(bytes, at + 4);
    if (size > bytes.size() - at - chunk_header) file.fail_at_byte(at, "a chunk is longer than the file", cut_off);
    const std::string_view content = bytes.substr(at + chunk_header, size);
    if (mark == json_mark && chunks.json.empty()) chunks.json = content;
    if (mark == binary_mark && chunks.binary.empty()) chunks.binary = content;
    at += chunk_header + size;
  }
  if (chunks.json.empty()) file.fail("the file has no chunk of JSON", remedy);
  return chunks;
}

/// Numbers in the binary chunk, all of them within it.
struct Accessor {
  std::string_view bytes; ///< from the first element on
  std::uint64_t count = 0;
  std::size_t stride = 0, channels = 0;
  int component = 0;
  bool normalized = false;

  template <class T>
  [[nodiscard]] double number(std::size_t at) const {
    const auto value = static_cast<double>(value_at<T>(bytes, at));
    if constexpr (std::is_floating_point_v<T>) return value;
    return normalized ? std::max(-1.0, value / static_cast<double>(std::numeric_limits<T>::max())) : value;
  }
  static std::size_t size_of(int component) {
    return component == 5120 || component == 5121 ? 1 : component == 5122 || component == 5123 ? 2 : 4;
  }
  [[nodiscard]] double operator()(std::uint64_t row, std::size_t channel = 0) const {
    const std::size_t at = row * stride + channel * size_of(component);
    switch (component) {
      case 5120:
        return number<std::int8_t>(at);
      case 5121:
        return number<std::uint8_t>(at);
      case 5122:
        return number<std::int16_t>(at);
      case 5123:
        return number<std::uint16_t>(at);
      case 5125:
        return number<std::uint32_t>(at);
      default:
        return number<float>(at);
    }
  }
  [[nodiscard]] Vec3 vector(std::uint64_t row) const { return {(*this)(row, 0), (*this)(row, 1), (*this)(row, 2)}; }
};

class GlbReader {
 public:
  GlbReader(const FileContent& file, MeshNotes& notes)
      : file_(file), notes_(notes), chunks_(split(file)), budget_(file.bytes().size()) {
    json_ = Json::parse(chunks_.json.begin(), chunks_.json.end(), nullptr, false);
    if (!json_.is_object()) file_.fail("the chunk of JSON cannot be read", remedy);
    check_extensions();
  }

  TriangleMesh read() {
    visited_.resize(array(json_, "nodes").size());
    Frame z_up; // of a scene with y up
    z_up.rows = {{{1, 0, 0}, {0, 0, -1}, {0, 1, 0}}};
    std::vector<std::pair<std::uint64_t, Frame>> open;
    for (const std::uint64_t root : roots()) open.emplace_back(root, z_up);
    while (!open.empty()) {
      const auto [number, outer] = open.back();
      open.pop_back();
      const Json& node = element("nodes", number);
      if (visited_[number]) fail("node " + std::to_string(number) + " is below two others");
      visited_[number] = true;
      const Frame frame = outer * frame_of(node);
      if (!frame.finite()) fail("node " + std::to_string(number) + " has a frame that is not finite");
      if (node.contains("mesh")) add_mesh(element("meshes", natural(node, "mesh")), frame);
      const Json& children = array(node, "children");
      for (std::size_t i = children.size(); i-- > 0;) open.emplace_back(whole(children[i], "a child"), frame);
    }
    if (skipped_ > 0)
      notes_.notes.push_back(plural(skipped_, "primitive") + " of lines, strips or fans left out: triangles are read");
    notes_.metres = is_unknown_unit() ? 0 : 1;
    rows_.give(mesh_);
    check_vertex_count(mesh_, file_);
    return std::move(mesh_);
  }

 private:
  [[noreturn]] void fail(const std::string& cause) const { file_.fail(cause, remedy); }

  void check_extensions() const {
    for (const Json& name : array(json_, "extensionsRequired"))
      if (name.is_string())
        for (const char* packed : {"KHR_draco_mesh_compression", "EXT_meshopt_compression"})
          if (name.get_ref<const std::string&>() == packed)
            file_.fail(std::string("the mesh is compressed (") + packed + ")", "export it without compression");
  }

  [[nodiscard]] bool is_unknown_unit() const {
    const Json::json_pointer place(std::string("/asset/extras/") + unit_key);
    return json_.contains(place) && json_[place] == unknown_unit;
  }

  /// An array, which may be missing.
  const Json& array(const Json& object, const char* key) const {
    static const Json none = Json::array();
    if (!object.is_object()) fail(std::string("no object has ") + key);
    const auto found = object.find(key);
    if (found == object.end()) return none;
    if (!found->is_array()) fail(std::string(key) + " is no array");
    return *found;
  }
  const Json& element(const char* key, std::uint64_t i) const {
    const Json& all = array(json_, key);
    if (i >= all.size() || !all[i].is_object()) fail("element " + std::to_string(i) + " of " + key + " does not exist");
    return all[i];
  }
  std::uint64_t whole(const Json& value, const std::string& what) const {
    constexpr double most = 9007199254740992.0; // 2^53
    if (value.is_number_unsigned()) return value.get<std::uint64_t>();
    const double real = value.is_number_float() ? value.get<double>() : -1; // some print 5 as 5.0
    if (!(real >= 0 && real < most && real == std::floor(real))) fail(what + " is no whole number from 0 on");
    return static_cast<std::uint64_t>(real);
  }
  std::uint64_t natural(const Json& object, const char* key, std::optional<std::uint64_t> absent = {}) const {
    const auto found = object.find(key);
    if (found != object.end()) return whole(*found, key);
    if (!absent) fail(std::string(key) + " is missing");
    return *absent;
  }
  /// \return false where there are none of that name
  bool numbers(const Json& object, const char* key, std::span<double> values) const {
    const Json& all = array(object, key);
    if (all.empty()) return false;
    if (all.size() != values.size()) fail(std::string(key) + " has another number of numbers");
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (!all[i].is_number()) fail(std::string(key) + " has what is no number");
      values[i] = all[i].get<double>();
    }
    return true;
  }

  /// The nodes of the scene; without any scene those that are below no other.
  [[nodiscard]] std::vector<std::uint64_t> roots() const {
    std::vector<std::uint64_t> result;
    if (!array(json_, "scenes").empty()) {
      for (const Json& node : array(element("scenes", natural(json_, "scene", 0)), "nodes"))
        result.push_back(whole(node, "a node of the scene"));
      return result;
    }
    const Json& nodes = array(json_, "nodes");
    std::vector<bool> below(nodes.size());
    for (const Json& node : nodes)
      for (const Json& child : array(node, "children"))
        if (const std::uint64_t c = whole(child, "a child"); c < below.size()) below[c] = true;
    for (std::uint64_t n = 0; n < below.size(); ++n)
      if (!below[n]) result.push_back(n);
    return result;
  }

  [[nodiscard]] Frame frame_of(const Json& node) const {
    Frame frame;
    std::array<double, 16> m;
    if (numbers(node, "matrix", m)) { // column after column
      for (std::size_t i = 0; i < 3; ++i) frame.rows[i] = {m[i], m[4 + i], m[8 + i]};
      frame.place = {m[12], m[13], m[14]};
      return frame;
    }
    std::array<double, 4> turn{0, 0, 0, 1};
    std::array<double, 3> size{1, 1, 1}, place{};
    numbers(node, "translation", place);
    numbers(node, "rotation", turn);
    numbers(node, "scale", size);
    Pose pose;
    if (!set_rotation(pose, turn[3], turn[0], turn[1], turn[2])) fail("a node has a rotation of no length");
    for (std::size_t i = 0; i < 3; ++i)
      frame.rows[i] = {pose.rows[i].x * size[0], pose.rows[i].y * size[1], pose.rows[i].z * size[2]};
    frame.place = {place[0], place[1], place[2]};
    return frame;
  }

  [[nodiscard]] Accessor accessor(std::uint64_t number) const {
    const Json& json = element("accessors", number);
    Accessor result;
    const std::string what = "accessor " + std::to_string(number);
    if (json.contains("sparse") || !json.contains("bufferView")) fail(what + " is sparse, which is not read");
    const std::uint64_t component = natural(json, "componentType");
    if (component < 5120 || component > 5126 || component == 5124) fail(what + " has an unknown componentType");
    result.component = static_cast<int>(component);
    const auto type = json.find("type");
    if (type == json.end() || !type->is_string()) fail(what + " has no type");
    const auto& name = type->get_ref<const std::string&>();
    result.channels = name == "SCALAR" ? 1 : name == "VEC2" ? 2 : name == "VEC3" ? 3 : name == "VEC4" ? 4 : 0;
    if (result.channels == 0) fail(what + " has a type that is no vector");
    const auto normalized = json.find("normalized");
    result.normalized = normalized != json.end() && normalized->is_boolean() && normalized->get<bool>();
    const Json& view = element("bufferViews", natural(json, "bufferView"));
    if (natural(view, "buffer") != 0 || array(json_, "buffers").empty() || element("buffers", 0).contains("uri"))
      file_.fail("the mesh is in another file", "export it as one binary file (.glb)");
    const std::size_t size = result.channels * Accessor::size_of(result.component);
    const std::uint64_t begin = natural(view, "byteOffset", 0), length = natural(view, "byteLength"),
                        from = natural(json, "byteOffset", 0);
    result.count = natural(json, "count");
    result.stride = natural(view, "byteStride", size);
    if (begin > chunks_.binary.size() || length > chunks_.binary.size() - begin || from > length)
      fail(what + " reaches beyond the file");
    const std::uint64_t room = length - from;
    constexpr std::uint64_t widest = 252;
    if (result.stride < size || result.stride > widest) fail(what + " has a wrong stride");
    if (result.count > 0 && (room < size || result.count - 1 > (room - size) / result.stride))
      fail(what + " reaches beyond its view");
    result.bytes = chunks_.binary.substr(begin + from, room);
    return result;
  }

  [[nodiscard]] std::optional<Accessor> attribute(const Json& attributes, const char* name, std::uint64_t count) const {
    if (!attributes.contains(name)) return std::nullopt;
    const Accessor result = accessor(natural(attributes, name));
    if (result.channels < 3) fail(std::string(name) + " is no vector of three");
    if (result.count != count) fail(std::string(name) + " has not as many rows as there are positions");
    return result;
  }

  /// Scenes may show a mesh many times; one that asks for more than its file is large is none that anybody made.
  void take(std::uint64_t count) {
    if (count > budget_) file_.fail("the scene shows its meshes too many times", "export one of them");
    budget_ -= count;
  }

  void add_mesh(const Json& mesh, const Frame& frame) {
    for (const Json& primitive : array(mesh, "primitives")) {
      if (!primitive.is_object()) fail("a primitive is no object");
      const std::uint64_t mode = natural(primitive, "mode", triangles);
      if (mode == triangles || mode == points)
        add_primitive(primitive, frame, mode);
      else
        ++skipped_;
    }
  }

  void add_primitive(const Json& primitive, const Frame& frame, std::uint64_t mode) {
    const auto attributes = primitive.find("attributes");
    if (attributes == primitive.end() || !attributes->is_object()) fail("a primitive has no attributes");
    const Accessor positions = accessor(natural(*attributes, "POSITION"));
    if (positions.channels != 3) fail("positions are no vectors of three");
    const std::uint64_t count = positions.count;
    take(count);
    const auto normals = attribute(*attributes, "NORMAL", count), colours = attribute(*attributes, "COLOR_0", count);
    const std::size_t first = mesh_.vertices.size();
    for (std::uint64_t i = 0; i < count; ++i) {
      mesh_.vertices.push_back(frame(positions.vector(i)));
      if (normals) rows_.set_normal(first + i, frame.turned_normal(normals->vector(i)));
      if (colours) add_colour(first + i, *colours, i);
    }
    if (mode == triangles) add_triangles(primitive, first, count, frame.determinant() < 0);
  }

  void add_colour(std::size_t row, const Accessor& colours, std::uint64_t i) {
    std::array<std::uint8_t, 4> bytes{0, 0, 0, 255};
    const auto byte = [](double share) { return static_cast<std::uint8_t>(std::lround(255 * share)); };
    for (std::size_t k = 0; k < colours.channels; ++k) {
      const double value = colours(i, k), share = std::isnan(value) ? 1 : std::clamp(value, 0.0, 1.0);
      bytes[k] = byte(k < 3 ? srgb_of(share) : share);
    }
    rows_.set_colour(row, bytes, colours.channels == 4);
  }

  void add_triangles(const Json& primitive, std::size_t first, std::uint64_t vertices, bool mirrored) {
    std::optional<Accessor> indices;
    if (primitive.contains("indices")) indices = accessor(natural(primitive, "indices"));
    if (indices && (indices->channels != 1 || indices->component == 5126)) fail("indices are no whole numbers");
    const std::uint64_t corners = indices ? indices->count : vertices;
    take(corners / 3);
    if (first + vertices >= no_index) check_vertex_count(mesh_, file_);
    for (std::uint64_t c = 0; c + 3 <= corners; c += 3) {
      std::array<std::uint32_t, 3> triangle{};
      for (std::size_t k = 0; k < 3; ++k) {
        const double index = indices ? (*indices)(c + k) : static_cast<double>(c + k);
        if (!(index >= 0 && index < static_cast<double>(vertices)))
          fail("triangle " + std::to_string(c / 3) + " names a vertex that does not exist");
        triangle[k] = static_cast<std::uint32_t>(first + static_cast<std::uint64_t>(index));
      }
      if (mirrored) std::swap(triangle[1], triangle[2]);
      mesh_.triangles.push_back(triangle);
    }
  }

  static constexpr std::uint64_t points = 0, triangles = 4; ///< modes of primitives

  const FileContent& file_;
  MeshNotes& notes_;
  Chunks chunks_;
  std::uint64_t budget_; ///< vertices and triangles that are still allowed
  Json json_;
  std::vector<bool> visited_;
  std::uint64_t skipped_ = 0;
  TriangleMesh mesh_;
  VertexRows rows_;
};

} // namespace

TriangleMesh read_glb(const FileContent& file, MeshNotes& notes) { return GlbReader(file, notes).read(); }

} // namespace eigencrust::io
