// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tiny_gltf.h>

#include <cmath>

#include <eigencrust/io.h>
#include <eigencrust/validate.h>

#include "scene_bytes.h"
#include "shapes.h"
#include "support.h"

namespace eigencrust {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// A ball whose vertices have all 256 values of each channel.
TriangleMesh coloured_ball(const Vec3& centre) {
  TriangleMesh mesh = shapes::icosphere(3, 2, centre);
  std::vector<double> values(mesh.vertices.size());
  for (const auto& [name, step] : {std::pair{"red", 1}, {"green", 3}, {"blue", 7}}) {
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<double>(i * step % 256);
    mesh.vertex_attributes.push_back(make_attribute(name, ScalarType::uint8, values));
  }
  return mesh;
}

const Attribute& attribute(const TriangleMesh& mesh, const char* name) {
  const Attribute* found = find_attribute(mesh.vertex_attributes, name);
  if (found == nullptr) throw std::runtime_error(std::string("no ") + name);
  return *found;
}

class IoGlb : public ::testing::Test {
 protected:
  TriangleMesh read(const std::string& bytes) {
    write_bytes(folder_ / "a.glb", bytes);
    return read_mesh(folder_ / "a.glb", &notes_);
  }
  void expect_error(const std::string& bytes, const std::string& part) {
    try {
      read(bytes);
      ADD_FAILURE() << "read: " << part;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input);
      EXPECT_THAT(error.what(), HasSubstr(part));
    }
  }
  TempDir folder_;
  MeshNotes notes_;
};

TEST_F(IoGlb, ComesBackAsItWas) {
  const TriangleMesh mesh = coloured_ball({});
  WriteOptions options;
  options.metres = 1;
  EXPECT_THAT(write_mesh(folder_ / "a.glb", mesh, options).warnings, IsEmpty());
  const TriangleMesh back = read(read_bytes(folder_ / "a.glb"));
  EXPECT_EQ(back.triangles, mesh.triangles);
  EXPECT_EQ(notes_.metres, 1);
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const Vec3& p = mesh.vertices[v];
    EXPECT_LT(distance(back.vertices[v], p), 2.1e-7); // half a step of 32 bits at 2, in three directions
    const Vec3 n{attribute_value(attribute(back, "nx"), v), attribute_value(attribute(back, "ny"), v),
                 attribute_value(attribute(back, "nz"), v)};
    EXPECT_NEAR(norm(n), 1, 1e-6);
    EXPECT_GT(dot(n, p), 1.98); // of a ball of radius 2, z up as it was
  }
  for (const char* name : {"red", "green", "blue"})
    EXPECT_EQ(attribute(back, name).values, attribute(mesh, name).values) << name;
  EXPECT_EQ(find_attribute(back.vertex_attributes, "alpha"), nullptr);
}

TEST_F(IoGlb, FarFromTheOriginANodeTranslates) {
  const TriangleMesh mesh = coloured_ball({512000.125, 5412000.5, 300});
  const WriteResult result = write_mesh(folder_ / "a.glb", mesh);
  EXPECT_THAT(result.warnings, IsEmpty());
  EXPECT_EQ(result.offset, Vec3{});
  EXPECT_FALSE(std::filesystem::exists(folder_ / "a.glb.offset.txt"));
  const TriangleMesh back = read(read_bytes(folder_ / "a.glb"));
  EXPECT_EQ(notes_.metres, 0); // the numbers are of no known unit
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    EXPECT_LT(distance(back.vertices[v], mesh.vertices[v]), 3e-7); // half a step of 32 bits at 2, three times
  // A translation leaves 32 bits for the mesh itself only: points of 1e-9 beside others of 1e9 become one.
  TriangleMesh wide = shapes::tetrahedron();
  wide.vertices.push_back({1e9 + 1, 0, 0});
  wide.vertices.push_back({0, 1e-9, 0});
  try {
    write_mesh(folder_ / "b.glb", wide);
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::guarantee);
  }
  EXPECT_FALSE(std::filesystem::exists(folder_ / "b.glb"));
}

TEST_F(IoGlb, TheLibraryReadsWhatViewersNeed) {
  const TriangleMesh mesh = coloured_ball({0, 0, 10});
  WriteOptions options;
  options.metres = 1;
  options.shift = {-512000, 0, 0};
  options.comments = {"made by a test"};
  write_mesh(folder_ / "a.glb", mesh, options);
  tinygltf::Model model;
  std::string error, warning;
  ASSERT_TRUE(tinygltf::TinyGLTF().LoadBinaryFromFile(&model, &error, &warning, (folder_ / "a.glb").string())) << error;
  EXPECT_EQ(error + warning, "");
  ASSERT_EQ(model.meshes.size(), 1u);
  ASSERT_EQ(model.meshes[0].primitives.size(), 1u);
  const tinygltf::Primitive& primitive = model.meshes[0].primitives[0];
  const auto accessor = [&](const char* name) {
    return model.accessors[static_cast<std::size_t>(primitive.attributes.at(name))];
  };
  EXPECT_EQ(accessor("POSITION").count, mesh.vertices.size());
  EXPECT_EQ(accessor("NORMAL").count, mesh.vertices.size());
  EXPECT_TRUE(accessor("COLOR_0").normalized);
  EXPECT_THAT(accessor("POSITION").minValues, ElementsAre(-2, -2, 8)); // vertices lie on the axes
  EXPECT_THAT(accessor("POSITION").maxValues, ElementsAre(2, 2, 12));
  const auto& indices = model.accessors[static_cast<std::size_t>(primitive.indices)];
  EXPECT_EQ(indices.count, 3 * mesh.triangles.size());
  EXPECT_EQ(indices.componentType, TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT);
  EXPECT_TRUE(model.materials.at(0).doubleSided);
  EXPECT_EQ(model.asset.extras.Get("unit").Get<std::string>(), "metre");
  EXPECT_EQ(model.asset.extras.Get("shift").Get(0).GetNumberAsDouble(), -512000);
  EXPECT_EQ(model.asset.extras.Get("comments").Get(0).Get<std::string>(), "made by a test");
}

TEST_F(IoGlb, SameMeshSameBytes) {
  const TriangleMesh mesh = coloured_ball({1, 2, 3});
  write_mesh(folder_ / "a.glb", mesh);
  write_mesh(folder_ / "b.glb", mesh);
  EXPECT_EQ(read_bytes(folder_ / "a.glb"), read_bytes(folder_ / "b.glb"));
}

TEST_F(IoGlb, WhatItCannotHold) {
  TriangleMesh mesh = shapes::tetrahedron();
  mesh.vertex_attributes.push_back(make_attribute("q", ScalarType::float32, std::vector<double>{1, 2, 3, 4}));
  mesh.vertex_attributes.push_back(
      derived_attribute(make_attribute("source_index", std::vector<std::uint32_t>{0, 1, 2, 3})));
  EXPECT_THAT(write_mesh(folder_ / "a.glb", mesh).warnings,
              ElementsAre("GLB has no room for these attributes of the vertices: q"));
  mesh.vertices[2].y = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(write_mesh(folder_ / "b.glb", mesh), Error);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "b.glb"));
  EXPECT_THAT(write_mesh(folder_ / "c.glb", TriangleMesh{}).warnings, IsEmpty());
  EXPECT_THAT(read_mesh(folder_ / "c.glb").vertices, IsEmpty());
}

// Scenes have y up: (x, y, z) becomes (x, -z, y).
TEST_F(IoGlb, NodesPlaceMeshes) {
  EXPECT_THAT(read(glb_triangle(R"({"mesh":0})")).vertices, ElementsAre(Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 0, 1}));
  EXPECT_EQ(notes_.metres, 1);
  // Twice as large, turned by 90° about y (x to -z), then moved.
  const TriangleMesh moved =
      read(glb_triangle(R"({"children":[1],"translation":[10,20,30]},)"
                        R"({"mesh":0,"rotation":[0,0.70710678118654752,0,0.70710678118654752],"scale":[2,2,2]})"));
  const std::vector<Vec3> expected = {{10, -30, 20}, {10, -28, 20}, {10, -30, 22}};
  ASSERT_EQ(moved.vertices.size(), 3u);
  for (std::size_t v = 0; v < 3; ++v) EXPECT_LT(distance(moved.vertices[v], expected[v]), 1e-12);
  // A mirror turns triangles around, so that their front stays in front.
  EXPECT_THAT(read(glb_triangle(R"({"mesh":0,"scale":[1,1,-1]})")).triangles,
              ElementsAre(std::array<std::uint32_t, 3>{0, 2, 1}));
  EXPECT_THAT(read(glb_triangle(R"({"children":[1,2]},{"mesh":0},{"mesh":0})")).triangles,
              ElementsAre(std::array<std::uint32_t, 3>{0, 1, 2}, std::array<std::uint32_t, 3>{3, 4, 5}));
}

TEST_F(IoGlb, DamagedScenes) {
  expect_error("glTF", "only its beginning");
  expect_error(glb_file("{"), "JSON cannot be read");
  expect_error(glb_file(std::string(100000, '[')), "JSON cannot be read");
  expect_error(glb_triangle(R"({"mesh":0,"children":[0]})"), "below two others");
  expect_error(glb_triangle(R"({"mesh":1})"), "of meshes does not exist");
  expect_error(glb_triangle(R"({"mesh":-1})"), "no whole number");
  expect_error(glb_triangle(R"({"mesh":0,"matrix":[1,2]})"), "another number of numbers");
  expect_error(glb_triangle(R"({"mesh":0,"scale":[1e308,1e308,1e308],"children":[1]},{"scale":[1e308,1,1]})"),
               "not finite");
  expect_error(glb_triangle(R"({"mesh":0})", R"(,"extensionsRequired":["KHR_draco_mesh_compression"])"), "compressed");
  const auto changed = [](const std::string& from, const std::string& to) {
    std::string bytes = glb_triangle(R"({"mesh":0})");
    return bytes.replace(bytes.find(from), from.size(), to); // as long as before
  };
  expect_error(changed(R"("count":3,"type":"VEC3")", R"("count":4,"type":"VEC3")"), "beyond its view");
  expect_error(changed(R"("byteOffset":36)", R"("byteOffset":99)"), "beyond the file");
  expect_error(changed(R"("count":3,"type":"SC)", R"("count":9,"type":"SC)"), "beyond its view");
  expect_error(changed(R"("POSITION")", R"("POSITIOM")"), "POSITION is missing");
  std::string index = glb_triangle(R"({"mesh":0})");
  index[index.size() - 2] = '\3';
  expect_error(index, "names a vertex that does not exist");
  // 200 nodes that show one mesh each would be far more than the file is large.
  std::string nodes = R"({"children":[1)", shows;
  for (int i = 2; i <= 200; ++i) nodes.append(",").append(std::to_string(i));
  for (int i = 1; i <= 200; ++i) shows += R"(,{"mesh":0})";
  EXPECT_EQ(read(glb_triangle(nodes + "]}" + shows)).triangles.size(), 200u);
}

TEST_F(IoGlb, AFileIsNoLargerThanItsBytes) {
  // One triangle of 30000 indices, shown by 300 nodes.
  std::string nodes = R"({"children":[1)", shows;
  for (int i = 2; i <= 300; ++i) nodes.append(",").append(std::to_string(i));
  for (int i = 1; i <= 300; ++i) shows += R"(,{"mesh":0})";
  const std::string json =
      R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[)" + nodes + "]}" + shows +
      R"(],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],)" +
      R"("accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},)" +
      R"({"bufferView":1,"componentType":5121,"count":30000,"type":"SCALAR"}],)" +
      R"("bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteLength":30000}],"buffers":[{"byteLength":30000}]})";
  expect_error(glb_file(json, std::string(30000, '\0')), "too many times");
}

} // namespace
} // namespace eigencrust
