// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <clocale>
#include <cmath>
#include <limits>
#include <locale>

#include <eigencrust/io.h>

#include "support.h"

namespace eigencrust {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

/// A tetrahedron around `centre` with edges of about `size`.
TriangleMesh tetrahedron(const Vec3& centre, double size) {
  TriangleMesh mesh;
  for (const Vec3& v : {Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}})
    mesh.vertices.push_back(centre + size * v);
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  return mesh;
}

Attribute column(std::string name, ScalarType type, std::vector<double> values) {
  return make_attribute(std::move(name), type, values);
}

void expect_equal(const std::vector<Attribute>& a, const std::vector<Attribute>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].name, b[i].name);
    EXPECT_EQ(a[i].type, b[i].type) << a[i].name;
    EXPECT_EQ(a[i].values, b[i].values) << a[i].name;
    EXPECT_EQ(a[i].is_list, b[i].is_list) << a[i].name;
    EXPECT_EQ(a[i].offsets, b[i].offsets) << a[i].name;
    if (a[i].is_list) {
      EXPECT_EQ(a[i].count_type, b[i].count_type) << a[i].name;
    }
  }
}

/// One attribute of each type and a list, for four rows.
std::vector<Attribute> all_types() {
  std::vector<Attribute> attributes;
  int number = 0;
  for (const ScalarType type : {ScalarType::int8, ScalarType::uint8, ScalarType::int16, ScalarType::uint16,
                                ScalarType::int32, ScalarType::uint32, ScalarType::float32, ScalarType::float64})
    attributes.push_back(column(std::string("a") + std::to_string(number++), type, {-1e12, 1e12, 0.1, 1}));
  Attribute list = column("list", ScalarType::int16, {-300, 300, 7});
  list.is_list = true;
  list.count_type = ScalarType::uint16;
  list.offsets = {0, 2, 2, 3, 3};
  attributes.push_back(list);
  return attributes;
}

class IoWrite : public ::testing::Test {
 protected:
  TempDir folder_;
};

TEST_F(IoWrite, PlyKeepsEverythingBitForBit) {
  TriangleMesh mesh = tetrahedron({1.0 / 3, 0, 0}, 1e-12);
  mesh.vertex_attributes = all_types();
  mesh.triangle_attributes = all_types();
  WriteOptions options;
  options.comments = {"two\nlines"};
  const WriteResult result = write_mesh(folder_ / "a.ply", mesh, options);
  EXPECT_EQ(result.coordinates, CoordinateType::float64);
  EXPECT_THAT(result.warnings, IsEmpty());
  const TriangleMesh back = read_mesh(folder_ / "a.ply");
  EXPECT_EQ(back.vertices, mesh.vertices);
  EXPECT_EQ(back.triangles, mesh.triangles);
  expect_equal(back.vertex_attributes, mesh.vertex_attributes);
  expect_equal(back.triangle_attributes, mesh.triangle_attributes);
  EXPECT_THAT(read_bytes(folder_ / "a.ply"),
              ::testing::StartsWith("ply\nformat binary_little_endian 1.0\ncomment two\ncomment lines\n"
                                    "element vertex 4\nproperty double x\n"));
}

TEST_F(IoWrite, PlyOfAnEmptyMeshAndOfPoints) {
  write_mesh(folder_ / "a.ply", TriangleMesh{});
  EXPECT_THAT(read_mesh(folder_ / "a.ply").vertices, IsEmpty());
  PointCloud cloud{tetrahedron({}, 1).vertices, all_types(), {}};
  cloud.points[1].x = std::numeric_limits<double>::quiet_NaN();
  cloud.points[2].y = std::numeric_limits<double>::infinity();
  EXPECT_EQ(write_point_cloud(folder_ / "c.PLY", cloud).coordinates, CoordinateType::float32);
  const PointCloud back = read_point_cloud(folder_ / "c.PLY");
  EXPECT_TRUE(std::isnan(back.points[1].x));
  EXPECT_EQ(back.points[2].y, cloud.points[2].y);
  EXPECT_EQ(back.points[3], cloud.points[3]);
  expect_equal(back.attributes, cloud.attributes);
}

TEST_F(IoWrite, AutomaticCoordinates) {
  const auto chosen = [&](const TriangleMesh& mesh, double spacing = 0) {
    WriteOptions options;
    options.spacing = spacing;
    return write_mesh(folder_ / "a.ply", mesh, options).coordinates;
  };
  EXPECT_EQ(chosen(tetrahedron({0.1, 0.2, 0.3}, 1)), CoordinateType::float32);
  // At a million a float32 has a grid of 1/16: too coarse for edges of length 1, fine for a spacing of 100.
  const Vec3 far{1e6 + 0.01, 0, 0};
  EXPECT_EQ(chosen(tetrahedron(far, 1)), CoordinateType::float64);
  EXPECT_EQ(chosen(tetrahedron(far, 1), 100), CoordinateType::float32);
  // Two vertices 0.001 apart would become one, however large the spacing.
  TriangleMesh close = tetrahedron(far, 1);
  close.vertices.push_back(close.vertices[0] + Vec3{0.001, 0, 0});
  EXPECT_EQ(chosen(close, 100), CoordinateType::float64);
  // Equal vertices were no different before.
  close.vertices.back() = close.vertices[0];
  EXPECT_EQ(chosen(close, 100), CoordinateType::float32);
  // Beyond the range of float32.
  EXPECT_EQ(chosen(tetrahedron({1e39, 0, 0}, 1), 1e300), CoordinateType::float64);
  // Points have no edges: float32 only where it is exact.
  EXPECT_EQ(write_point_cloud(folder_ / "c.ply", {{{0.1, 0, 0}}, {}, {}}).coordinates, CoordinateType::float64);
  EXPECT_EQ(write_point_cloud(folder_ / "c.ply", {{{0.5, double{0.1f}, 0}}, {}, {}}).coordinates,
            CoordinateType::float32);
}

TEST_F(IoWrite, Float32AskedForButImpossible) {
  WriteOptions options;
  options.coordinates = CoordinateType::float32;
  TriangleMesh mesh = tetrahedron({1e6, 0, 0}, 1e-3);
  try {
    write_mesh(folder_ / "a.ply", mesh, options);
    FAIL() << "vertices were merged";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::guarantee);
  }
  EXPECT_FALSE(std::filesystem::exists(folder_ / "a.ply"));
  mesh = tetrahedron({0.1, 0, 0}, 1);
  EXPECT_EQ(write_mesh(folder_ / "a.ply", mesh, options).coordinates, CoordinateType::float32);
  EXPECT_EQ(read_mesh(folder_ / "a.ply").vertices[0].x, double{0.1f});
}

TEST_F(IoWrite, PlyNamesThatCollideOrHoldBlanks) {
  TriangleMesh mesh = tetrahedron({}, 1);
  for (const char* name : {"x", "my name", "a", "a", "", "vertex_indices"})
    mesh.vertex_attributes.push_back(column(name, ScalarType::uint8, {1, 2, 3, 4}));
  mesh.triangle_attributes.push_back(column("vertex_indices", ScalarType::uint8, {1, 2, 3, 4}));
  const WriteResult result = write_mesh(folder_ / "a.ply", mesh);
  EXPECT_EQ(result.warnings.size(), 5u);
  const TriangleMesh back = read_mesh(folder_ / "a.ply");
  std::vector<std::string> names;
  for (const Attribute& a : back.vertex_attributes) names.push_back(a.name);
  EXPECT_THAT(names, ElementsAre("x_2", "my_name", "a", "a_2", "attribute", "vertex_indices"));
  EXPECT_EQ(back.triangle_attributes.at(0).name, "vertex_indices_2");
}

TEST_F(IoWrite, ALongListWidensItsLength) {
  PointCloud cloud{{{0, 0, 0}}, {column("l", ScalarType::uint8, std::vector<double>(300, 5))}, {}};
  cloud.attributes[0].is_list = true;
  cloud.attributes[0].offsets = {0, 300};
  write_point_cloud(folder_ / "a.ply", cloud);
  EXPECT_EQ(read_point_cloud(folder_ / "a.ply").attributes[0].values, cloud.attributes[0].values);
}

TEST_F(IoWrite, TextReadsBackAsTheSameDoubles) {
  TriangleMesh mesh = tetrahedron({1.0 / 3, 1e-300, -123456789.123456789}, 0.1);
  mesh.vertices.push_back({5e-324, -0.0, 1.7976931348623157e308});
  for (const char* name : {"a.obj", "a.off"}) {
    EXPECT_EQ(write_mesh(folder_ / name, mesh).coordinates, CoordinateType::float64);
    EXPECT_EQ(read_mesh(folder_ / name).vertices, mesh.vertices);
    EXPECT_EQ(read_mesh(folder_ / name).triangles, mesh.triangles);
  }
  for (const char* name : {"a.xyz", "a.txt", "a.asc", "a.csv"}) {
    write_point_cloud(folder_ / name, {mesh.vertices, {}, {}});
    EXPECT_EQ(read_point_cloud(folder_ / name).points, mesh.vertices);
  }
  EXPECT_THAT(read_bytes(folder_ / "a.csv"), ::testing::StartsWith("x,y,z\n"));
}

TEST_F(IoWrite, ColoursSurviveInObjAndOff) {
  TriangleMesh mesh = tetrahedron({}, 1);
  for (const char* name : {"red", "green", "blue"})
    mesh.vertex_attributes.push_back(column(name, ScalarType::uint8, {0, 1, 200, 255}));
  mesh.vertex_attributes.push_back(column("quality", ScalarType::float32, {1, 2, 3, 4}));
  for (const char* name : {"a.obj", "a.off"}) {
    const WriteResult result = write_mesh(folder_ / name, mesh);
    ASSERT_EQ(result.warnings.size(), 1u);
    EXPECT_THAT(result.warnings[0], HasSubstr("quality"));
    EXPECT_THAT(result.warnings[0], Not(HasSubstr("red")));
    const TriangleMesh back = read_mesh(folder_ / name);
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_EQ(back.vertex_attributes.at(c).values, mesh.vertex_attributes[c].values);
  }
  EXPECT_THAT(read_bytes(folder_ / "a.off"), HasSubstr("1 0 0 1 1 1 255\n"));
  // Fractions stay fractions, 1.0 too.
  for (std::size_t c = 0; c < 3; ++c)
    mesh.vertex_attributes[c] = column(mesh.vertex_attributes[c].name, ScalarType::float32, {0, 1, 0.123, 0.5});
  for (const char* name : {"a.obj", "a.off"}) {
    write_mesh(folder_ / name, mesh);
    EXPECT_EQ(read_mesh(folder_ / name).vertex_attributes.at(0).values, mesh.vertex_attributes[0].values) << name;
  }
}

TEST_F(IoWrite, RowsKeepTheirAttributes) {
  PointCloud cloud{tetrahedron({}, 1).vertices, all_types(), {}};
  cloud.attributes[0].name = "odd, name";
  cloud.attributes[1].name = "red";
  for (const char* name : {"a.xyz", "a.csv"}) {
    WriteOptions options;
    options.comments = {"x y z"};
    EXPECT_EQ(write_point_cloud(folder_ / name, cloud, options).warnings.size(), 2u); // the name and the list
    const PointCloud back = read_point_cloud(folder_ / name);
    ASSERT_EQ(back.attributes.size(), 8u);
    EXPECT_EQ(back.attributes[0].name, "odd__name");
    EXPECT_EQ(back.attributes[1].type, ScalarType::uint8);
    for (std::size_t a = 0; a < 8; ++a)
      for (std::size_t i = 0; i < 4; ++i) {
        // A float's own shortest digits, read as a double, name the same float.
        const double expected = attribute_value(cloud.attributes[a], i);
        EXPECT_EQ(static_cast<float>(attribute_value(back.attributes[a], i)), static_cast<float>(expected));
        if (a != 6) {
          EXPECT_EQ(attribute_value(back.attributes[a], i), expected);
        }
      }
  }
}

TEST_F(IoWrite, StlNearAndFar) {
  const TriangleMesh near = tetrahedron({0.5, 0, 0}, 1);
  WriteResult result = write_mesh(folder_ / "a.stl", near);
  EXPECT_EQ(result.offset, (Vec3{}));
  EXPECT_THAT(result.warnings, IsEmpty());
  TriangleMesh back = read_mesh(folder_ / "a.stl");
  EXPECT_EQ(back.vertices.size(), 4u);
  EXPECT_EQ(back.vertices[back.triangles[3][0]], near.vertices[1]);
  EXPECT_EQ(read_bytes(folder_ / "a.stl").size(), 84u + 4 * 50);

  const TriangleMesh far = tetrahedron({600000.123, 5000000.456, 300}, 1);
  result = write_mesh(folder_ / "a.stl", far);
  EXPECT_EQ(result.offset, (Vec3{600000.623, 5000000.956, 300.5}));
  EXPECT_EQ(result.warnings.size(), 1u);
  back = read_mesh(folder_ / "a.stl");
  ASSERT_EQ(back.vertices.size(), 4u);
  for (std::size_t t = 0; t < 4; ++t)
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_LT(distance(back.vertices[back.triangles[t][k]] + result.offset, far.vertices[far.triangles[t][k]]), 1e-6);

  // So small and so wide that no offset helps.
  TriangleMesh both = tetrahedron({1e6, 0, 0}, 1e-3);
  both.vertices.push_back({-1e6, 0, 0});
  both.vertices.push_back({-1e6, 1e-3, 0});
  both.triangles.push_back({4, 5, 0});
  write_bytes(folder_ / "b.stl", "old");
  EXPECT_THROW(write_mesh(folder_ / "b.stl", both), Error);
  EXPECT_EQ(read_bytes(folder_ / "b.stl"), "old");
}

TEST_F(IoWrite, StlSaysWhatIsLost) {
  TriangleMesh mesh = tetrahedron({}, 1);
  mesh.vertex_attributes = {column("q", ScalarType::int8, {1, 2, 3, 4, 5})};
  mesh.vertices.push_back({9, 9, 9});
  WriteOptions options;
  options.comments = {"solid or not"};
  const WriteResult result = write_mesh(folder_ / "a.stl", mesh, options);
  EXPECT_EQ(result.warnings.size(), 2u);
  EXPECT_FALSE(read_bytes(folder_ / "a.stl").starts_with("solid"));
}

TEST_F(IoWrite, NamesWithoutAWriter) {
  EXPECT_TRUE(can_write_mesh("a.PLY") && can_write_mesh("a.obj") && can_write_mesh("a.off") &&
              can_write_mesh("x/a.Stl"));
  EXPECT_FALSE(can_write_mesh("a.xyz") || can_write_mesh("ply") || can_write_mesh("a.pts") || can_write_mesh(".ply"));
  EXPECT_TRUE(can_write_point_cloud("a.ply") && can_write_point_cloud("a.csv"));
  EXPECT_FALSE(can_write_point_cloud("a.stl") || can_write_point_cloud("a"));
  EXPECT_TRUE(can_write_mesh("a", "ply") && can_write_mesh("a.xyz", "OFF") && can_write_point_cloud("a.stl", "las"));
  EXPECT_FALSE(can_write_mesh("a.ply", "xyz") || can_write_point_cloud("a.ply", "e57"));
  EXPECT_THAT(error_of([&] { write_mesh(folder_ / "a.xyz", {}); }), HasSubstr("no writer"));
  EXPECT_THAT(error_of([&] { write_point_cloud(folder_ / "a.off", {}); }), HasSubstr("no writer"));
}

TEST_F(IoWrite, UnsoundMeshesAreRefused) {
  TriangleMesh mesh = tetrahedron({}, 1);
  mesh.triangles[0][0] = 4;
  EXPECT_THAT(error_of([&] { write_mesh(folder_ / "a.ply", mesh); }), HasSubstr("names vertex 4"));
  mesh = tetrahedron({}, 1);
  mesh.vertex_attributes = {column("q", ScalarType::int8, {1})};
  EXPECT_THAT(error_of([&] { write_mesh(folder_ / "a.ply", mesh); }), HasSubstr("1 row for 4"));
  mesh.vertex_attributes = all_types();
  mesh.vertex_attributes.back().offsets = {0, 9, 2, 3, 3};
  EXPECT_THAT(error_of([&] { write_mesh(folder_ / "a.ply", mesh); }), HasSubstr("list"));
}

// Neither the C nor the C++ locale may put a comma into a number, or read one there.
TEST_F(IoWrite, IndependentOfTheLocale) {
  struct Comma : std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
    char do_thousands_sep() const override { return '.'; }
    std::string do_grouping() const override { return "\3"; }
  };
  const std::locale before = std::locale::global(std::locale(std::locale::classic(), new Comma));
  const TriangleMesh mesh = tetrahedron({1234567.5, 0, 0}, 0.25);
  write_mesh(folder_ / "a.obj", mesh);
  write_mesh(folder_ / "a.ply", mesh);
  write_file_atomically(folder_ / "a.txt", [](std::ostream& out) { out << 1234.5; });
  const TriangleMesh obj = read_mesh(folder_ / "a.obj"), ply = read_mesh(folder_ / "a.ply");
  std::locale::global(before);
  EXPECT_EQ(obj.vertices, mesh.vertices);
  EXPECT_EQ(ply.vertices, mesh.vertices);
  EXPECT_EQ(read_bytes(folder_ / "a.txt"), "1234.5");
}

} // namespace
} // namespace eigencrust
