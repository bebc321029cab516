// SPDX-License-Identifier: GPL-3.0-or-later
// Text formats of points: xyz, txt, asc, csv, pts, and the numbers of scans.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <eigencrust/io.h>

#include "support.h"

namespace eigencrust {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class IoPoints : public ::testing::Test {
 protected:
  std::filesystem::path file(std::string_view name, std::string_view text) {
    write_bytes(folder_ / name, text);
    return folder_ / name;
  }
  PointCloud read(std::string_view name, std::string_view text, std::vector<std::string> columns = {}) {
    return read_point_cloud(file(name, text), {std::move(columns)});
  }
  std::string error(std::string_view name, std::string_view text, std::vector<std::string> columns = {}) {
    return error_of([&] { read(name, text, std::move(columns)); });
  }

 private:
  TempDir folder_;
};

std::vector<std::string> described(const PointCloud& cloud) {
  std::vector<std::string> result;
  for (const Attribute& attribute : cloud.attributes) {
    const char* type = attribute.type == ScalarType::uint8     ? " uint8"
                       : attribute.type == ScalarType::int32   ? " int32"
                       : attribute.type == ScalarType::float64 ? " float64"
                                                               : " other";
    result.push_back(attribute.name + type);
  }
  return result;
}

TEST_F(IoPoints, AllSeparatorsCommentsAndBlankLines) {
  const std::vector<Vec3> expected = {{1, 2, 3}, {-4.5, 5e3, .5}};
  EXPECT_EQ(read("a.xyz", "1 2 3\n-4.5 5e3 .5").points, expected);
  EXPECT_EQ(read("a.txt", "# made by hand\n\n  1\t2\t3  \r\n// more\r\n-4.5\t5e3\t.5\r\n").points, expected);
  EXPECT_EQ(read("a.CSV", "1,2,3\n-4.5, 5e3 ,+.5\n").points, expected);
  EXPECT_EQ(read("a.asc", "1;2;3\r-4.5;5e3;.5\r").points, expected);
  EXPECT_EQ(read("a.xyz",
                 "\xEF\xBB\xBF"
                 "1 2 3\n-4.5 5e3 .5\n")
                .points,
            expected);                                                 // byte order mark
  EXPECT_EQ(read("a.csv", "1,2,3,\n-4.5,5e3,.5,\n").points, expected); // a comma too many
  EXPECT_THAT(read("a.xyz", "1 2 3").attributes, IsEmpty());
}

TEST_F(IoPoints, NotANumberAndInfinityAreKept) {
  const PointCloud c = read("a.xyz", "nan NaN NAN\ninf -inf INF\n1e999 -1e999 1e-999\n");
  ASSERT_EQ(c.points.size(), 3u);
  EXPECT_TRUE(std::isnan(c.points[0].x) && std::isnan(c.points[0].y) && std::isnan(c.points[0].z));
  EXPECT_EQ(c.points[1].y, -std::numeric_limits<double>::infinity());
  EXPECT_EQ(c.points[2].x, std::numeric_limits<double>::infinity());
  EXPECT_EQ(c.points[2].z, 0);
}

TEST_F(IoPoints, HeadersNameTheColumns) {
  for (const char* text : {"x y z r g b label\n1 2 3 255 0 9 1.5\n", "# X Y Z r g b label\n1 2 3 255 0 9 1.5\n",
                           "//X Y Z r g b label\n1 2 3 255 0 9 1.5\n",
                           "\"x\",\"y\",\"z\",\"r\",\"g\",\"b\",\"label\"\n1,2,3,255,0,9,1.5\n"}) {
    const PointCloud c = read("a.txt", text);
    EXPECT_THAT(c.points, ElementsAre(Vec3{1, 2, 3}));
    EXPECT_THAT(described(c), ElementsAre("r uint8", "g uint8", "b uint8", "label float64")) << text;
    EXPECT_EQ(attribute_value(c.attributes[0], 0), 255);
  }
  // Coordinates may stand anywhere; 256 is no byte; a comment of other length is no header.
  const PointCloud c = read("a.csv", "# x y z\nred,z,x,y\n256,3,1,2\n");
  EXPECT_THAT(c.points, ElementsAre(Vec3{1, 2, 3}));
  EXPECT_THAT(described(c), ElementsAre("red float64"));
}

TEST_F(IoPoints, ColumnsWithoutAHeader) {
  EXPECT_THAT(described(read("a.xyz", "1 2 3 4 5\n")), ElementsAre("column4 float64", "column5 float64"));
  // The options count more than the header, "-" skips what is no number, and the rest keeps its place.
  const PointCloud c = read("a.txt", "id y x h w q\nP1 2 1 3 7 8\n", {"-", "y", "x", "z", "w"});
  EXPECT_THAT(c.points, ElementsAre(Vec3{1, 2, 3}));
  EXPECT_THAT(described(c), ElementsAre("w float64", "column6 float64"));
  // Words in a skipped column make no header of the first row.
  EXPECT_EQ(read("a.txt", "P1 1 2 3\nP2 4 5 6\n", {"-", "x", "y", "z"}).points.size(), 2u);
  // An empty field of a table is an unknown value.
  const PointCloud gaps = read("a.csv", "x,y,z,p,q\n1,2,3,,5\n1,2,3,4,\n");
  EXPECT_TRUE(std::isnan(attribute_value(gaps.attributes[0], 0)));
  EXPECT_TRUE(std::isnan(attribute_value(gaps.attributes[1], 1)));
}

TEST_F(IoPoints, BadRowsAreNamed) {
  EXPECT_THAT(error("a.xyz", "1 2 3\n\n1 2\n"), HasSubstr("a.xyz:3"));
  EXPECT_THAT(error("a.xyz", "1 2 3\n1 2 3 4\n"), HasSubstr("4 fields where 3 are expected"));
  EXPECT_THAT(error("a.xyz", "1 2 3\n1 x 3\n"), HasSubstr("'x' in column 2 (y) is no number ("));
  EXPECT_THAT(error("a.xyz", "1 2\n"), HasSubstr("a.xyz:1"));
  EXPECT_THAT(error("a.csv", "1,,3\n"), HasSubstr("column 2"));
  EXPECT_THAT(error("a.xyz", "1 2 0x3\n"), HasSubstr("'0x3'"));
  EXPECT_THAT(error("a.xyz", "1 2 3abc\n"), HasSubstr("'3abc'"));
  EXPECT_THAT(error("a.xyz", "# nothing\n"), HasSubstr("holds no points"));
  EXPECT_THAT(error("a.xyz", ""), HasSubstr("holds no points"));
  EXPECT_THAT(error("a.csv", "lon,lat,h\n1,2,3\n"), HasSubstr("a.csv:1"));
  EXPECT_THAT(error("a.txt", "1 2 3\n", {"x", "y"}), HasSubstr("no column is named 'z'"));
  EXPECT_THAT(error("a.txt", "1 2 3 4\n", {"x", "y", "z", "x"}), HasSubstr("more than one column is named 'x'"));
  EXPECT_THAT(error("a.txt", "1 2\n", {"x", "y", "z"}), HasSubstr("2 fields where 3"));
}

// "1,5 2,5 3,5" would pass for six columns.
TEST_F(IoPoints, DecimalCommasAreNotMistakenForSeparators) {
  const std::vector<Vec3> expected = {{1.5, 2.5, -3.5}, {4, 5.25, 6e2}};
  for (const char* text : {"1,5 2,5 -3,5\n4 5,25 6,0e2\n", "1,5;2,5;-3,5\n4;5,25;6,0e2\n",
                           "1,5\t2,5\t-3,5\n4\t5,25\t6,0e2\n", "x;y;z\r\n1,5;2,5;-3,5\r\n4;5,25;6,0e2\r\n"})
    EXPECT_EQ(read("a.txt", text).points, expected) << text;
  EXPECT_THAT(read("a.txt", "1, 2, 3\n1 ,2 ,3\n").points, ElementsAre(Vec3{1, 2, 3}, Vec3{1, 2, 3}));
  // Points and commas in one file: neither reading is sure.
  EXPECT_THAT(error("a.txt", "1,5 2,5 3,5\n1.5 2,5 3\n"), HasSubstr("a.txt:"));
  EXPECT_THAT(error("a.pts", "1\n1,5 2,5 3,5\n"), HasSubstr("decimals"));
}

TEST_F(IoPoints, PtsWithIntensityAndColour) {
  const PointCloud c = read("a.pts", "2\r\n1 2 3 -1613 52 70 64\r\n4 5 6 17 0 255 1\r\n");
  EXPECT_THAT(c.points, ElementsAre(Vec3{1, 2, 3}, Vec3{4, 5, 6}));
  EXPECT_THAT(described(c), ElementsAre("intensity int32", "red uint8", "green uint8", "blue uint8"));
  EXPECT_EQ(attribute_value(c.attributes[0], 0), -1613);
  EXPECT_THAT(c.scan_index, IsEmpty());
  EXPECT_THAT(described(read("a.pts", "1\n1 2 3 0.5\n")), ElementsAre("intensity float64"));
  EXPECT_THAT(described(read("a.pts", "1\n1 2 3 4 5 6\n")), ElementsAre("red uint8", "green uint8", "blue uint8"));
  EXPECT_THAT(described(read("a.pts", "1\n1 2 3 4\n", {"x", "y", "z", "range"})), ElementsAre("range float64"));
  EXPECT_THAT(read("a.pts", "0\n").points, IsEmpty());
}

TEST_F(IoPoints, PtsBlocksAreScans) {
  const PointCloud c = read("a.pts", "1\n1 2 3\n2\n4 5 6 7 8 9 10\n4 5 6 7 8 9 10\n0\n1\n0 0 0 5\n");
  EXPECT_THAT(c.scan_index, ElementsAre(0, 1, 1, 3));
  // What a block lacks is 0 in columns of integers.
  EXPECT_THAT(described(c), ElementsAre("intensity int32", "red uint8", "green uint8", "blue uint8"));
  EXPECT_EQ(attribute_value(c.attributes[0], 0), 0);
  EXPECT_EQ(attribute_value(c.attributes[0], 3), 5);
  EXPECT_EQ(attribute_value(c.attributes[1], 3), 0);
}

TEST_F(IoPoints, PtsWithWrongCounts) {
  EXPECT_THAT(error("a.pts", "3\n1 2 3\n4 5 6\n"), HasSubstr("but only 2 follow"));
  EXPECT_THAT(error("a.pts", "3\n1 2 3\n1\n4 5 6\n"), HasSubstr("a.pts:3"));
  EXPECT_THAT(error("a.pts", "1\n1 2 3\n4 5 6\n"), HasSubstr("too small"));
  EXPECT_THAT(error("a.pts", "18446744073709551615\n1 2 3\n"), HasSubstr("but only 1 follow"));
  EXPECT_THAT(error("a.pts", "1\n1 2\n"), HasSubstr("2 fields"));
  // Else one row of a thousand columns would give a thousand to every row of the other blocks.
  EXPECT_THAT(error("a.pts", "1\n1 2 3 4 5\n1\n1 2 3\n"), HasSubstr("a.pts:4"));
  EXPECT_THAT(error("a.pts", "2\n1 2 3\n1 2 3 4\n"), HasSubstr("a.pts:3"));
}

TEST_F(IoPoints, PtsWithoutCount) {
  EXPECT_THAT(read("a.pts", " 0 0 0 \n1 2 3 \n").points, ElementsAre(Vec3{0, 0, 0}, Vec3{1, 2, 3}));
  EXPECT_THAT(read("a.pts", "# Hoppe\nd 1 1 1\ns 1 1 1\ng 1 0 0\np 1 2 3\np 4 5 6\n").points,
              ElementsAre(Vec3{1, 2, 3}, Vec3{4, 5, 6}));
}

TEST_F(IoPoints, ContentDecidesWhereTheExtensionSaysNothing) {
  EXPECT_EQ(read("points", "1 2 3\n").points.size(), 1u);
  EXPECT_EQ(read("a.dat", "x,y,z\n1,2,3\n").points.size(), 1u);
  EXPECT_EQ(read("a.dat", "1\n1 2 3\n").points.size(), 1u);
  EXPECT_EQ(read("a.dat", "# me\nv 1 2 3\n").points.size(), 1u);
  EXPECT_EQ(read("a.dat", "OFF\n1 0 0\n1 2 3\n").points.size(), 1u);
  EXPECT_EQ(read("a.dat",
                 "ply\nformat ascii 1.0\nelement vertex 1\nproperty int x\nproperty int y\nproperty int z\n"
                 "end_header\n1 2 3\n")
                .points.size(),
            1u);
  EXPECT_THAT(read("a.dat", "solid\nendsolid\n").points, IsEmpty());
  EXPECT_THAT(error("a.gltf", "{ \"asset\": {}}"), HasSubstr("this is a glTF model in several files"));
  EXPECT_THAT(error("a.abc", "abcd\x01\x02"), HasSubstr("format is not known"));
  EXPECT_THAT(error("a.e57", ""), HasSubstr("no E57 signature"));
  EXPECT_THAT(error("a.dat", std::string(200, '\0')), HasSubstr("format is not known"));
}

TEST_F(IoPoints, SignaturesCountForMoreThanTheExtension) {
  EXPECT_EQ(read("a.txt", "OFF\n1 0 0\n1 2 3\n").points.size(), 1u);
  EXPECT_EQ(read("a.xyz", "FIELDS x y z\nPOINTS 1\nDATA ascii\n1 2 3\n").points.size(), 1u);
  EXPECT_THAT(error("a.ply", "ASTM-E57"), HasSubstr("within the E57 header"));
  // Rows of numbers are what the extension says.
  EXPECT_THAT(error("a.pcd", "1 2 3\n"), HasSubstr("no keyword of a PCD header"));
}

TEST_F(IoPoints, MissingFilesAndFolders) {
  const TempDir folder;
  EXPECT_THAT(error_of([&] { read_point_cloud(folder / "none.ply"); }), HasSubstr("No such file"));
  EXPECT_THAT(error_of([&] { read_point_cloud(folder.path()); }), HasSubstr("folder"));
  EXPECT_THAT(error_of([&] { read_mesh(file("a.xyz", "1 2 3\n")); }), HasSubstr("points, not a mesh"));
}

TEST_F(IoPoints, ScanIndex) {
  EXPECT_THAT(read_scan_index(file("a.u8", std::string_view("\x00\x01\xff", 3)), 3), ElementsAre(0, 1, 255));
  EXPECT_THAT(read_scan_index(file("a.txt", "# scan\n0\n70000\n\n4294967295"), 3), ElementsAre(0, 70000, 4294967295));
  EXPECT_THAT(error_of([&] { read_scan_index(file("a.u8", "ab"), 3); }), HasSubstr("2 scan numbers for 3 points"));
  EXPECT_THAT(error_of([&] { read_scan_index(file("a.txt", "1\n-1\n"), 2); }), HasSubstr("a.txt:2"));
  EXPECT_THAT(error_of([&] { read_scan_index(file("a.txt", "4294967296\n"), 1); }), HasSubstr("no scan number"));
}

} // namespace
} // namespace eigencrust
