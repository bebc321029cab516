// SPDX-License-Identifier: GPL-3.0-or-later
// Writes glTF 2.0 in one binary file (Khronos, "glTF 2.0 Specification", 2021) through tinygltf.
#include <tiny_gltf.h>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include <eigencrust/error.h>

#include "io/attributes.h"
#include "io/colours.h"
#include "io/formats.h"
#include "io/glb.h"
#include "io/precision.h"
#include "io/text.h"

namespace eigencrust::io {
namespace {

/// What a vertex takes: position and normal of 32 bits, a colour of 16 bits, filled up to whole words.
constexpr std::size_t vector_size = 12, colour_size = 8, triangle_size = 12;

using Value = tinygltf::Value;

/// Unit length; triangles count by their areas.
std::vector<Vec3> vertex_normals(const TriangleMesh& mesh) {
  std::vector<Vec3> normals(mesh.vertices.size());
  for (const auto& t : mesh.triangles) {
    const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const Vec3 n = cross(b - a, c - a);
    for (const std::uint32_t v : t) normals[v] = normals[v] + n;
  }
  for (Vec3& n : normals) {
    const double length = norm(n);
    n = length > 0 && std::isfinite(length) ? (1 / length) * n : Vec3{0, 0, 1}; // the format wants unit length
  }
  return normals;
}

/// The one buffer of the file, a view and an accessor for each part.
class Parts {
 public:
  Parts(tinygltf::Model& model, std::size_t size) : model_(model) {
    model_.buffers.emplace_back();
    model_.buffers[0].data.reserve(size);
  }

  /// \return the accessor of `count` elements that follow. \param stride 0: they follow one another closely
  int begin(std::size_t count, std::size_t size, int target, int component, int type, std::size_t stride = 0) {
    tinygltf::BufferView view;
    view.buffer = 0;
    view.byteOffset = model_.buffers[0].data.size();
    view.byteLength = count * size;
    view.byteStride = stride;
    view.target = target;
    tinygltf::Accessor accessor;
    accessor.bufferView = static_cast<int>(model_.bufferViews.size());
    accessor.componentType = component;
    accessor.type = type;
    accessor.count = count;
    model_.bufferViews.push_back(std::move(view));
    model_.accessors.push_back(std::move(accessor));
    return static_cast<int>(model_.accessors.size() - 1);
  }

  template <class T>
  void append(T value) {
    const auto bytes = std::bit_cast<std::array<unsigned char, sizeof(T)>>(value);
    auto& data = model_.buffers[0].data;
    data.insert(data.end(), bytes.begin(), bytes.end());
  }
  void append(const Vec3& v) {
    for (const double x : {v.x, v.y, v.z}) append(static_cast<float>(x));
  }

 private:
  tinygltf::Model& model_;
};

constexpr int vertices_target = TINYGLTF_TARGET_ARRAY_BUFFER, indices_target = TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER;

int add_positions(const TriangleMesh& mesh, const Vec3& offset, tinygltf::Model& model, Parts& parts) {
  const int accessor = parts.begin(mesh.vertices.size(), vector_size, vertices_target, TINYGLTF_COMPONENT_TYPE_FLOAT,
                                   TINYGLTF_TYPE_VEC3);
  Box3 box;
  for (const Vec3& p : mesh.vertices) {
    const Vec3 q = p - offset;
    parts.append(q);
    box.add({double{static_cast<float>(q.x)}, double{static_cast<float>(q.y)}, double{static_cast<float>(q.z)}});
  }
  model.accessors[static_cast<std::size_t>(accessor)].minValues = {box.min.x, box.min.y, box.min.z};
  model.accessors[static_cast<std::size_t>(accessor)].maxValues = {box.max.x, box.max.y, box.max.z};
  return accessor;
}

/// 16 bits, as colours are in linear light there: 8 bits would make the dark ones equal.
int add_colours(const ViewerColours& colours, std::size_t rows, tinygltf::Model& model, Parts& parts) {
  const bool alpha = colours.has_alpha();
  const int accessor = parts.begin(rows, colour_size, vertices_target, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT,
                                   alpha ? TINYGLTF_TYPE_VEC4 : TINYGLTF_TYPE_VEC3, colour_size);
  model.accessors[static_cast<std::size_t>(accessor)].normalized = true;
  const auto word = [](double share) { return static_cast<std::uint16_t>(std::lround(65535 * share)); };
  for (std::size_t i = 0; i < rows; ++i) {
    for (std::size_t k = 0; k < 3; ++k) parts.append(word(linear_light(colours.rgba[k][i] / 255.0)));
    parts.append(alpha ? word(colours.rgba[3][i] / 255.0) : std::uint16_t{0});
  }
  return accessor;
}

int add_triangles(const TriangleMesh& mesh, Parts& parts) {
  const int accessor = parts.begin(3 * mesh.triangles.size(), sizeof(std::uint32_t), indices_target,
                                   TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, TINYGLTF_TYPE_SCALAR);
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t vertex : triangle) parts.append(vertex);
  return accessor;
}

tinygltf::Asset make_asset(const WriteOptions& options) {
  tinygltf::Asset asset;
  asset.version = "2.0";
  asset.generator = "eigencrust";
  Value::Object extras;
  extras[unit_key] = Value(std::string(options.metres > 0 ? "metre" : unknown_unit));
  if (options.shift != Vec3{})
    extras["shift"] = Value(Value::Array{Value(options.shift.x), Value(options.shift.y), Value(options.shift.z)});
  Value::Array comments;
  for (const std::string& comment : options.comments) comments.push_back(Value(plain(comment)));
  if (!comments.empty()) extras["comments"] = Value(std::move(comments));
  asset.extras = Value(std::move(extras));
  return asset;
}

tinygltf::Material make_material(bool coloured) {
  constexpr double grey = 0.8; // of a plain surface; colours are multiplied with 1
  tinygltf::Material material;
  const double share = coloured ? 1 : grey;
  material.pbrMetallicRoughness.baseColorFactor = {share, share, share, 1};
  material.pbrMetallicRoughness.metallicFactor = 0;
  material.pbrMetallicRoughness.roughnessFactor = 0.9;
  material.doubleSided = true; // also where a mesh is open
  return material;
}

/// The mesh's node with the translation, below one that turns z up to the y up of the format and makes metres. A matrix
/// of whole numbers, not a rotation, so that nothing is rounded.
void add_nodes(const WriteOptions& options, const Vec3& offset, tinygltf::Model& model) {
  const double metres = options.metres > 0 ? options.metres : 1;
  tinygltf::Node upright, node;
  upright.name = "z up";
  upright.matrix = {metres, 0, 0, 0, 0, 0, -metres, 0, 0, metres, 0, 0, 0, 0, 0, 1};
  upright.children = {1};
  node.name = "mesh";
  if (!model.meshes.empty()) node.mesh = 0;
  if (offset != Vec3{}) node.translation = {offset.x, offset.y, offset.z};
  model.nodes = {upright, node};
  tinygltf::Scene scene;
  scene.nodes = {0};
  model.scenes = {scene};
  model.defaultScene = 0;
}

tinygltf::Model make_model(const TriangleMesh& mesh, const WriteOptions& options, const Vec3& offset,
                           const ViewerColours* colours) {
  tinygltf::Model model;
  model.asset = make_asset(options);
  if (!mesh.triangles.empty()) {
    Parts parts(model, mesh.vertices.size() * (2 * vector_size + colour_size) + mesh.triangles.size() * triangle_size);
    tinygltf::Primitive primitive;
    primitive.mode = TINYGLTF_MODE_TRIANGLES;
    primitive.material = 0;
    primitive.attributes["POSITION"] = add_positions(mesh, offset, model, parts);
    primitive.attributes["NORMAL"] = parts.begin(mesh.vertices.size(), vector_size, vertices_target,
                                                 TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3);
    for (const Vec3& n : vertex_normals(mesh)) parts.append(n);
    if (colours != nullptr) primitive.attributes["COLOR_0"] = add_colours(*colours, mesh.vertices.size(), model, parts);
    primitive.indices = add_triangles(mesh, parts);
    model.materials = {make_material(colours != nullptr)};
    model.meshes.emplace_back();
    model.meshes[0].primitives = {std::move(primitive)};
  }
  add_nodes(options, offset, model);
  return model;
}

void check_size(const TriangleMesh& mesh) {
  constexpr std::uint64_t most = std::numeric_limits<std::uint32_t>::max() - (1u << 20); // less what describes the rest
  const std::uint64_t size = std::uint64_t{mesh.vertices.size()} * (2 * vector_size + colour_size) +
                             std::uint64_t{mesh.triangles.size()} * triangle_size;
  if (size > most) throw Error(ErrorKind::input, "GLB", "a GLB file has no room for more than 4 GB", "write PLY");
}

} // namespace

Body prepare_glb(const TriangleMesh& mesh, const WriteOptions& options, WriteResult& result) {
  check_size(mesh);
  require_finite(mesh, "GLB");
  result.coordinates = CoordinateType::float32;
  auto colours = find_colours(mesh.vertex_attributes);
  warn_lost_attributes(mesh.vertex_attributes, "vertices", colours ? &*colours : nullptr, true, "GLB", result.warnings);
  warn_lost_attributes(mesh.triangle_attributes, "triangles", nullptr, false, "GLB", result.warnings);
  if (mesh.triangles.empty() && !mesh.vertices.empty())
    result.warnings.emplace_back("GLB has no room for vertices without any triangle: all are lost");
  const Vec3 offset = offset_for_float(mesh, options.spacing, "GLB", result.warnings);
  return [&mesh, options, offset, colours](std::ostream& out) {
    const tinygltf::Model model = make_model(mesh, options, offset, colours ? &*colours : nullptr);
    if (!tinygltf::TinyGLTF().WriteGltfSceneToStream(&model, out, false, true))
      throw Error(ErrorKind::input, "GLB", "tinygltf cannot write the mesh", "write PLY");
  };
}

} // namespace eigencrust::io
