// SPDX-License-Identifier: GPL-3.0-or-later
// What coordinates tell of how they were written, units, shifts, and grids.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include <eigencrust/io.h>

#include "support.h"

namespace eigencrust {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

class IoCoordinates : public ::testing::Test {
 protected:
  PointCloud read(const std::string& text, ReadOptions options = {}) {
    write_bytes(folder_ / "a.xyz", text);
    notes_ = {};
    return read_point_cloud(folder_ / "a.xyz", options, &notes_);
  }
  PointCloud read(const std::vector<Vec3>& points) {
    WriteOptions options;
    options.coordinates = CoordinateType::float64;
    write_point_cloud(folder_ / "a.ply", {points, {}, {}}, options);
    notes_ = {};
    return read_point_cloud(folder_ / "a.ply", {}, &notes_);
  }

  TempDir folder_;
  ReadNotes notes_;
};

/// A wavy sheet of n x n points, `step` apart, with irregular places.
std::vector<Vec3> sheet(std::size_t n, double step, const Vec3& corner) {
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = 0; k < n; ++k) {
      const double x = static_cast<double>(i) + 0.3 * std::sin(static_cast<double>(7 * k)),
                   y = static_cast<double>(k) + 0.3 * std::cos(static_cast<double>(5 * i));
      points.push_back(corner + step * Vec3{x, y, 3 * std::sin(0.3 * x) * std::cos(0.2 * y)});
    }
  return points;
}

TEST_F(IoCoordinates, ValuesThatMeanNoData) {
  for (const char* value : {"-9999", "-9999.00", "-99999", "-32768", "-3.4028234663852886e+38", "-3.40282e38"}) {
    const PointCloud cloud = read(std::string("1 2 345 7\n1 3 ") + value + " 8\n2 2 346 9\n2 3 " + value + " 1\n");
    EXPECT_THAT(cloud.points, ElementsAre(Vec3{1, 2, 345}, Vec3{2, 2, 346})) << value;
    EXPECT_EQ(attribute_value(cloud.attributes.at(0), 1), 9);
    EXPECT_THAT(notes_.warnings, ElementsAre(HasSubstr("2 points without data left out: z = -"))) << value;
  }
  // A coordinate among others, though a round one; and nothing but such values.
  EXPECT_THAT(read("0 0 -9999\n0 1 -5000\n1 0 200\n1 1 9000\n").points, SizeIs(4));
  EXPECT_THAT(read("0 0 -9999\n0 1 -9999\n").points, SizeIs(2));
  EXPECT_THAT(notes_.warnings, IsEmpty());
}

TEST_F(IoCoordinates, StepsOf32Bits) {
  std::vector<Vec3> points = sheet(80, 0.25, {432100, 5480200, 345});
  for (Vec3& p : points) p = {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
  read(points);
  ASSERT_THAT(notes_.warnings, SizeIs(1));
  EXPECT_THAT(notes_.warnings[0], HasSubstr("y takes only 41 values, steps of 0.5"));
  EXPECT_THAT(notes_.warnings[0], HasSubstr("exported in 32 bits"));
  // What is left out says nothing, wherever it would be.
  points.push_back({400000, std::nan(""), 345});
  read(points);
  EXPECT_THAT(notes_.warnings, ElementsAre(HasSubstr("y takes only 41 values")));
  // The same in 64 bits, the same near 0, and heights on a raster of half a metre are fine.
  read(sheet(80, 0.25, {432100, 5480200, 345}));
  EXPECT_THAT(notes_.warnings, IsEmpty());
  points = sheet(80, 0.25, {0, 0, 345});
  for (Vec3& p : points) p = {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
  read(points);
  EXPECT_THAT(notes_.warnings, IsEmpty());
  points.clear();
  for (int i = 0; i < 60; ++i)
    for (int k = 0; k < 60; ++k) points.push_back({432100 + 0.5 * i, 5480200 + 0.5 * k, 345 + std::sin(0.1 * i * k)});
  read(points);
  EXPECT_THAT(notes_.warnings, IsEmpty());
}

TEST_F(IoCoordinates, DegreesAreNamed) {
  std::vector<Vec3> points = sheet(40, 1, {0, 0, 0});
  for (Vec3& p : points) p = {8.4 + p.x / 72000, 49 + p.y / 111000, 345 + p.z};
  read(points);
  EXPECT_THAT(notes_.warnings, ElementsAre(HasSubstr("degrees of longitude and latitude")));
  read(sheet(40, 1, {8.4, 49, 345}));
  EXPECT_THAT(notes_.warnings, IsEmpty());
}

TEST_F(IoCoordinates, ScaleAndShift) {
  ReadOptions options;
  options.scale = 0.001;
  options.shift = {-512, -5412, 0};
  const PointCloud cloud = read("x y z sx sy sz\n512001.5 5412002.5 1400 512000 5412000 2500\n", options);
  EXPECT_EQ(cloud.points[0].z, 1.4); // divided, not multiplied with the nearest number to 1/1000
  EXPECT_NEAR(cloud.points[0].x, 0.0015, 1e-12);
  EXPECT_NEAR(cloud.sensors.at(0).place.z, 2.5, 1e-12);
  for (const double bad : {0.0, -1.0, std::nan("")}) {
    options.scale = bad;
    EXPECT_THAT(error_of([&] { read("1 2 3\n", options); }), HasSubstr("scale")) << bad;
  }
}

TEST_F(IoCoordinates, WhatLeadsBackIsWritten) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  WriteOptions options;
  options.shift = {-512000.5, -5412000, 0};
  write_mesh(folder_ / "m.ply", mesh, options);
  EXPECT_THAT(read_bytes(folder_ / "m.ply"), HasSubstr("\ncomment shift -512000.5 -5412000 0\n"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "m.ply.offset.txt"));
  write_mesh(folder_ / "m.obj", mesh, options);
  EXPECT_THAT(read_bytes(folder_ / "m.obj"), HasSubstr("# shift -512000.5 -5412000 0\n"));
  write_mesh(folder_ / "m.stl", mesh, options);
  EXPECT_THAT(read_bytes(folder_ / "m.stl.offset.txt"),
              HasSubstr("of m.stl to return to those of the input\n512000.5 5412000 0\n"));
  // The offset that STL needs by itself comes on top; the file of an earlier run does not stay beside another mesh.
  for (Vec3& v : mesh.vertices) v = v + Vec3{600000.26, 0, 0};
  const WriteResult far = write_mesh(folder_ / "m.stl", mesh, options);
  EXPECT_EQ(far.offset.x, 600000.76);
  EXPECT_THAT(read_bytes(folder_ / "m.stl.offset.txt"), HasSubstr("\n1112001.26 5412000.5 0.5\n"));
  for (Vec3& v : mesh.vertices) v = v - Vec3{600000.26, 0, 0};
  write_mesh(folder_ / "m.stl", mesh);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "m.stl.offset.txt"));
  write_bytes(folder_ / "m.stl.offset.txt", "mine"); // not ours
  write_mesh(folder_ / "m.stl", mesh);
  EXPECT_EQ(read_bytes(folder_ / "m.stl.offset.txt"), "mine");
  write_point_cloud(folder_ / "c.csv", {mesh.vertices, {}, {}}, options);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "c.csv.offset.txt"));
}

TEST_F(IoCoordinates, InputsThatDoNotGoTogether) {
  const std::vector<std::string> names = {"a.ply", "b.ply"};
  const auto compared = [&](const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
    return compare_extents(names, std::vector<Extent>{extent_of(a), extent_of(b)});
  };
  const std::vector<Vec3> metres = sheet(20, 1, {0, 0, 0});
  std::vector<Vec3> millimetres = metres;
  for (Vec3& p : millimetres) p = 1000 * p;
  millimetres.push_back({1e9, 0, 0}); // an outlier does not hide it
  EXPECT_THAT(compared(millimetres, metres), ElementsAre(HasSubstr("a.ply is 1000 times as large as b.ply")));
  EXPECT_THAT(compared(millimetres, metres)[0], HasSubstr("type --unit mm --unit m"));
  EXPECT_THAT(compared(metres, millimetres)[0], HasSubstr("type --unit m --unit mm"));
  EXPECT_THAT(compared(metres, sheet(20, 1, {15, 0, 0})), IsEmpty());
  EXPECT_THAT(compared(metres, sheet(20, 1, {500, 0, 0})), SizeIs(2)); // either is named
  EXPECT_THAT(compared(metres, {}), IsEmpty());
  EXPECT_THAT(compared(metres, sheet(5, 1, {8, 8, 0})), IsEmpty()); // a detail
}

TEST_F(IoCoordinates, GridsOfScans) {
  write_bytes(folder_ / "a.pcd",
              "FIELDS x y z\nWIDTH 3\nHEIGHT 2\nDATA ascii\n0 0 1\n1 0 1\n2 0 1\n0 1 1\nnan nan nan\n2 1 1\n");
  const PointCloud pcd = read_point_cloud(folder_ / "a.pcd");
  const auto of_pcd = find_grids(pcd);
  ASSERT_TRUE(of_pcd.has_value());
  EXPECT_THAT(of_pcd->sizes, ElementsAre(ScanGrid{3, 2}));
  EXPECT_THAT(of_pcd->cell, ElementsAre(0, 1, 2, 3, 4, 5));
  // Two columns of three rows: the rows of a column follow one another; one cell is empty.
  const std::string head = "2\n3\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n";
  write_bytes(folder_ / "a.ptx", head + "1 1 1 0\n0 0 0 0\n1 1 3 0\n2 1 1 0\n2 1 2 0\n2 1 3 0\n");
  const PointCloud ptx = read_point_cloud(folder_ / "a.ptx");
  const auto of_ptx = find_grids(ptx);
  ASSERT_TRUE(of_ptx.has_value());
  EXPECT_THAT(of_ptx->sizes, ElementsAre(ScanGrid{2, 3}));
  EXPECT_THAT(of_ptx->cell, ElementsAre(0, 4, 1, 3, 5));
  // Scans keep apart when they are joined; one without a grid has none.
  PointCloud joined = ptx;
  append_scan(joined, {{{0, 0, 0}}, {}, {}});
  append_scan(joined, pcd);
  const auto all = find_grids(joined);
  ASSERT_TRUE(all.has_value());
  EXPECT_THAT(all->sizes, ElementsAre(ScanGrid{2, 3}, ScanGrid{}, ScanGrid{3, 2}));
  EXPECT_EQ(all->cell.back(), 5u);
  // Two points in a cell are no grid; nor is one row.
  EXPECT_FALSE(find_grids(read("row column x y z\n0 0 1 2 3\n0 1 1 2 4\n1 0 1 2 5\n1 0 1 2 6\n")));
  EXPECT_FALSE(find_grids(read("row column x y z\n0 0 1 2 3\n0 1 1 2 4\n")));
  EXPECT_FALSE(find_grids(read("1 2 3\n")));
}

} // namespace
} // namespace eigencrust
