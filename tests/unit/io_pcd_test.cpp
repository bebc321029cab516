// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include <eigencrust/io.h>

#include "e57_bytes.h"
#include "io/lzf.h"
#include "support.h"

namespace eigencrust {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::string header(const std::string& points, const std::string& data, const std::string& viewpoint = "") {
  return "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH " + points +
         "\nHEIGHT 1\n" + (viewpoint.empty() ? "" : "VIEWPOINT " + viewpoint + "\n") + "POINTS " + points + "\nDATA " +
         data + "\n";
}

std::string sized(const std::string& packed, std::uint32_t size) {
  return raw_bytes<std::uint32_t>({static_cast<std::uint32_t>(packed.size()), size}) + packed;
}

class IoPcd : public ::testing::Test {
 protected:
  PointCloud read(const std::string& bytes, PcdViewpoint mode = PcdViewpoint::automatic) {
    notes_ = {};
    write_bytes(folder_ / "a.pcd", bytes);
    return read_point_cloud(folder_ / "a.pcd", {.pcd_viewpoint = mode}, &notes_);
  }
  std::string error(const std::string& bytes) {
    return error_of([&] { read(bytes); });
  }

  TempDir folder_;
  ReadNotes notes_;
};

TEST(IoLzf, LiteralsAndCopies) {
  std::string result;
  std::size_t bad = 0;
  EXPECT_TRUE(io::lzf_unpack(std::string("\2abc", 4), 3, result, bad));
  EXPECT_EQ(result, "abc");
  // a, then 7 + 0 + 2 bytes from 1 back, which overlap what they make.
  EXPECT_TRUE(io::lzf_unpack(std::string("\0a\xe0\0\0", 5), 10, result, bad));
  EXPECT_EQ(result, "aaaaaaaaaa");
  // abcd, then 1 + 2 bytes from 3 back.
  EXPECT_TRUE(io::lzf_unpack(std::string("\3abcd\x20\2", 7), 7, result, bad));
  EXPECT_EQ(result, "abcdbcd");
  EXPECT_TRUE(io::lzf_unpack("", 0, result, bad));
  // 300 bytes, then 3 from 259 back: the distance takes bits of both bytes.
  std::string far, plain;
  for (int run = 0; run < 10; ++run) {
    far += '\x1d'; // 30 literals
    for (int i = 0; i < 30; ++i) far += static_cast<char>('A' + (7 * run + i) % 60), plain += far.back();
  }
  far += std::string("\x21\2", 2);
  EXPECT_TRUE(io::lzf_unpack(far, 303, result, bad));
  EXPECT_EQ(result, plain + plain.substr(300 - 259, 3));
}

TEST(IoLzf, DamageIsFound) {
  std::string result;
  std::size_t bad = 0;
  EXPECT_FALSE(io::lzf_unpack(std::string("\0a\x20\1", 4), 4, result, bad)) << "from before the beginning";
  EXPECT_EQ(bad, 2u);
  EXPECT_FALSE(io::lzf_unpack("\5ab", 6, result, bad)) << "literals cut off";
  EXPECT_FALSE(io::lzf_unpack(std::string("\0a\xe0", 3), 10, result, bad)) << "length cut off";
  EXPECT_FALSE(io::lzf_unpack(std::string("\0a\x20", 3), 4, result, bad)) << "distance cut off";
  EXPECT_FALSE(io::lzf_unpack(std::string("\0a\xe0\0\0", 5), 9, result, bad)) << "too much";
  EXPECT_FALSE(io::lzf_unpack(std::string("\0a\xe0\0\0", 5), 11, result, bad)) << "too little";
  EXPECT_FALSE(io::lzf_unpack(std::string("\0a", 2), 1u << 31, result, bad)) << "nothing is that dense";
  EXPECT_LT(result.capacity(), 1u << 20);
}

TEST_F(IoPcd, TheThreeEncodings) {
  const std::vector<Vec3> points = {{1, 2, 3}, {-0.5, 0.25, 8}};
  EXPECT_EQ(read(header("2", "ascii") + "1 2 3\n-0.5 0.25 8\n").points, points);
  EXPECT_EQ(read(header("2", "binary") + raw_bytes<float>({1, 2, 3, -0.5f, 0.25f, 8})).points, points);
  // Compressed: first all x, then all y, then all z. 23: 24 literals.
  const std::string packed = std::string("\x17") + raw_bytes<float>({1, -0.5f, 2, 0.25f, 3, 8});
  EXPECT_EQ(read(header("2", "binary_compressed") + sized(packed, 24)).points, points);
  EXPECT_THAT(read(header("0", "binary_compressed")).points, IsEmpty());
}

TEST_F(IoPcd, TextKeepsTheDigitsOfCoordinates) {
  // SIZE 4 would round 4320978.61 to 4320978.5.
  EXPECT_THAT(read(header("2", "ascii") + "289814.15,4320978.61,170.76\nnan NaN inf\n").points[0],
              (Vec3{289814.15, 4320978.61, 170.76}));
  EXPECT_TRUE(std::isnan(read(header("1", "ascii") + "nan 1 2\n").points[0].x));
}

TEST_F(IoPcd, FieldsOfAllTypes) {
  const std::string head =
      "VERSION .7\nFIELDS label _ x y z normal_x big rgb hist t\nSIZE 2 1 8 4 2 4 8 4 1 8\nTYPE U U F F I F U F I I\n"
      "COUNT 1 3 1 1 1 1 1 1 2 1\nPOINTS 2\nDATA binary\n";
  std::string rows;
  for (const int k : {1, 2})
    rows += raw_bytes<std::uint16_t>({static_cast<std::uint16_t>(60000 + k)}) + "pad" + raw_bytes<double>({0.1 * k}) +
            raw_bytes<float>({0.5f}) + raw_bytes<std::int16_t>({-3}) + raw_bytes<float>({0.25f}) +
            raw_bytes<std::uint64_t>({1ull << 63}) + std::string("\3\2\1\0", 4) + std::string("\x80\x7f") +
            raw_bytes<std::int64_t>({-5});
  const PointCloud cloud = read(head + rows);
  EXPECT_THAT(cloud.points, ElementsAre(Vec3{0.1, 0.5, -3}, Vec3{0.2, 0.5, -3}));
  std::string names;
  for (const Attribute& a : cloud.attributes) names += a.name + " ";
  EXPECT_EQ(names, "label nx big red green blue hist t ");
  const auto value = [&](const char* name, std::size_t i) {
    return attribute_value(*find_attribute(cloud.attributes, name), i);
  };
  EXPECT_EQ(value("label", 1), 60002);
  EXPECT_EQ(value("nx", 1), 0.25);
  EXPECT_EQ(value("big", 1), 0x1p63);
  EXPECT_EQ(value("red", 1), 1); // 0x00rrggbb, little-endian
  EXPECT_EQ(value("green", 0), 2);
  EXPECT_EQ(value("blue", 0), 3);
  EXPECT_EQ(value("t", 1), -5);
  const Attribute& hist = *find_attribute(cloud.attributes, "hist");
  EXPECT_TRUE(hist.is_list);
  EXPECT_THAT(hist.offsets, ElementsAre(0, 2, 4));
  EXPECT_EQ(attribute_value(hist, 2), -128);
  EXPECT_EQ(attribute_value(hist, 3), 127);
}

// 0x404070 as it is printed by different programs: a whole number, a rounded real, the real with these bits.
TEST_F(IoPcd, PackedColoursInText) {
  const auto colour = [&](const std::string& text, const char* name) {
    const PointCloud cloud = read("FIELDS x y z rgb\nSIZE 4 4 4 4\nTYPE F F F F\nPOINTS 1\nDATA ascii\n0 0 0 " + text);
    return attribute_value(*find_attribute(cloud.attributes, name), 0);
  };
  EXPECT_EQ(colour("4210800", "red"), 0x40);
  EXPECT_EQ(colour("4210800", "blue"), 0x70);
  EXPECT_EQ(colour("4.2108e+06", "green"), 0x40);
  EXPECT_EQ(colour("5.9005875e-39", "red"), 0x40); // 4210800 x 2^-149
  EXPECT_EQ(colour("5.9005875e-39", "blue"), 0x70);
  // With alpha 255 the number exceeds 2^31.
  const PointCloud cloud =
      read("FIELDS x y z rgba\nSIZE 4 4 4 4\nTYPE F F F U\nPOINTS 1\nDATA ascii\n0 0 0 4282400896\n");
  EXPECT_EQ(attribute_value(*find_attribute(cloud.attributes, "alpha"), 0), 255);
  EXPECT_EQ(attribute_value(*find_attribute(cloud.attributes, "red"), 0), 0x40);
}

// A quarter turn about z (quaternion of length sqrt 2) and a shift.
TEST_F(IoPcd, ViewpointModes) {
  const std::string bytes =
      "FIELDS x y z normal_x normal_y normal_z\nSIZE 4 4 4 4 4 4\nTYPE F F F F F F\n"
      "VIEWPOINT 10 20 30 1 0 0 1\nPOINTS 1\nDATA ascii\n1 2 3 1 0 0\n";
  for (const PcdViewpoint mode : {PcdViewpoint::automatic, PcdViewpoint::sensor}) {
    const PointCloud cloud = read(bytes, mode);
    EXPECT_THAT(cloud.points, ElementsAre(Vec3{1, 2, 3}));
    EXPECT_THAT(cloud.sensors, ElementsAre(Sensor{{10, 20, 30}, false}));
    EXPECT_THAT(cloud.sensor_of, ElementsAre(0));
    EXPECT_THAT(notes_.notes,
                ElementsAre("VIEWPOINT (10, 20, 30) read as the sensor's position: the points were not moved"));
  }
  const PointCloud moved = read(bytes, PcdViewpoint::pose);
  EXPECT_LT(distance(moved.points[0], {8, 21, 33}), 1e-12);
  EXPECT_EQ(moved.sensors[0].place, (Vec3{10, 20, 30}));
  EXPECT_NEAR(attribute_value(*find_attribute(moved.attributes, "ny"), 0), 1, 1e-7);
  EXPECT_THAT(notes_.notes, ElementsAre(HasSubstr("read as the scan's pose")));
  EXPECT_THAT(read(bytes, PcdViewpoint::none).sensors, IsEmpty());
  EXPECT_THAT(notes_.notes, ElementsAre(HasSubstr("not used")));
}

TEST_F(IoPcd, ViewpointAtTheOrigin) {
  const std::string bytes = header("1", "ascii", "0 0 0 1 0 0 0") + "1 2 3\n";
  EXPECT_THAT(read(bytes).sensors, IsEmpty());
  EXPECT_THAT(notes_.notes, ElementsAre("VIEWPOINT (0, 0, 0) read as not known"));
  EXPECT_THAT(read(bytes, PcdViewpoint::sensor).sensors, ElementsAre(Sensor{}));
  EXPECT_THAT(read(bytes, PcdViewpoint::pose).sensors, ElementsAre(Sensor{}));
  EXPECT_THAT(read(header("1", "ascii") + "1 2 3\n", PcdViewpoint::sensor).sensors, IsEmpty());
}

TEST_F(IoPcd, KnownByItsContent) {
  write_bytes(folder_ / "a.txt", header("1", "ascii") + "1 2 3\n");
  EXPECT_EQ(read_point_cloud(folder_ / "a.txt").points.size(), 1u);
}

TEST_F(IoPcd, MistakesInTheHeader) {
  EXPECT_THAT(error("1 2 3\n4 5 6\n"), HasSubstr("'1' is no keyword of a PCD header"));
  EXPECT_THAT(error(""), HasSubstr("before the line DATA"));
  EXPECT_THAT(error("FIELDS x y z\nSIZE 4 4\n"), HasSubstr("a.pcd:2"));
  EXPECT_THAT(error("FIELDS x y z\nSIZE 4 4 3\n"), HasSubstr("'3' is no size of a field"));
  EXPECT_THAT(error("FIELDS x y z\nTYPE F F D\n"), HasSubstr("'D' is no type of a field"));
  EXPECT_THAT(error("FIELDS x y z\nCOUNT 1 1 0\n"), HasSubstr("'0' is no count of a field"));
  EXPECT_THAT(error("FIELDS x y z\nSIZE 4 4 2\nPOINTS 0\nDATA ascii\n"), HasSubstr("floating-point number of 2 bytes"));
  EXPECT_THAT(error("FIELDS x y z\nWIDTH 3\nHEIGHT 2\nPOINTS 7\nDATA ascii\n"), HasSubstr("WIDTH x HEIGHT is 6"));
  EXPECT_THAT(error("FIELDS x y z\nWIDTH 10000000000\nHEIGHT 10000000000\nDATA ascii\n"), HasSubstr("too large"));
  EXPECT_THAT(error("FIELDS x y z\nDATA ascii\n"), HasSubstr("neither POINTS nor WIDTH"));
  EXPECT_THAT(error("FIELDS x y z\nPOINTS 0\nDATA zip\n"), HasSubstr("DATA is not"));
  EXPECT_THAT(error("FIELDS x y z\nVIEWPOINT 0 0 nan 1 0 0 0\n"), HasSubstr("seven finite numbers"));
  EXPECT_THAT(error("FIELDS x y\nPOINTS 0\nDATA ascii\n"), HasSubstr("no field is named z"));
  EXPECT_THAT(error("FIELDS x y z Z\nPOINTS 0\nDATA ascii\n"), HasSubstr("more than one field is named z"));
  EXPECT_THAT(error("FIELDS x y z\nCOUNT 2 1 1\nPOINTS 0\nDATA ascii\n"), HasSubstr("more than one value"));
}

TEST_F(IoPcd, MistakesInTheData) {
  EXPECT_THAT(error(header("2", "ascii") + "1 2 3\n"), HasSubstr("too short for the 2 points"));
  EXPECT_THAT(error(header("2", "ascii") + "1.00000 2 3\n"), HasSubstr("only 1 follow"));
  EXPECT_THAT(error(header("1", "ascii") + "1 2 3\n4 5 6\n"), HasSubstr("more rows than"));
  EXPECT_THAT(error(header("1", "ascii") + "1 2 3 4\n"), HasSubstr("a.pcd:11"));
  EXPECT_THAT(error(header("1", "ascii") + "1 2 x\n"), HasSubstr("'x' is no value of field 'z'"));
  EXPECT_THAT(error("FIELDS x y z c\nSIZE 4 4 4 1\nTYPE F F F U\nPOINTS 1\nDATA ascii\n1 2 3 256\n"),
              HasSubstr("'256' is no value of field 'c'"));
  EXPECT_THAT(error(header("1000000000000", "ascii") + "1 2 3\n"), HasSubstr("too short"));
  EXPECT_THAT(error(header("1000000000000", "binary") + "1 2 3\n"), HasSubstr("but the file ends at byte"));
  EXPECT_THAT(error(header("2", "binary") + std::string(23, '\0')), HasSubstr("promises 2 points of 12 bytes"));
  const std::string packed = std::string("\x17") + std::string(24, '\0');
  EXPECT_THAT(error(header("2", "binary_compressed") + sized(packed, 24).substr(0, 30)), HasSubstr("the file ends"));
  EXPECT_THAT(error(header("2", "binary_compressed") + "abc"), HasSubstr("the file ends before"));
  EXPECT_THAT(error(header("3", "binary_compressed") + sized(packed, 24)), HasSubstr("do not make 3 points"));
  EXPECT_THAT(error(header("3", "binary_compressed") + sized(packed, 36)), HasSubstr("data are damaged at byte"));
  EXPECT_THAT(error(header("100000000", "binary_compressed") + sized(packed, 1200000000)), HasSubstr("damaged"));
}

} // namespace
} // namespace eigencrust
