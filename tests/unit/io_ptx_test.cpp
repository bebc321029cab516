// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <eigencrust/io.h>

#include "support.h"

namespace eigencrust {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

const std::string identity = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n";
// A quarter turn about z and a shift: the row (x y z 1) times the matrix is (10 - y, 20 + x, 30 + z).
const std::string turned = "10 20 30\n0 1 0\n-1 0 0\n0 0 1\n0 1 0 0\n-1 0 0 0\n0 0 1 0\n10 20 30 1\n";

class IoPtx : public ::testing::Test {
 protected:
  PointCloud read(const std::string& text, const char* name = "a.ptx") {
    notes_ = {};
    write_bytes(folder_ / name, text);
    return read_point_cloud(folder_ / name, {}, &notes_);
  }
  std::string error(const std::string& text) {
    return error_of([&] { read(text); });
  }

  TempDir folder_;
  ReadNotes notes_;
};

TEST_F(IoPtx, SeveralScansWithTheirMatrices) {
  const PointCloud cloud = read("2\n1\n" + identity + "1 2 3 0.5\n4 5 6 0.25\n" + "1\n2\n" + turned +
                                "1 2 3 0.5 255 0 7\n0 0 0 0.5 0 0 0\n");
  EXPECT_THAT(cloud.points, ElementsAre(Vec3{1, 2, 3}, Vec3{4, 5, 6}, Vec3{8, 21, 33}));
  EXPECT_THAT(cloud.scan_index, ElementsAre(0, 0, 1));
  EXPECT_THAT(cloud.sensors, ElementsAre(Sensor{{0, 0, 0}, false}, Sensor{{10, 20, 30}, false}));
  EXPECT_THAT(cloud.sensor_of, ElementsAre(0, 0, 1));
  EXPECT_THAT(notes_.notes, ElementsAre(HasSubstr("1 empty return (0 0 0) left out")));
  const Attribute* red = find_attribute(cloud.attributes, "red");
  ASSERT_NE(red, nullptr);
  EXPECT_EQ(red->type, ScalarType::uint8);
  EXPECT_EQ(attribute_value(*red, 2), 255);
  EXPECT_EQ(attribute_value(*find_attribute(cloud.attributes, "intensity"), 1), 0.25);
}

// Its two counts once made it a PTS file with no point in the first block.
TEST_F(IoPtx, KnownByItsContent) {
  const std::string text = "2\n1\n" + identity + "1 2 3 0.5\n4 5 6 0.25\n";
  for (const char* name : {"a", "a.pts", "a.txt"}) {
    const PointCloud cloud = read(text, name);
    EXPECT_EQ(cloud.points.size(), 2u) << name;
    EXPECT_EQ(cloud.sensors.size(), 1u) << name;
  }
  // A PTS file stays one.
  EXPECT_EQ(read("1\n1 2 3\n1\n4 5 6\n", "b").scan_index.size(), 2u);
}

TEST_F(IoPtx, FarFromTheOriginWithoutTransformation) {
  const PointCloud cloud = read("2\n1\n" + identity + "637012.24 849028.31 431.66 0\n636896.33 849087.7 446.39 0\n");
  EXPECT_TRUE(cloud.sensors.empty());
  EXPECT_TRUE(cloud.sensor_of.empty());
  EXPECT_THAT(notes_.notes, ElementsAre(HasSubstr("taken as unknown")));
}

TEST_F(IoPtx, PositionAndMatrixDiffer) {
  std::string header = turned;
  header.replace(0, 8, "11 20 30");
  EXPECT_THAT(read("1\n1\n" + header + "1 2 3 0\n").sensors, ElementsAre(Sensor{{10, 20, 30}, false}));
  EXPECT_THAT(notes_.notes, ElementsAre(HasSubstr("differs from the translation")));
}

TEST_F(IoPtx, EmptyScansAndLineEnds) {
  EXPECT_EQ(read("0\n5\n" + identity + "1\n1\n" + identity + "1 2 3 0\n").points.size(), 1u);
  std::string windows;
  for (const char c : "1\n1\n" + identity + "1 2 3 0\n\n")
    windows += c == '\n' ? std::string("\r\n") : std::string(1, c);
  EXPECT_EQ(read(windows).points.size(), 1u);
  EXPECT_TRUE(read("1\n1\n" + identity + "0 0 0 0\n").points.empty());
}

TEST_F(IoPtx, MistakesAreNamedWithTheirLine) {
  EXPECT_THAT(error(""), HasSubstr("holds no scan"));
  EXPECT_THAT(error("x\n"), HasSubstr("'x' where the number of columns of a scan is expected"));
  EXPECT_THAT(error("1\n-1\n"), HasSubstr("a.ptx:2"));
  EXPECT_THAT(error("1\n1\n1 2\n"), HasSubstr("where the position of a scan is expected"));
  EXPECT_THAT(error("1\n1\n" + identity), HasSubstr("only 0 follow"));
  EXPECT_THAT(error("4000000000\n4000000000\n" + identity + "1 2 3 4\n"), HasSubstr("only 1 follow"));
  EXPECT_THAT(error("10000000000\n10000000000\n" + identity + "1 2 3 4\n"), HasSubstr("too many columns and rows"));
  EXPECT_THAT(error("2\n1\n" + identity + "1 2 3 4\n1\n1\n"), HasSubstr("a.ptx:12"));
  EXPECT_THAT(error("1\n1\n" + identity + "1 2 3 4\n5 6 7 8\n"), HasSubstr("a.ptx:12"));
  EXPECT_THAT(error("1\n1\n" + identity + "1 2 3 4 5\n"), HasSubstr("the row has 5 fields"));
  EXPECT_THAT(error("1\n1\n" + identity + "1 2 x 4\n"), HasSubstr("'x' in column 3"));
  // Column vectors: the translation stands in the last column.
  std::string header = identity;
  header.replace(header.find("1 0 0 0\n"), 7, "1 0 0 5");
  EXPECT_THAT(error("1\n1\n" + header + "1 2 3 4\n"), HasSubstr("last column of the matrix"));
}

} // namespace
} // namespace eigencrust
