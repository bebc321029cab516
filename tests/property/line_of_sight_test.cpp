// SPDX-License-Identifier: GPL-3.0-or-later
// What the places of the sensors bring to a whole reconstruction.
#include <eigencrust/eigencrust.h>
#include <eigencrust/io.h>
#include <eigencrust/metrics.h>
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "clouds.h"
#include "shapes.h"
#include "support.h"
#include "virtual_scanner.h"

namespace eigencrust {
namespace {

/// The mesh scanned from around: at each elevation as many pinholes as said.
PointCloud scanned(const TriangleMesh& mesh, const std::vector<std::pair<double, std::uint32_t>>& rings,
                   std::uint32_t resolution, const tools::ScanOptions& options = {}) {
  Box3 box;
  for (const Vec3& p : mesh.vertices) box.add(p);
  const double radius = 0.5 * box.diagonal();
  std::vector<tools::Sensor> sensors;
  for (const auto& [elevation, count] : rings)
    for (const Vec3& direction : tools::ring_directions(count, elevation))
      sensors.push_back(tools::aim_pinhole(box.centre(), direction, radius, 3 * radius, resolution, {0, 0, 1}));
  PointCloud cloud = tools::scan(mesh, sensors, options);
  cloud.sensor_of.assign(cloud.scan_index.begin(), cloud.scan_index.end());
  for (const tools::Sensor& sensor : sensors) cloud.sensors.push_back({sensor.position, false});
  cloud.scan_index.clear(); // not several clouds that disagree
  return cloud;
}

PointCloud without_sensors(PointCloud cloud) {
  cloud.sensor_of.clear();
  return cloud;
}

/// A cup by turning an outline about the z axis.
TriangleMesh cup(double outer, double inner, double height, double floor) {
  constexpr unsigned around = 64;
  const std::vector<std::pair<double, double>> outline{{outer, 0}, {outer, height}, {inner, height}, {inner, floor}};
  TriangleMesh mesh;
  for (const auto& [r, z] : outline)
    for (unsigned i = 0; i < around; ++i) {
      const double u = 2 * std::numbers::pi * i / around;
      mesh.vertices.push_back({r * std::cos(u), r * std::sin(u), z});
    }
  const auto middle = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.push_back({0, 0, 0});
  mesh.vertices.push_back({0, 0, floor});
  for (std::uint32_t i = 0; i < around; ++i) {
    const std::uint32_t j = (i + 1) % around;
    for (std::uint32_t ring = 0; ring < 3; ++ring) {
      const std::uint32_t a = ring * around, b = a + around;
      mesh.triangles.push_back({a + i, a + j, b + j});
      mesh.triangles.push_back({a + i, b + j, b + i});
    }
    mesh.triangles.push_back({middle, j, i});
    mesh.triangles.push_back({middle + 1, 3 * around + i, 3 * around + j});
  }
  return mesh;
}

void expect_sound(const Result& result) {
  EXPECT_THAT(result.report.broken_guarantees, testing::IsEmpty());
  EXPECT_TRUE(result.report.mesh.closed() && result.report.mesh.manifold() && result.report.mesh.oriented());
}

TEST(LineOfSight, OpensACupThatIsSeenOnlyThroughItsMouth) {
  const TriangleMesh mesh = cup(1, 0.8, 6, 0.25);
  const PointCloud cloud = scanned(mesh, {{10, 5}, {-35, 3}, {75, 2}, {88, 1}}, 110);
  const Result with = reconstruct(cloud), without = reconstruct(without_sensors(cloud));
  expect_sound(with);
  const double iou = volume_iou(with.mesh, mesh), blind = volume_iou(without.mesh, mesh);
  RecordProperty("iou", std::to_string(iou));
  RecordProperty("iou_without", std::to_string(blind));
  EXPECT_GE(iou, 0.95);
  EXPECT_LT(blind, 0.9);                                            // the test is worth something
  EXPECT_GT(with.report.sight_lines, 9 * cloud.points.size() / 10); // isolated samples have none
  EXPECT_LT(with.report.contradicting_rays, with.report.sight_lines / 20);
  EXPECT_EQ(without.report.sight_lines, 0u);
}

TEST(LineOfSight, KeepsTwoPlatesApart) {
  const TriangleMesh mesh =
      shapes::joined(shapes::box({-1, -1, -0.25}, {1, 1, -0.1}), shapes::box({-1, -1, 0.1}, {1, 1, 0.25}));
  const PointCloud cloud = scanned(mesh, {{8, 8}, {-8, 8}, {45, 3}, {-45, 3}}, 110);
  const Result with = reconstruct(cloud), without = reconstruct(without_sensors(cloud));
  expect_sound(with);
  const double iou = volume_iou(with.mesh, mesh), blind = volume_iou(without.mesh, mesh);
  RecordProperty("iou", std::to_string(iou));
  RecordProperty("iou_without", std::to_string(blind));
  EXPECT_GE(iou, 0.95);
  EXPECT_GE(iou, blind - 0.003);
}

TEST(LineOfSight, OutliersBehindTheSurfaceDoNotPierceIt) {
  const TriangleMesh mesh = shapes::torus(1, 0.45, 60, 40);
  const PointCloud cloud =
      scanned(mesh, {{20, 5}, {-20, 5}, {80, 2}, {-80, 2}}, 90, {.outlier_fraction = 0.05, .seed = 3});
  const Result with = reconstruct(cloud);
  expect_sound(with);
  ASSERT_FALSE(with.report.mesh.component_list.empty());
  EXPECT_EQ(with.report.mesh.component_list[0].genus, 1);
  EXPECT_GE(volume_iou(with.mesh, mesh), 0.97);
}

TEST(LineOfSight, IsTheSameForAnyNumberOfThreadsAndOrderOfRows) {
  const TriangleMesh mesh = cup(1, 0.8, 2, 0.3);
  const PointCloud cloud =
      scanned(mesh, {{10, 4}, {70, 3}, {-40, 2}}, 50, {.range_noise = 0.005, .outlier_fraction = 0.01});
  Options options;
  options.threads = 1;
  const Result one = reconstruct(cloud, options);
  options.threads = 3;
  const Result three = reconstruct(cloud, options);
  EXPECT_EQ(one.mesh.vertices, three.mesh.vertices);
  EXPECT_EQ(one.mesh.triangles, three.mesh.triangles);
  EXPECT_EQ(one.labels.raw(), three.labels.raw());
  EXPECT_EQ(one.report.contradicting_rays, three.report.contradicting_rays);
  PointCloud reversed = without_sensors(cloud);
  reversed.attributes.clear();
  std::reverse(reversed.points.begin(), reversed.points.end());
  reversed.sensor_of.assign(cloud.sensor_of.rbegin(), cloud.sensor_of.rend());
  const Result other = reconstruct(reversed, options);
  EXPECT_EQ(clouds::triangle_set(one.mesh), clouds::triangle_set(other.mesh));
  EXPECT_EQ(one.report.contradicting_rays, other.report.contradicting_rays);
}

TEST(LineOfSight, FewWrongLinesChangeNothing) {
  // Every tenth point of a sphere seen from all sides says it was seen through the ball.
  PointCloud cloud = clouds::cloud_of(clouds::sphere(3000));
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    cloud.sensors.push_back({(i % 10 == 0 ? -1 : 1) * cloud.points[i], true});
    cloud.sensor_of.push_back(static_cast<std::uint32_t>(i));
  }
  const Result result = reconstruct(cloud);
  expect_sound(result);
  EXPECT_NEAR(result.report.mesh.volume, 4.1, 0.1);
  EXPECT_GT(result.report.contradicting_rays, 100u);
  EXPECT_THAT(result.report.warnings, testing::Contains(testing::HasSubstr("lines of sight")));
}

TEST(LineOfSight, SensorsThatContradictTheSurfaceAreReported) {
  // Points on a sphere that all say they were seen from one side: half of them through the ball. Then there is none.
  PointCloud cloud = clouds::cloud_of(clouds::sphere(3000));
  cloud.sensors = {{{0, 0, 1}, true}};
  cloud.sensor_of.assign(cloud.points.size(), 0);
  const Result result = reconstruct(cloud);
  expect_sound(result);
  EXPECT_GT(result.report.unsupported_area, 0.5);
  EXPECT_THAT(result.report.warnings, testing::Contains(testing::HasSubstr("the sensors all lie on one side")));
}

TEST(LineOfSight, RawBunnyWithItsViewsHasNoHandle) {
  const auto file = data_path("bunny/bunny_raw.ply"), index = data_path("bunny/scan_index.u8"),
             views = data_path("bunny/views.txt");
  EIGENCRUST_NEED_DATA(file);
  EIGENCRUST_NEED_DATA(index);
  EIGENCRUST_NEED_DATA(views);
  PointCloud cloud = read_point_cloud(file);
  cloud.sensor_of = read_scan_index(index, cloud.points.size());
  std::ifstream in(views);
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream words(line);
    std::string name;
    std::size_t count = 0;
    Vec3 d;
    words >> name >> count >> d.x >> d.y >> d.z;
    cloud.sensors.push_back({(1 / norm(d)) * d, true});
  }
  const Result result = reconstruct(cloud);
  expect_sound(result);
  EXPECT_EQ(result.report.mesh.components, 1u);
  EXPECT_EQ(result.report.mesh.genus, 0);
  EXPECT_NEAR(result.report.mesh.volume / 7.55e-4, 1, 0.01);
  EXPECT_LT(result.report.contradicting_rays, result.report.sight_lines / 20);
}

TEST(LineOfSight, BundledTeapotHasNoFinBehindItsSpout) {
  const PointCloud cloud = read_point_cloud(source_folder() / "examples" / "teapot_scan.ply");
  ASSERT_FALSE(cloud.sensors.empty());
  Options options;
  options.surface = SurfaceKind::samples;
  const Result result = reconstruct(cloud, options);
  expect_sound(result);
  EXPECT_EQ(result.report.mesh.components, 1u);
  EXPECT_EQ(result.report.mesh.genus, 1); // the handle
  // The scan's roughness included; two outliers behind the spout added 1.7.
  EXPECT_NEAR(result.report.mesh.area, 52.3, 0.3);
  EXPECT_NEAR(result.report.mesh.volume, 26.01, 0.1);
}

} // namespace
} // namespace eigencrust
