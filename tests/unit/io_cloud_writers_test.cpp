// SPDX-License-Identifier: GPL-3.0-or-later
// PCD, LAS and OBJ clouds, read back by the readers of these formats.
#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include <eigencrust/io.h>

#include "support.h"

namespace eigencrust {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

Attribute column(std::string name, ScalarType type, std::vector<double> values) {
  return make_attribute(std::move(name), type, values);
}

WriteOptions with_spacing(double spacing) {
  WriteOptions options;
  options.spacing = spacing;
  return options;
}

WriteOptions as_format(const std::string& format) {
  WriteOptions options;
  options.format = format;
  return options;
}

/// Four points far from the origin, a column of every type.
PointCloud some_cloud() {
  PointCloud cloud;
  cloud.points = {{4320000.25, 5, -1}, {4320001.5, 6.125, 0}, {4320002, 7, 1.0625}, {4320003, 5.5, 2}};
  int number = 0;
  for (const ScalarType type : {ScalarType::int8, ScalarType::uint8, ScalarType::int16, ScalarType::uint16,
                                ScalarType::int32, ScalarType::uint32, ScalarType::float32, ScalarType::float64})
    cloud.attributes.push_back(column(std::string("a") + std::to_string(number++), type, {-1e12, 1e12, 0.1, 1}));
  return cloud;
}

const Attribute& named(const PointCloud& cloud, const std::string& name) {
  const Attribute* found = find_attribute(cloud.attributes, name);
  if (found == nullptr) throw std::runtime_error("no attribute " + name);
  return *found;
}

std::vector<double> values_of(const Attribute& attribute) {
  std::vector<double> values;
  for (std::size_t i = 0; i < attribute.rows(); ++i) values.push_back(attribute_value(attribute, i));
  return values;
}

TEST(WriteClouds, PcdAndLasKeepEveryTypeAndPlace) {
  const TempDir folder;
  const PointCloud cloud = some_cloud();
  for (const char* name : {"a.pcd", "a.las"}) {
    const WriteResult result = write_point_cloud(folder / name, cloud, with_spacing(1));
    EXPECT_THAT(result.warnings, IsEmpty()) << name;
    const PointCloud back = read_point_cloud(folder / name);
    ASSERT_EQ(back.points.size(), 4u) << name;
    for (std::size_t i = 0; i < 4; ++i) EXPECT_LE(distance(back.points[i], cloud.points[i]), 1e-3) << name;
    for (const Attribute& a : cloud.attributes) {
      EXPECT_EQ(named(back, a.name).type, a.type) << name << " " << a.name;
      EXPECT_EQ(named(back, a.name).values, a.values) << name << " " << a.name;
    }
  }
}

TEST(WriteClouds, PcdPacksBytesOfColourAndNamesNormals) {
  const TempDir folder;
  PointCloud cloud;
  cloud.points = {{0, 0, 0}, {1, 0, 0}, {std::nan(""), 1, 0}};
  cloud.attributes = {column("red", ScalarType::uint8, {1, 2, 255}), column("green", ScalarType::uint8, {4, 5, 6}),
                      column("blue", ScalarType::uint8, {7, 8, 9}), column("nx", ScalarType::float32, {0.5, 0, 1})};
  cloud.sensors = {{{1, 2, 3.5}, false}};
  cloud.sensor_of = {0, 0, 0};
  EXPECT_THAT(write_point_cloud(folder / "a.pcd", cloud).warnings, IsEmpty());
  EXPECT_THAT(read_bytes(folder / "a.pcd"), HasSubstr("FIELDS x y z rgb normal_x\nSIZE 4 4 4 4 4\nTYPE F F F F F\n"));
  const PointCloud back = read_point_cloud(folder / "a.pcd");
  EXPECT_TRUE(std::isnan(back.points[2].x));
  EXPECT_THAT(values_of(named(back, "red")), ElementsAre(1, 2, 255));
  EXPECT_THAT(values_of(named(back, "blue")), ElementsAre(7, 8, 9));
  EXPECT_THAT(values_of(named(back, "nx")), ElementsAre(0.5, 0, 1));
  ASSERT_EQ(back.sensors.size(), 1u);
  EXPECT_EQ(back.sensors[0].place, (Vec3{1, 2, 3.5}));
  // Where the sensor is the origin the file cannot tell it.
  cloud.sensors[0].place = {};
  EXPECT_THAT(write_point_cloud(folder / "a.pcd", cloud).warnings,
              ElementsAre(HasSubstr("sensors of the points are not written")));
}

TEST(WriteClouds, LasPutsWhatFitsIntoItsFields) {
  const TempDir folder;
  PointCloud cloud;
  cloud.points = {{0, 0, 0}, {1, 2, 3}, {-1, -2, -3}};
  cloud.attributes = {column("intensity", ScalarType::uint16, {0, 65535, 7}),
                      column("classification", ScalarType::uint8, {2, 6, 255}),
                      column("return_number", ScalarType::uint8, {1, 2, 3}),
                      column("gps_time", ScalarType::float64, {0.25, -3, 1e9}),
                      column("red", ScalarType::uint8, {255, 0, 128}),
                      column("green", ScalarType::uint8, {0, 0, 0}),
                      column("blue", ScalarType::uint8, {1, 2, 3}),
                      column("user_data", ScalarType::float32, {0.5, 1, 2}), // no byte: stays a column of its own
                      column("confidence", ScalarType::float32, {0.5, 1, 0})};
  EXPECT_THAT(write_point_cloud(folder / "a.las", cloud).warnings, IsEmpty());
  const PointCloud back = read_point_cloud(folder / "a.las");
  EXPECT_THAT(values_of(named(back, "intensity")), ElementsAre(0, 65535, 7));
  EXPECT_EQ(named(back, "intensity").type, ScalarType::uint16);
  EXPECT_THAT(values_of(named(back, "classification")), ElementsAre(2, 6, 255));
  EXPECT_THAT(values_of(named(back, "return_number")), ElementsAre(1, 2, 3));
  EXPECT_THAT(values_of(named(back, "gps_time")), ElementsAre(0.25, -3, 1e9));
  EXPECT_THAT(values_of(named(back, "red")), ElementsAre(65535, 0, 128 * 257));
  EXPECT_THAT(values_of(named(back, "confidence")), ElementsAre(0.5, 1, 0));
  // The counts of returns, from byte 255 on.
  const std::string bytes = read_bytes(folder / "a.las");
  EXPECT_THAT(bytes.substr(255, 24), testing::Eq(std::string("\1\0\0\0\0\0\0\0\1\0\0\0\0\0\0\0\1\0\0\0\0\0\0\0", 24)));
  EXPECT_EQ(bytes.substr(0, 4), "LASF");
  EXPECT_EQ(bytes[104], 7);
}

TEST(WriteClouds, LasLeavesOutWhatIsNotFiniteAndReachesFar) {
  const TempDir folder;
  PointCloud cloud;
  cloud.points = {{0, 0, 0}, {std::numeric_limits<double>::infinity(), 0, 0}, {1e7, 0, 1e-4}};
  const WriteResult result = write_point_cloud(folder / "a.las", cloud, with_spacing(1e-3));
  EXPECT_THAT(result.warnings, testing::Contains(HasSubstr("not finite: 1 row left out")));
  EXPECT_THAT(result.warnings, testing::Contains(HasSubstr("LAS rounds the coordinates to")));
  const PointCloud back = read_point_cloud(folder / "a.las");
  ASSERT_EQ(back.points.size(), 2u);
  EXPECT_NEAR(back.points[1].x, 1e7, 0.1);
  EXPECT_NEAR(back.points[1].z, 1e-4, 1e-6);
}

TEST(WriteClouds, TheSameBytesEachTime) {
  const TempDir folder;
  for (const char* format : {"pcd", "las", "obj"}) {
    write_point_cloud(folder / "a", some_cloud(), as_format(format));
    write_point_cloud(folder / "b", some_cloud(), as_format(format));
    EXPECT_EQ(read_bytes(folder / "a"), read_bytes(folder / "b")) << format;
  }
}

TEST(WriteClouds, ObjHoldsPlacesColoursAndNormals) {
  const TempDir folder;
  PointCloud cloud;
  cloud.points = {{0.1, 0, 0}, {1, 2, 3}};
  for (const char* name : {"red", "green", "blue"})
    cloud.attributes.push_back(column(name, ScalarType::uint8, {255, 0}));
  for (const char* name : {"nx", "ny", "nz"}) cloud.attributes.push_back(column(name, ScalarType::float32, {1, 0.5}));
  cloud.attributes.push_back(column("inlier", ScalarType::uint8, {1, 0}));
  EXPECT_THAT(write_point_cloud(folder / "a.obj", cloud).warnings,
              ElementsAre("OBJ has no room for these attributes of the points: inlier"));
  EXPECT_EQ(read_bytes(folder / "a.obj"), "v 0.1 0 0 1 1 1\nvn 1 1 1\nv 1 2 3 0 0 0\nvn 0.5 0.5 0.5\n");
}

TEST(RequireWritable, LeavesNothingBehind) {
  const TempDir folder;
  EXPECT_NO_THROW(require_writable(folder / "a.ply"));
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  write_bytes(folder / "old.ply", "old");
  EXPECT_NO_THROW(require_writable(folder / "old.ply"));
  EXPECT_EQ(read_bytes(folder / "old.ply"), "old");
  EXPECT_THAT(error_of([&] { require_writable(folder.path()); }), HasSubstr("this is a folder"));
  EXPECT_THAT(error_of([&] { require_writable(folder / "nowhere/a.ply"); }), HasSubstr("cannot create a file"));
  EXPECT_THAT(error_of([&] { require_writable(folder / std::string(300, 'a')); }), HasSubstr("longer than"));
  // A link is followed to where the file would be.
  std::filesystem::create_symlink("nowhere/b.ply", folder / "link.ply");
  EXPECT_THAT(error_of([&] { require_writable(folder / "link.ply"); }), HasSubstr("cannot create a file"));
}

} // namespace
} // namespace eigencrust
