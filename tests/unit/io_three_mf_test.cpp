// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include <Model/COM/NMR_DLLInterfaces.h>
#include <eigencrust/io.h>
#include <eigencrust/validate.h>

#include "scene_bytes.h"
#include "shapes.h"
#include "support.h"

namespace eigencrust {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// What lib3mf reads.
struct Seen {
  TriangleMesh mesh; ///< in the unit of the file: what the build item does is done
  DWORD unit = 99;
  bool printable = false;
};

void require(HRESULT status) {
  if (status != 0) throw std::runtime_error("lib3mf: " + std::to_string(status));
}

void read_object(NMR::PLib3MFModelBuildItem* item, Seen& seen) {
  NMR::PLib3MFModelObjectResource* object = nullptr;
  NMR::MODELTRANSFORM transform{};
  BOOL valid = 0, has_transform = 0;
  DWORD vertices = 0, triangles = 0;
  require(NMR::lib3mf_builditem_getobjectresource(item, &object));
  require(NMR::lib3mf_object_isvalidobject(object, &valid));
  require(NMR::lib3mf_builditem_hasobjecttransform(item, &has_transform));
  require(NMR::lib3mf_builditem_getobjecttransform(item, &transform));
  require(NMR::lib3mf_meshobject_getvertexcount(object, &vertices));
  require(NMR::lib3mf_meshobject_gettrianglecount(object, &triangles));
  for (DWORD v = 0; v < vertices; ++v) {
    NMR::MODELMESHVERTEX vertex;
    require(NMR::lib3mf_meshobject_getvertex(object, v, &vertex));
    std::array<double, 3> p{};
    for (int k = 0; k < 3; ++k) {
      p[k] = double{vertex.m_fPosition[k]} * (has_transform != 0 ? double{transform.m_fFields[k][k]} : 1.0);
    }
    seen.mesh.vertices.push_back({p[0], p[1], p[2]});
  }
  for (DWORD t = 0; t < triangles; ++t) {
    NMR::MODELMESHTRIANGLE triangle;
    require(NMR::lib3mf_meshobject_gettriangle(object, t, &triangle));
    seen.mesh.triangles.push_back({triangle.m_nIndices[0], triangle.m_nIndices[1], triangle.m_nIndices[2]});
  }
  seen.printable = valid != 0;
  NMR::lib3mf_release(object);
}

Seen read_with_library(const std::filesystem::path& path) {
  Seen seen;
  NMR::PLib3MFModel* model = nullptr;
  NMR::PLib3MFModelReader* reader = nullptr;
  NMR::PLib3MFModelBuildItemIterator* items = nullptr;
  NMR::PLib3MFModelBuildItem* item = nullptr;
  DWORD warnings = 99;
  BOOL more = 0;
  require(NMR::lib3mf_createmodel(&model));
  require(NMR::lib3mf_model_queryreader(model, "3mf", &reader));
  require(NMR::lib3mf_reader_readfromfileutf8(reader, path.c_str()));
  require(NMR::lib3mf_reader_getwarningcount(reader, &warnings));
  EXPECT_EQ(warnings, 0u);
  require(NMR::lib3mf_model_getunit(model, &seen.unit));
  require(NMR::lib3mf_model_getbuilditems(model, &items));
  require(NMR::lib3mf_builditemiterator_movenext(items, &more));
  EXPECT_NE(more, 0);
  require(NMR::lib3mf_builditemiterator_getcurrent(items, &item));
  read_object(item, seen);
  for (NMR::PLib3MFBase* each : {item, items, reader, model}) NMR::lib3mf_release(each);
  return seen;
}

class IoThreeMf : public ::testing::Test {
 protected:
  TriangleMesh read(const std::string& bytes) {
    write_bytes(folder_ / "r.3mf", bytes);
    notes_ = {};
    return read_mesh(folder_ / "r.3mf", &notes_);
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

TEST_F(IoThreeMf, TheLibraryReadsCountsVolumeAndUnit) {
  const TriangleMesh mesh = shapes::torus(30, 10, 40, 20);
  const double volume = validate(mesh).volume;
  WriteOptions options;
  for (const auto& [metres, unit] : {std::pair{1.0, NMR::MODELUNIT_METER},
                                     {1e-3, NMR::MODELUNIT_MILLIMETER},
                                     {0.0254, NMR::MODELUNIT_INCH},
                                     {0.0, NMR::MODELUNIT_MILLIMETER}}) {
    options.metres = metres;
    const WriteResult result = write_mesh(folder_ / "a.3mf", mesh, options);
    EXPECT_EQ(result.warnings.size(), metres > 0 ? 0u : 1u);
    const Seen seen = read_with_library(folder_ / "a.3mf");
    EXPECT_EQ(seen.unit, static_cast<DWORD>(unit));
    EXPECT_TRUE(seen.printable);
    EXPECT_EQ(seen.mesh.vertices.size(), mesh.vertices.size());
    EXPECT_EQ(seen.mesh.triangles, mesh.triangles);
    EXPECT_NEAR(validate(seen.mesh).volume, volume, 1e-6 * volume);
    const TriangleMesh back = read_mesh(folder_ / "a.3mf", &notes_);
    EXPECT_EQ(back.triangles, mesh.triangles);
    EXPECT_EQ(notes_.metres, metres > 0 ? metres : 1e-3);
  }
}

// The library prints millionths of the unit; what is smaller needs a finer one.
TEST_F(IoThreeMf, SmallAndFarBodies) {
  WriteOptions options;
  options.metres = 1;
  for (const double size : {1e-9, 1e-4, 1.0, 1e5}) {
    const TriangleMesh mesh = shapes::icosphere(3, size);
    EXPECT_THAT(write_mesh(folder_ / "a.3mf", mesh, options).warnings, IsEmpty()) << size;
    const Seen seen = read_with_library(folder_ / "a.3mf");
    const TriangleMesh back = read_mesh(folder_ / "a.3mf");
    ASSERT_EQ(seen.mesh.vertices.size(), mesh.vertices.size());
    ASSERT_EQ(back.vertices.size(), mesh.vertices.size());
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
      EXPECT_LT(distance(seen.mesh.vertices[v], mesh.vertices[v]), 2e-4 * size) << size; // edges are 0.15 of it
      EXPECT_LT(distance(back.vertices[v], mesh.vertices[v]), 2e-4 * size) << size;
    }
    EXPECT_TRUE(validate(back).closed());
  }
  const TriangleMesh far = shapes::icosphere(3, 1, {512000, 5412000, 300});
  const WriteResult result = write_mesh(folder_ / "a.3mf", far, options);
  EXPECT_THAT(result.warnings, ElementsAre(HasSubstr("this was subtracted")));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "a.3mf.offset.txt"));
  const TriangleMesh back = read_mesh(folder_ / "a.3mf");
  for (std::size_t v = 0; v < far.vertices.size(); ++v)
    EXPECT_LT(distance(back.vertices[v] + result.offset, far.vertices[v]), 1e-5);
}

TEST_F(IoThreeMf, ColoursAndWhatIsLost) {
  TriangleMesh mesh = shapes::tetrahedron();
  for (const char* name : {"red", "green", "blue"})
    mesh.vertex_attributes.push_back(make_attribute(name, ScalarType::uint8, std::vector<double>{1, 2, 3, 255}));
  mesh.vertex_attributes.push_back(make_attribute("q", ScalarType::float32, std::vector<double>{1, 2, 3, 4}));
  mesh.triangle_attributes.push_back(
      derived_attribute(make_attribute("support", ScalarType::float32, std::vector<double>{1, 2, 3, 4})));
  WriteOptions options;
  options.metres = 1;
  options.comments = {"a < b & \"c\"\n"};
  EXPECT_THAT(write_mesh(folder_ / "a.3mf", mesh, options).warnings,
              ElementsAre("3MF has no room for these attributes of the vertices: q"));
  EXPECT_EQ(read_with_library(folder_ / "a.3mf").mesh.triangles, mesh.triangles);
  const TriangleMesh back = read_mesh(folder_ / "a.3mf");
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(back.vertex_attributes.at(k).name, mesh.vertex_attributes[k].name);
    EXPECT_EQ(back.vertex_attributes.at(k).values, mesh.vertex_attributes[k].values);
  }
  EXPECT_EQ(back.vertex_attributes.size(), 3u);
  write_mesh(folder_ / "b.3mf", mesh, options);
  EXPECT_EQ(read_bytes(folder_ / "a.3mf"), read_bytes(folder_ / "b.3mf")); // without times and random names
  mesh.triangles.pop_back();
  mesh.triangle_attributes.clear();
  EXPECT_THAT(write_mesh(folder_ / "a.3mf", mesh, options).warnings,
              Contains(HasSubstr("the mesh is not closed, manifold and oriented")));
  EXPECT_THROW(write_mesh(folder_ / "c.3mf", TriangleMesh{}), Error);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "c.3mf"));
}

TEST_F(IoThreeMf, BuildsOfOtherPrograms) {
  const std::string two =
      "<model unit='inch' xmlns:m='x'><resources><m:colorgroup id='7'><m:color color='#FF0000'/>"
      "<m:color color='#0102037F'/></m:colorgroup><object id='1' pid='7' pindex='1'>" +
      three_mf_mesh("pid='7' p1='0'") +
      "</object><object id='2'><components><component objectid='1'/><component objectid='1' "
      "transform='-1 0 0 0 1 0 0 0 1 5 0 0'/></components></object></resources>"
      "<build><item objectid='2' transform='1 0 0 0 1 0 0 0 1 0 0 10'/></build></model>";
  const TriangleMesh mesh = read(three_mf_file(two));
  EXPECT_EQ(notes_.metres, 0.0254);
  ASSERT_EQ(mesh.vertices.size(), 8u);
  EXPECT_EQ(mesh.vertices[1], (Vec3{1, 0, 10}));
  EXPECT_EQ(mesh.vertices[5], (Vec3{4, 0, 10}));
  EXPECT_NEAR(validate(mesh).volume, 2.0 / 6, 1e-12); // the mirrored one is outward, too
  const Attribute* red = find_attribute(mesh.vertex_attributes, "red");
  const Attribute* alpha = find_attribute(mesh.vertex_attributes, "alpha");
  ASSERT_NE(red, nullptr);
  ASSERT_NE(alpha, nullptr);
  EXPECT_EQ(attribute_value(*red, 0), 255);
  EXPECT_EQ(attribute_value(*red, 3), 1);
  EXPECT_EQ(attribute_value(*alpha, 3), 127);
  // As a cloud its vertices; without the ending of the name by its parts.
  write_bytes(folder_ / "cloud", three_mf_file(two));
  EXPECT_EQ(read_point_cloud(folder_ / "cloud").points.size(), 8u);
}

TEST_F(IoThreeMf, DamagedModels) {
  const auto model = [](const std::string& resources, const std::string& build = "<item objectid='1'/>") {
    return three_mf_file("<model><resources>" + resources + "</resources><build>" + build + "</build></model>");
  };
  const std::string object = "<object id='1'>" + three_mf_mesh() + "</object>";
  EXPECT_EQ(read(model(object)).triangles.size(), 4u);
  EXPECT_EQ(notes_.metres, 1e-3);
  expect_error(zip_file({{"a.txt", "1 2 3"}}), "no 3D model");
  expect_error(three_mf_file("<model><resources>"), "XML cannot be read");
  expect_error(three_mf_file("<model unit='cubit'/>"), "'cubit' is not known");
  expect_error(model(object, ""), "nothing to build");
  expect_error(model(object, "<item objectid='2'/>"), "does not exist");
  expect_error(model("<object id='1'><components><component objectid='1'/></components></object>"), "not before");
  expect_error(model("<object id='1'><mesh><vertices><vertex x='0' y='0' z='nan'/></vertices></mesh></object>"),
               "no finite number");
  expect_error(model("<object id='1'><mesh><vertices/><triangles><triangle v1='0' v2='1' v3='2'/></triangles></mesh>"
                     "</object>"),
               "names vertex 0 of 0");
  expect_error(model(object, "<item objectid='1' transform='1 2 3'/>"), "twelve");
  // Each object shows the one before ten times: 10^12 tetrahedra.
  std::string laughs = object;
  for (int i = 2; i <= 13; ++i) {
    laughs += "<object id='" + std::to_string(i) + "'><components>";
    for (int k = 0; k < 10; ++k) laughs += "<component objectid='" + std::to_string(i - 1) + "'/>";
    laughs += "</components></object>";
  }
  expect_error(model(laughs, "<item objectid='13'/>"), "too many times");
}

} // namespace
} // namespace eigencrust
