// SPDX-License-Identifier: GPL-3.0-or-later
// Reading obj, off and stl.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include <eigencrust/io.h>

#include "support.h"

namespace eigencrust {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using Triangle = std::array<std::uint32_t, 3>;

class IoMeshes : public ::testing::Test {
 protected:
  std::filesystem::path file(std::string_view name, std::string_view text) {
    write_bytes(folder_ / name, text);
    return folder_ / name;
  }
  TriangleMesh read(std::string_view name, std::string_view text) { return read_mesh(file(name, text)); }
  std::string error(std::string_view name, std::string_view text) {
    return error_of([&] { read(name, text); });
  }

 private:
  TempDir folder_;
};

TEST_F(IoMeshes, ObjFacesOfAllKinds) {
  const TriangleMesh m = read("a.obj",
                              "# a square\nmtllib x.mtl\nf 1 2 3\nv 0 0 0\nv 1 0 0 # comment\nv 1 \\\n 1 0\nvt 0 0\n"
                              "vn 0 0 1\nv 0 1 0 1.0\nf 1/1 2/1 3/1 4/1\nf 1//1 2//1 3//1\nf 1/1/1 -3/1/1 -2/1/1\n"
                              "f 1 2\nl 1 2\ns off\n");
  EXPECT_EQ(m.vertices.size(), 4u);
  EXPECT_EQ(m.vertices[2], (Vec3{1, 1, 0}));
  EXPECT_THAT(m.triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{0, 1, 2}, Triangle{0, 2, 3}, Triangle{0, 1, 2},
                                       Triangle{0, 1, 2}));
  EXPECT_THAT(m.vertex_attributes, IsEmpty());
  EXPECT_EQ(read_point_cloud(file("b.OBJ", "v 1 2 3\n")).points.size(), 1u);
}

TEST_F(IoMeshes, ObjColours) {
  // 0.752941 = 192/255 in six digits. The second vertex has no colour and is white.
  const TriangleMesh m = read("a.obj", "v 0 0 0 0.752941 0 1\nv 0 0 1\nv 0 1 0 0.2 0.4 0.6\n");
  ASSERT_EQ(m.vertex_attributes.size(), 3u);
  EXPECT_EQ(m.vertex_attributes[0].name, "red");
  EXPECT_EQ(m.vertex_attributes[0].type, ScalarType::uint8);
  EXPECT_EQ(attribute_value(m.vertex_attributes[0], 0), 192);
  EXPECT_EQ(attribute_value(m.vertex_attributes[0], 1), 255);
  EXPECT_EQ(attribute_value(m.vertex_attributes[2], 2), 153);
  // 0.5 lies between 127/255 and 128/255, so that bytes would lose it.
  EXPECT_EQ(read("a.obj", "v 0 0 0 0.5 0 1\n").vertex_attributes[0].type, ScalarType::float32);
  EXPECT_EQ(attribute_value(read("a.obj", "v 0 0 0 200 0 1\n").vertex_attributes[0], 0), 200);
}

TEST_F(IoMeshes, ObjErrors) {
  EXPECT_THAT(error("a.obj", "v 0 0 0\nf 1 1 2\n"), HasSubstr("a.obj:2"));
  EXPECT_THAT(error("a.obj", "v 0 0 0\nf 1 1 -2\n"), HasSubstr("names vertex -2"));
  EXPECT_THAT(error("a.obj", "v 0 0 0\nf 1 1 0\n"), HasSubstr("'0'"));
  EXPECT_THAT(error("a.obj", "v 0 0 0\nf 1 1 9223372036854775807\n"), HasSubstr("a.obj:2"));
  EXPECT_THAT(error("a.obj", "v 0 0 0\nf 1 x 1\n"), HasSubstr("'x'"));
  EXPECT_THAT(error("a.obj", "v 0 0\n"), HasSubstr("a.obj:1"));
  EXPECT_THAT(error("a.obj", "v 0 \\\n\n"), HasSubstr("a.obj:1"));
  EXPECT_THAT(error("a.obj", "v 0 0 zero\n"), HasSubstr("'zero'"));
  EXPECT_THAT(error("a.obj", "# nothing here\n"), HasSubstr("no vertex lines"));
}

TEST_F(IoMeshes, OffVariants) {
  for (const char* text :
       {"OFF\n# c\n3 1 0\n0 0 0\n1 0 0 # odd\n0 1 0\n\n3 0 1 2 1.0 0.0 0.0\n",
        "OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n3  0 1 2\n", "  OFF3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2",
        "OFF\r\n3 1\r\n0 0 0\r\n1 0 0\r\n0 1 0\r\n3 0 1 2\r\n", "3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"}) {
    const TriangleMesh m = read("a.off", text);
    EXPECT_THAT(m.vertices, ElementsAre(Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0})) << text;
    EXPECT_THAT(m.triangles, ElementsAre(Triangle{0, 1, 2})) << text;
  }
  EXPECT_EQ(read("a.off", "OFF\n4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n").triangles.size(), 2u);
}

TEST_F(IoMeshes, OffColoursAndNormals) {
  const TriangleMesh whole = read("a.off", "COFF\n1 0 0\n1 2 3 1 0 255 128\n");
  ASSERT_EQ(whole.vertex_attributes.size(), 4u);
  EXPECT_EQ(attribute_value(whole.vertex_attributes[0], 0), 1); // 1 of 255: whole numbers are bytes
  EXPECT_EQ(whole.vertex_attributes[3].name, "alpha");
  const TriangleMesh fraction = read("a.off", "COFF\n1 0 0\n1 2 3 1.0 0.0 0.2\n");
  ASSERT_EQ(fraction.vertex_attributes.size(), 3u);
  EXPECT_EQ(attribute_value(fraction.vertex_attributes[0], 0), 255);
  EXPECT_EQ(attribute_value(fraction.vertex_attributes[2], 0), 51);
  const TriangleMesh all = read("a.off", "STCNOFF\n1 0 0\n1 2 3 0 0 1 9 8 7 0.25 0.75\n");
  std::vector<std::string> names;
  for (const Attribute& a : all.vertex_attributes) names.push_back(a.name);
  EXPECT_THAT(names, ElementsAre("nx", "ny", "nz", "red", "green", "blue", "s", "t"));
  EXPECT_EQ(attribute_value(all.vertex_attributes[2], 0), 1);
  EXPECT_EQ(attribute_value(all.vertex_attributes[5], 0), 7);
  EXPECT_EQ(attribute_value(all.vertex_attributes[7], 0), 0.75);
}

TEST_F(IoMeshes, OffErrors) {
  EXPECT_THAT(error("a.off", ""), HasSubstr("empty"));
  EXPECT_THAT(error("a.off", "OFF\n"), HasSubstr("before the counts"));
  EXPECT_THAT(error("a.off", "OFF BINARY\n"), HasSubstr("binary OFF"));
  EXPECT_THAT(error("a.off", "4OFF\n1 0 0\n1 2 3 4\n"), HasSubstr("points in space"));
  EXPECT_THAT(error("a.off", "nOFF\n1 0 0\n1 2 3 4\n"), HasSubstr("points in space"));
  EXPECT_THAT(error("a.off", "PLY\n"), HasSubstr("points in space"));
  EXPECT_THAT(error("a.off", "OFF\nx y z\n"), HasSubstr("a.off:2"));
  EXPECT_THAT(error("a.off", "OFF\n999999999999 0 0\n1 2 3\n"), HasSubstr("too short"));
  EXPECT_THAT(error("a.off", "OFF\n2 0 0\n1 2 3\n#      \n"), HasSubstr("after 1 vertex row of 2"));
  EXPECT_THAT(error("a.off", "OFF\n1 1 0\n1 2 3\n#\n"), HasSubstr("after 0 face rows of 1"));
  EXPECT_THAT(error("a.off", "OFF\n1 1 0\n1 2 3\n3 0 0 1\n"), HasSubstr("a.off:4"));
  EXPECT_THAT(error("a.off", "OFF\n1 1 0\n1 2 3\n3 0 0\n"), HasSubstr("ends before the last of its 3 vertex numbers"));
  EXPECT_THAT(error("a.off", "OFF\n1 1 0\n1 2 3\n4000000000 0 0\n"), HasSubstr("a.off:4"));
  EXPECT_THAT(error("a.off", "OFF\n1 0 0\n1 2 3\n3 0 0 0\n"), HasSubstr("more rows"));
  EXPECT_THAT(error("a.off", "OFF\n2 0 0\n1 2 3\n1 2 3 4\n"), HasSubstr("4 values where 3"));
  EXPECT_THAT(error("a.off", "OFF\n1 0 0\n1 2 3 4 5\n"), HasSubstr("5 values"));
  EXPECT_THAT(error("a.off", "NOFF\n1 0 0\n1 2 3 4\n"), HasSubstr("4 values"));
}

/// Binary STL: 80 bytes, the count, then 50 bytes for each facet.
std::string binary_stl(std::string header, const std::vector<std::array<float, 12>>& facets) {
  header.resize(80, ' ');
  const auto count = static_cast<std::uint32_t>(facets.size());
  header.append(reinterpret_cast<const char*>(&count), 4);
  for (const auto& facet : facets) {
    header.append(reinterpret_cast<const char*>(facet.data()), 48);
    header.append(2, '\0');
  }
  return header;
}

TEST_F(IoMeshes, StlMergesEqualCorners) {
  // Two triangles with a common edge; -0 is 0. The header begins like a text file's.
  const std::string bytes = binary_stl(
      "solid but binary", {{0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 0, 1, 1, -0.0f, 0, 1, 1, 0, 0, 1, -0.0f}});
  const TriangleMesh m = read("a.STL", bytes);
  EXPECT_THAT(m.vertices, ElementsAre(Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{1, 1, 0}));
  EXPECT_THAT(m.triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{1, 3, 2}));
  EXPECT_EQ(read_point_cloud(file("b.stl", bytes)).points.size(), 4u);
  EXPECT_THAT(error("a.stl", bytes.substr(0, 150)), HasSubstr("at byte 150"));
  EXPECT_THAT(error("a.stl", binary_stl("x", {}).substr(0, 83)), HasSubstr("within its header"));
  EXPECT_EQ(read("a.stl", bytes + "more").triangles.size(), 2u); // some programs append a note
  EXPECT_THAT(read("a.stl", binary_stl("x", {})).triangles, IsEmpty());
}

TEST_F(IoMeshes, StlText) {
  const std::string facet =
      " FACET normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   VERTEX 1e0 0 0\n\tvertex 0 1.5 0\r\n  endloop\n "
      "endfacet\n";
  const TriangleMesh m =
      read("a.stl", "\nSOLID two words\n" + facet + "endsolid two words\nsolid\n" + facet + "endsolid\n");
  EXPECT_EQ(m.vertices.size(), 3u);
  EXPECT_THAT(m.triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{0, 1, 2}));
  EXPECT_THAT(read("a.stl", "solid Empty\nendsolid Empty").triangles, IsEmpty());
  EXPECT_THAT(error("a.stl", "solid\n" + facet), HasSubstr("ends within a solid"));
  EXPECT_THAT(error("a.stl", "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n"), HasSubstr("a.stl:4"));
  EXPECT_THAT(error("a.stl", "solid\nfacet\nouter loop\nvertex 0 0 0\nvertex 0 0 1\nendloop\n"),
              HasSubstr("2 corners"));
  EXPECT_THAT(error("a.stl", "solid\nfacet\nouter loop\nvertex 0 0\n"), HasSubstr("malformed vertex"));
  EXPECT_THAT(error("a.stl", "solid\nvertex 0 0 0\n"), HasSubstr("'vertex' is not expected within a solid"));
  EXPECT_THAT(error("a.stl", ""), HasSubstr("empty"));
}

} // namespace
} // namespace eigencrust
