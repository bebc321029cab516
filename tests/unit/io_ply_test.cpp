// SPDX-License-Identifier: GPL-3.0-or-later
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

class IoPly : public ::testing::Test {
 protected:
  std::filesystem::path file(std::string_view bytes) {
    write_bytes(folder_ / "a.ply", bytes);
    return folder_ / "a.ply";
  }
  PointCloud cloud(std::string_view bytes) { return read_point_cloud(file(bytes)); }
  TriangleMesh mesh(std::string_view bytes) { return read_mesh(file(bytes)); }
  std::string error(std::string_view bytes) {
    const auto path = file(bytes);
    return error_of([&] { read_mesh(path); });
  }

 private:
  TempDir folder_;
};

/// The bytes of values, each reversed when `swapped`.
template <class... T>
std::string packed(bool swapped, T... values) {
  std::string bytes;
  const auto append = [&](auto value) {
    std::string one(reinterpret_cast<const char*>(&value), sizeof value);
    bytes += swapped ? std::string(one.rbegin(), one.rend()) : one;
  };
  (append(values), ...);
  return bytes;
}

std::vector<double> values(const Attribute& attribute) {
  std::vector<double> result;
  for (std::size_t i = 0; i < attribute.values.size() / size_of(attribute.type); ++i)
    result.push_back(attribute_value(attribute, i));
  return result;
}

TEST_F(IoPly, PropertiesInAnyOrderAndOfAnyType) {
  const PointCloud c = cloud(
      "ply\nformat ascii 1.0\ncomment x y\nobj_info z\nelement vertex 2\n"
      "property uchar red\nproperty double z\nproperty int16 y\nproperty float32 nx\nproperty float x\nend_header\n"
      "255 1e-3 -7 0.5 0.1\n\n 0\t2 +8 nan -inf \n");
  ASSERT_EQ(c.points.size(), 2u);
  EXPECT_EQ(c.points[0], (Vec3{double{0.1f}, -7, 1e-3})); // 0.1 as declared: a float
  EXPECT_EQ(c.points[1].x, -std::numeric_limits<double>::infinity());
  ASSERT_EQ(c.attributes.size(), 2u);
  EXPECT_EQ(c.attributes[0].name, "red");
  EXPECT_EQ(c.attributes[0].type, ScalarType::uint8);
  EXPECT_THAT(values(c.attributes[0]), ElementsAre(255, 0));
  EXPECT_EQ(c.attributes[1].type, ScalarType::float32);
  EXPECT_TRUE(std::isnan(attribute_value(c.attributes[1], 1)));
  EXPECT_THAT(c.scan_index, IsEmpty());
}

// The same vertices with a list, between two unknown elements, in both byte orders: every reader path
// of a binary file.
TEST_F(IoPly, BothByteOrdersListsAndUnknownElements) {
  for (const bool big : {false, true}) {
    const bool swapped = big != (std::endian::native == std::endian::big);
    const std::string header =
        std::string("ply\r\nformat binary_") + (big ? "big" : "little") +
        "_endian 1.0\r\nelement camera 1\r\nproperty list ushort double k\r\nproperty char c\r\n"
        "element vertex 2\r\nproperty double x\r\nproperty list uint8 int16 l\r\nproperty short y\r\nproperty uint "
        "z\r\n"
        "element face 1\r\nproperty uchar q\r\nproperty list int uint vertex_index\r\nproperty list uchar float uv\r\n"
        "element tristrips 1\r\nproperty list int int vertex_indices\r\nend_header\r\n";
    std::string data = packed(swapped, std::uint16_t{2}, 1.5, 2.5, 'c');
    data += packed(swapped, 0.1, std::uint8_t{2}, std::int16_t{-300}, std::int16_t{4}, std::int16_t{-2}, 4000000000u);
    data += packed(swapped, 0.2, std::uint8_t{0}, std::int16_t{258}, 7u);
    data += packed(swapped, std::uint8_t{9}, 4, 0u, 1u, 0u, 1u, std::uint8_t{1}, 0.5f);
    data += packed(swapped, 3, 0, 1, -1);
    const TriangleMesh m = mesh(header + data);
    EXPECT_THAT(m.vertices, ElementsAre(Vec3{0.1, -2, 4e9}, Vec3{0.2, 258, 7}));
    ASSERT_EQ(m.vertex_attributes.size(), 1u);
    const Attribute& list = m.vertex_attributes[0];
    EXPECT_TRUE(list.is_list);
    EXPECT_EQ(list.count_type, ScalarType::uint8);
    EXPECT_THAT(list.offsets, ElementsAre(0u, 2u, 2u));
    EXPECT_THAT(values(list), ElementsAre(-300, 4));
    // The quad becomes two triangles that both have its q; the list of its corners is not theirs.
    EXPECT_EQ(m.triangles.size(), 2u);
    EXPECT_EQ(m.triangles[1], (std::array<std::uint32_t, 3>{0, 0, 1}));
    ASSERT_EQ(m.triangle_attributes.size(), 1u);
    EXPECT_EQ(m.triangle_attributes[0].name, "q");
    EXPECT_THAT(values(m.triangle_attributes[0]), ElementsAre(9, 9));
    // As a cloud the faces are only skipped, but what is missing of them is noticed.
    EXPECT_EQ(cloud(header + data).points.size(), 2u);
    data.pop_back();
    EXPECT_THROW(cloud(header + data), Error);
  }
}

TEST_F(IoPly, LineEndsOfOldMacsAndMissingLastLineEnd) {
  const PointCloud c = cloud(
      "ply\rformat ascii 1.0\relement vertex 2\rproperty float x\rproperty float y\rproperty float z\r"
      "end_header\r1 2 3\r4 5 6");
  EXPECT_THAT(c.points, ElementsAre(Vec3{1, 2, 3}, Vec3{4, 5, 6}));
  // The first data byte is 0x0A: it belongs to the data, not to the line end.
  std::string header =
      "ply\rformat binary_little_endian 1.0\relement vertex 1\rproperty char x\rproperty char y\rproperty char z\r"
      "end_header\r";
  EXPECT_THAT(cloud(header + "\n\n\r").points, ElementsAre(Vec3{10, 10, 13}));
}

TEST_F(IoPly, NoFacesIsAMeshWithoutTriangles) {
  const std::string head = "ply\nformat ascii 1.0\nelement vertex 1\nproperty int x\nproperty int y\nproperty int z\n";
  EXPECT_THAT(mesh(head + "end_header\n1 2 3\n").triangles, IsEmpty());
  // Faces that name no vertices, or fewer than three.
  EXPECT_THAT(mesh(head + "element face 1\nproperty int k\nend_header\n1 2 3\n4\n").triangles, IsEmpty());
  EXPECT_THAT(
      mesh(head + "element face 2\nproperty list uchar int vertex_indices\nend_header\n1 2 3\n2 0 0\n0\n").triangles,
      IsEmpty());
}

TEST_F(IoPly, TrianglesKeepTheListsOfTheirCorners) {
  const TriangleMesh m = mesh(
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty int x\nproperty int y\nproperty int z\n"
      "element face 1\nproperty list uchar int vertex_indices\nproperty list uchar float uv\nend_header\n"
      "0 0 0\n1 0 0\n0 1 0\n3 0 1 2 2 0.25 0.5\n");
  ASSERT_EQ(m.triangle_attributes.size(), 1u);
  EXPECT_THAT(values(m.triangle_attributes[0]), ElementsAre(0.25, 0.5));
}

TEST_F(IoPly, EqualNamesGetASuffix) {
  const PointCloud c = cloud(
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty int x\nproperty int y\nproperty int z\n"
      "property int a\nproperty int a\nend_header\n1 2 3 4 5\n");
  ASSERT_EQ(c.attributes.size(), 2u);
  EXPECT_EQ(c.attributes[1].name, "a_2");
}

struct Bad {
  const char* text;
  const char* said;
};
class IoPlyBad : public IoPly, public ::testing::WithParamInterface<Bad> {};

TEST_P(IoPlyBad, IsRefusedWithTheReason) {
  const std::string message = error(GetParam().text);
  EXPECT_THAT(message, HasSubstr(GetParam().said));
  EXPECT_THAT(message, HasSubstr("a.ply"));
}

#define XYZ "property float x\nproperty float y\nproperty float z\n"
INSTANTIATE_TEST_SUITE_P(
    Headers, IoPlyBad,
    ::testing::Values(
        Bad{"", "does not begin with 'ply'"}, Bad{"plyx\n", "a.ply:1"},
        Bad{"ply\nformat ascii 1.0\nelement vertex 1\n" XYZ, "no end_header"},
        Bad{"ply\nelement vertex 0\n" XYZ "end_header\n", "names no format"},
        Bad{
            "ply\nformat binary 1.0\n",
            "unknown PLY format 'binary' (",
        },
        Bad{"ply\nformat ascii 1.0\nend_header\n", "no vertex element"}, Bad{"ply\nformat ascii 1.0\nfoo\n", "a.ply:3"},
        Bad{"ply\nformat ascii 1.0\nproperty int x\n", "before the first element"},
        Bad{"ply\nformat ascii 1.0\nelement vertex -1\n", "malformed PLY element"},
        Bad{"ply\nformat ascii 1.0\nelement vertex 99999999999999999999999\n", "malformed PLY element"},
        Bad{"ply\nformat ascii 1.0\nelement vertex 1\nproperty long x\n", "unknown PLY property type 'long'"},
        Bad{"ply\nformat ascii 1.0\nelement vertex 1\nproperty list float int x\n", "not an integer"},
        Bad{"ply\nformat ascii 1.0\nelement vertex 1\nproperty float\n", "malformed PLY property"},
        Bad{"ply\nformat ascii 1.0\nelement vertex 0\nproperty int x\nproperty int y\nend_header\n", "no property 'z'"},
        Bad{"ply\nformat ascii 1.0\nelement vertex 0\n" XYZ "property int y\nend_header\n", "'y' is declared twice"},
        Bad{"ply\nformat ascii 1.0\nelement vertex 0\n" XYZ "element vertex 0\nend_header\n",
            "'vertex' is declared twice"},
        Bad{"ply\nformat ascii 1.0\nelement vertex 0\nproperty int x\nproperty int y\nproperty list int int z\n"
            "end_header\n",
            "'z' is a list"}));
INSTANTIATE_TEST_SUITE_P(
    Data, IoPlyBad,
    ::testing::Values(
        Bad{"ply\nformat ascii 1.0\nelement vertex 2\n" XYZ "end_header\n1 2 3\n    \n", "the file ends after row 1"},
        // More rows than bytes: refused before anything is allocated.
        Bad{"ply\nformat ascii 1.0\nelement vertex 4000000000\n" XYZ "end_header\n1 2 3\n", "too short to hold"},
        // 12 times this is 8 modulo 2^64.
        Bad{"ply\nformat binary_little_endian 1.0\nelement vertex 1537228672809129302\n" XYZ "end_header\n12345678",
            "the file ends within element 'vertex'"},
        Bad{"ply\nformat binary_little_endian 1.0\nelement vertex 18446744073709551615\n" XYZ "end_header\n1234",
            "the file ends within element 'vertex'"},
        Bad{"ply\nformat ascii 1.0\nelement vertex 1\n" XYZ "end_header\n1 2\n\n", "a.ply:8"},
        Bad{"ply\nformat ascii 1.0\nelement vertex 1\n" XYZ "end_header\n1 2 3 4\n", "more values"},
        Bad{"ply\nformat ascii 1.0\nelement vertex 1\n" XYZ "end_header\n1 2 3\n4 5 6\n", "a.ply:9"},
        Bad{"ply\nformat ascii 1.0\nelement vertex 1\n" XYZ "end_header\n1 zwei 3\n", "'zwei' is no value"},
        Bad{"ply\nformat ascii 1.0\nelement vertex 1\n" XYZ "property uchar red\nend_header\n1 2 3 256\n",
            "'256' is no value of property 'red'"},
        Bad{"ply\nformat ascii 1.0\nelement vertex 1\n" XYZ "property list uchar int l\nend_header\n1 2 3 4 5 6\n",
            "the list is longer than its line"},
        Bad{"ply\nformat ascii 1.0\nelement vertex 1\n" XYZ
            "element face 1\nproperty list uchar int vertex_indices\nend_header\n1 2 3\n3 0 0 1\n",
            "a.ply:11"},
        Bad{"ply\nformat ascii 1.0\nelement vertex 1\n" XYZ
            "element face 1\nproperty list uchar int vertex_indices\nend_header\n1 2 3\n3 0 -1 0\n",
            "names a vertex that does not exist"},
        Bad{"ply\nformat binary_little_endian 1.0\nelement vertex 0\n" XYZ
            "element e 1\nproperty list char char l\nend_header\n\xff",
            "negative list length"},
        Bad{"ply\nformat binary_little_endian 1.0\nelement vertex 0\n" XYZ
            "element e 1\nproperty list uint double l\nend_header\n\xff\xff\xff\xff",
            "ends within row 0 of element 'e'"}));

} // namespace
} // namespace eigencrust
