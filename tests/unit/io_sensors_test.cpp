// SPDX-License-Identifier: GPL-3.0-or-later
// Sensors told point by point in columns, or scan by scan in a file of their own.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include <eigencrust/io.h>

#include "support.h"

namespace eigencrust {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class IoSensors : public ::testing::Test {
 protected:
  PointCloud read(const char* name, const std::string& bytes, const ReadOptions& options = {}) {
    notes_ = {};
    write_bytes(folder_ / name, bytes);
    return read_point_cloud(folder_ / name, options, &notes_);
  }
  /// Three points of scans 0, 2 and 2, and what the file says of them.
  PointCloud three(const std::string& text) {
    PointCloud cloud;
    cloud.points.resize(3);
    cloud.scan_index = {0, 2, 2};
    cloud.sensors = {{{5, 5, 5}, false}};
    cloud.sensor_of = {0, 0, 0};
    write_bytes(folder_ / "poses.csv", text);
    read_scan_sensors(folder_ / "poses.csv", cloud);
    return cloud;
  }
  std::string error(const std::string& text) {
    return error_of([&] { three(text); });
  }

  TempDir folder_;
  ReadNotes notes_;
};

TEST_F(IoSensors, ColumnsOfPointClouds) {
  const std::string rows = "0 0 0 1 2 3\n1 0 0 4 5 6\n0 1 0 1 2 3\n0 0 1 nan 2 3\n";
  for (const std::string names : {"sx sy sz", "x_origin y_origin z_origin", "SX SY SZ", "sensor_x sensor_y sensor_z",
                                  "Scanner_X Scanner_Y Scanner_Z", "viewpoint_x viewpoint_y viewpoint_z"}) {
    std::istringstream words(names);
    std::string header =
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
    for (std::string name; words >> name;) header += "property double " + name + "\n";
    const PointCloud cloud = read("a.ply", header + "end_header\n" + rows);
    EXPECT_THAT(cloud.sensors, ElementsAre(Sensor{{1, 2, 3}, false}, Sensor{{4, 5, 6}, false}));
    EXPECT_THAT(cloud.sensor_of, ElementsAre(0, 1, 0, PointCloud::no_sensor));
    EXPECT_EQ(cloud.attributes.size(), 3u); // they stay columns, too
    EXPECT_THAT(notes_.notes, ElementsAre(names + " read as the sensor's position of each point"));
  }
  EXPECT_EQ(read("a.xyz", "# x y z sx sy sz\n" + rows).sensors.size(), 2u);
  EXPECT_EQ(read("a.txt", rows, {.columns = {"x", "y", "z", "sx", "sy", "sz"}}).sensors.size(), 2u);
  EXPECT_THAT(read("a.xyz", "# x y z sx sy sz\n" + rows, {.sensors = false}).sensors, IsEmpty());
  EXPECT_THAT(read("a.xyz", "# x y z sx sy tz\n" + rows).sensors, IsEmpty());
  EXPECT_THAT(read("a.xyz", "# x y z sx sy sz\n0 0 0 nan nan nan\n").sensor_of, IsEmpty());
}

// A VIEWPOINT is not overruled by columns.
TEST_F(IoSensors, WhatTheFormatSaysCountsMore) {
  const std::string pcd =
      "FIELDS x y z vp_x vp_y vp_z\nSIZE 4 4 4 4 4 4\nTYPE F F F F F F\nVIEWPOINT 9 0 0 1 0 0 0\nPOINTS 1\nDATA "
      "ascii\n1 2 3 4 5 6\n";
  EXPECT_THAT(read("a.pcd", pcd).sensors, ElementsAre(Sensor{{9, 0, 0}, false}));
  EXPECT_THAT(read("a.pcd", pcd, {.pcd_viewpoint = PcdViewpoint::none}).sensors, ElementsAre(Sensor{{4, 5, 6}, false}));
}

// Sensors are lost when a cloud is written, unless they are among its columns.
TEST_F(IoSensors, WritingWarnsOnlyOfWhatIsLost) {
  PointCloud cloud = read("a.xyz", "# x y z sx sy sz\n0 0 0 1 2 3\n1 0 0 4 5 6\n");
  const auto warnings = [&] { return write_point_cloud(folder_ / "b.ply", cloud).warnings; };
  EXPECT_THAT(warnings(), IsEmpty());
  append_scan(cloud, read("c.xyz", "# x y z sx sy sz\n0 0 0 1 2 3\n"));
  cloud.scan_index.clear();
  EXPECT_THAT(warnings(), IsEmpty());
  cloud.sensors[1].place.x = 7;
  EXPECT_THAT(warnings(), ElementsAre("the sensors of the points are not written"));
}

TEST_F(IoSensors, PositionsOfScans) {
  for (const char* text : {"2,4,5,6\n0,1,2,3\n", "scan,x,y,z\n0,1,2,3\n2,4,5,6\n", "# scan x y z\n0 1 2 3\n2 4 5 6\n",
                           "# a comment\nz;y;x;scan\n3;2;1;0\n6;5;4;2\n", "1 2 3\n7 7 7\n4 5 6\n",
                           "name,x,y,z\n a,1,2,3\nb,7,7,7\nc,4,5,6\n"}) {
    const PointCloud cloud = three(text);
    const auto place = [&](std::size_t i) { return cloud.sensors[cloud.sensor_of[i]].place; };
    EXPECT_EQ(place(0), (Vec3{1, 2, 3})) << text;
    EXPECT_EQ(place(1), (Vec3{4, 5, 6})) << text;
    EXPECT_EQ(place(2), (Vec3{4, 5, 6})) << text;
    EXPECT_FALSE(cloud.sensors[0].at_infinity);
  }
  EXPECT_THAT(three("0,1,2,3\n").sensor_of, ElementsAre(0, PointCloud::no_sensor, PointCloud::no_sensor));
  PointCloud single;
  single.points.resize(2);
  write_bytes(folder_ / "one.csv", "1e2 -2 3");
  read_scan_sensors(folder_ / "one.csv", single);
  EXPECT_THAT(single.sensors, ElementsAre(Sensor{{100, -2, 3}, false}));
  EXPECT_THAT(single.sensor_of, ElementsAre(0, 0));
}

TEST_F(IoSensors, DirectionsOfScans) {
  for (const char* text : {"scan,dx,dy,dz\n2,0,0,-8\n0,3,0,4\n", "# dx dy dz\n3 0 4\n1 0 0\n0 0 -1e-3\n"}) {
    const PointCloud cloud = three(text);
    const auto sensor = [&](std::size_t i) { return cloud.sensors[cloud.sensor_of[i]]; };
    EXPECT_LT(distance(sensor(0).place, {0.6, 0, 0.8}), 1e-15) << text;
    EXPECT_EQ(sensor(2), (Sensor{{0, 0, -1}, true})) << text;
  }
}

TEST_F(IoSensors, MistakesInTheFile) {
  EXPECT_THAT(error(""), HasSubstr("the file has no row"));
  EXPECT_THAT(error("# scan x y z\n"), HasSubstr("the file has no row"));
  EXPECT_THAT(error("0,1,2,3\n3,1,2,3\n"), HasSubstr("the row is for scan 3, the last one is 2 ("));
  EXPECT_THAT(error("0,1,2,3\n3,1,2,3\n"), HasSubstr("poses.csv:2"));
  EXPECT_THAT(error("0,1,2,3\n0,1,2,3\n"), HasSubstr("a second row for scan 0"));
  EXPECT_THAT(error("1,2,3\n4,5,6\n"), HasSubstr("2 rows without scan numbers for 3 scans"));
  EXPECT_THAT(error("1,2,3\n1,2,3\n1,2,3\n1,2,3\n"), HasSubstr("the row is for scan 3"));
  EXPECT_THAT(error("0,1,2\n0,1,2,3\n"), HasSubstr("the row has 4 fields where 3 are expected"));
  EXPECT_THAT(error("0,1,2,3,4\n"), HasSubstr("the row has 5 fields and no header names them"));
  EXPECT_THAT(error("0,1,nan,3\n"), HasSubstr("'nan' is no finite number"));
  EXPECT_THAT(error("0,1,x,3\n"), HasSubstr("'x' is no finite number"));
  EXPECT_THAT(error("0.5,1,2,3\n"), HasSubstr("'0.5' is no scan number"));
  EXPECT_THAT(error("-1,1,2,3\n"), HasSubstr("'-1' is no scan number"));
  EXPECT_THAT(error("scan,u,v,w\n0,1,2,3\n"), HasSubstr("does not name the columns"));
  EXPECT_THAT(error("scan,x,y,z,dx,dy,dz\n"), HasSubstr("names positions and directions"));
  EXPECT_THAT(error("dx,dy,dz\n0,0,0\n"), HasSubstr("the direction has no length"));
  EXPECT_THAT(error("dx,dy,dz\n1e300,1e308,1.7e308\n"), HasSubstr("no length")); // none that a double holds
}

// The notes beside the bunny: name, count and direction of each scan.
TEST_F(IoSensors, DirectionsOfTheBunny) {
  EIGENCRUST_NEED_DATA(data_path("bunny/views.txt"));
  std::ifstream notes(data_path("bunny/views.txt"));
  std::string text = "scan,dx,dy,dz\n", line;
  std::vector<Vec3> directions;
  std::vector<std::size_t> counts;
  while (std::getline(notes, line)) {
    if (line.starts_with('#')) continue;
    std::istringstream words(line);
    std::string name, dx, dy, dz;
    std::size_t count = 0;
    words >> name >> count >> dx >> dy >> dz;
    text += std::to_string(directions.size()) + "," + dx + "," + dy + "," + dz + "\n";
    directions.push_back({std::stod(dx), std::stod(dy), std::stod(dz)});
    counts.push_back(count);
  }
  ASSERT_EQ(directions.size(), 10u);
  write_bytes(folder_ / "directions.csv", text);
  PointCloud cloud = read_point_cloud(data_path("bunny/bunny_raw.ply"));
  cloud.scan_index = read_scan_index(data_path("bunny/scan_index.u8"), cloud.points.size());
  read_scan_sensors(folder_ / "directions.csv", cloud);
  ASSERT_EQ(cloud.sensors.size(), 10u);
  std::vector<std::size_t> seen(10, 0);
  for (const std::uint32_t s : cloud.sensor_of) ++seen[s];
  EXPECT_EQ(seen, counts);
  for (std::size_t s = 0; s < 10; ++s) {
    EXPECT_TRUE(cloud.sensors[s].at_infinity);
    EXPECT_LT(distance(cloud.sensors[s].place, directions[s]), 1e-6);
    EXPECT_NEAR(norm(cloud.sensors[s].place), 1, 1e-15);
  }
}

// The same statue and shapes as columns of a PLY file and as arrays; single precision in the one.
TEST_F(IoSensors, ColumnsAndArraysAgree) {
  for (const auto& [ply, npz] : {std::pair{"reconbench/anchor_mvs_sensors.ply", "reconbench/anchor_mvs.npz"},
                                 std::pair{"ignatius/ignatius_99_sensors.ply", "ignatius/99.npz"}}) {
    EIGENCRUST_NEED_DATA(data_path(npz));
    const PointCloud a = read_point_cloud(data_path(ply)), b = read_point_cloud(data_path(npz));
    ASSERT_EQ(a.points.size(), b.points.size());
    ASSERT_EQ(a.sensors.size(), b.sensors.size());
    EXPECT_EQ(a.sensor_of, b.sensor_of);
    for (std::size_t s = 0; s < a.sensors.size(); ++s)
      EXPECT_LT(distance(a.sensors[s].place, b.sensors[s].place), 1e-6 * norm(b.sensors[s].place));
  }
  // A scanner on the move: 360 places.
  EXPECT_EQ(read_point_cloud(data_path("scan_the_bunny/pointcloud_sensors.ply")).sensors.size(), 360u);
}

} // namespace
} // namespace eigencrust
