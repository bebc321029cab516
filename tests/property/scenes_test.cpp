// SPDX-License-Identifier: GPL-3.0-or-later
// What was scanned: bodies, rooms from within, ground from above.
#include <eigencrust/eigencrust.h>
#include <eigencrust/error.h>
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>
#include <random>

#include "clouds.h"
#include "sensors.h"
#include "shapes.h"
#include "virtual_scanner.h"

namespace eigencrust {
namespace {

using testing::HasSubstr;

/// What scanners at these places see of a mesh, looking all around.
PointCloud scan_of(const TriangleMesh& mesh, const std::vector<Vec3>& places, std::uint32_t rays = 36,
                   double noise = 0) {
  std::vector<tools::Sensor> views;
  for (const Vec3& place : places)
    for (const tools::Sensor& view : tools::all_around(place, rays)) views.push_back(view);
  tools::ScanOptions options;
  options.range_noise = noise;
  options.threads = 2;
  PointCloud cloud = tools::scan(mesh, views, options);
  for (const Vec3& place : places) cloud.sensors.push_back({place, false});
  for (const std::uint32_t view : cloud.scan_index) cloud.sensor_of.push_back(view / 6);
  return cloud;
}

double covered(const Result& result, const PointCloud& cloud) {
  return static_cast<double>(result.mesh.vertices.size()) / static_cast<double>(cloud.points.size());
}

TEST(Scenes, ARoomFromWithinIsItsFreeSpace) {
  const PointCloud cloud = scan_of(shapes::box({0, 0, 0}, {5, 4, 2.7}), {{2.2, 1.9, 1.4}}, 36, 0.002);
  const Result result = reconstruct(cloud);
  EXPECT_EQ(result.report.surroundings.kind, SceneKind::interior);
  EXPECT_EQ(result.report.mesh.components, 1u);
  EXPECT_EQ(result.report.mesh.genus, 0);
  EXPECT_TRUE(result.report.mesh.closed());
  EXPECT_NEAR(result.report.mesh.volume / -54, 1, 0.02); // it looks inward, at the scanner
  EXPECT_GT(covered(result, cloud), 0.98);
  EXPECT_THAT(result.report.broken_guarantees, testing::IsEmpty());
  EXPECT_THAT(to_json(result.report), HasSubstr("\"scene\": \"interior\""));
}

TEST(Scenes, WithoutSensorsARoomIsABody) {
  PointCloud cloud = scan_of(shapes::box({0, 0, 0}, {5, 4, 2.7}), {{2.2, 1.9, 1.4}});
  cloud.sensors.clear();
  cloud.sensor_of.clear();
  const Result result = reconstruct(cloud);
  EXPECT_EQ(result.report.surroundings.kind, SceneKind::body);
  EXPECT_NEAR(result.report.mesh.volume / 54, 1, 0.02);
}

TEST(Scenes, WallsSeenFromBothSidesAreABody) {
  const TriangleMesh house = shapes::joined(shapes::box({-0.4, -0.4, -0.4}, {4.4, 3.4, 2.9}),
                                            shapes::flipped(shapes::box({0, 0, 0}, {4, 3, 2.5})));
  std::vector<Vec3> places{{2, 1.5, 1.2}};
  for (const Vec3& d : {Vec3{1, 0.3, 0.2}, Vec3{-1, 0.2, 0.4}, Vec3{0.1, 1, 0.3}, Vec3{-0.2, -1, 0.4},
                        Vec3{0.1, 0.2, 1}, Vec3{0.1, 0.1, -1}})
    places.push_back(Vec3{2, 1.5, 1.2} + 5.0 * d);
  const Result result = reconstruct(scan_of(house, places, 100));
  EXPECT_EQ(result.report.surroundings.kind, SceneKind::body);
  EXPECT_EQ(result.report.mesh.components, 2u);
  EXPECT_NEAR(result.report.mesh.volume / (4.8 * 3.8 * 3.3 - 30), 1, 0.02);
}

TEST(Scenes, ABodySeenFromOutsideStaysOne) {
  const PointCloud cloud = scan_of(shapes::icosphere(4), {{3, 0, 1}, {-2, 2.5, 0}, {-1, -3, -1}, {0, 0.5, -3}}, 80);
  const Result result = reconstruct(cloud);
  EXPECT_EQ(result.report.surroundings.kind, SceneKind::body);
  EXPECT_NEAR(result.report.mesh.volume / (4 * std::numbers::pi / 3), 1, 0.02);
}

/// A lattice with random offsets over [-half, half]², and a height for each place.
template <class Height>
PointCloud ground_of(double half, double spacing, Height&& height) {
  clouds::Random random(1);
  PointCloud cloud;
  for (double x = -half; x <= half; x += spacing)
    for (double y = -half; y <= half; y += spacing) {
      const double u = x + 0.4 * spacing * random.uniform(), v = y + 0.4 * spacing * random.uniform();
      cloud.points.push_back({u, v, height(u, v)});
    }
  return cloud;
}

double pile(double x, double y) { return std::max(0.0, 2.6 * (1 - std::hypot(x + 0.5, y - 1) / 4)); }
const double volume_of_pile = std::numbers::pi * 4 * 4 * 2.6 / 3;

TEST(Scenes, GroundIsSolidBelowAndOpenAtItsRim) {
  const PointCloud cloud =
      ground_of(10, 0.25, [](double x, double y) { return 2 * std::sin(x / 2) + 1.5 * std::cos(y / 1.7); });
  const Result result = reconstruct(cloud);
  EXPECT_EQ(result.report.surroundings.kind, SceneKind::facade);
  EXPECT_EQ(result.report.surroundings.front, Axis::plus_z);
  EXPECT_EQ(result.report.mesh.components, 1u);
  EXPECT_EQ(result.report.mesh.genus, 0);
  EXPECT_EQ(result.report.mesh.boundary_loops, 1u);
  EXPECT_GT(covered(result, cloud), 0.98);
  double up = 0;
  for (const auto& [a, b, c] : result.mesh.triangles) {
    const auto& v = result.mesh.vertices;
    up += cross(v[b] - v[a], v[c] - v[a]).z > 0;
  }
  EXPECT_GT(up / static_cast<double>(result.mesh.triangles.size()), 0.98);
  EXPECT_THAT(to_json(result.report), HasSubstr("\"volume\": null"));
  Options off;
  off.detect_facade = false;
  EXPECT_EQ(reconstruct(cloud, off).report.surroundings.kind, SceneKind::body);
}

double wave(double x, double y) { return 0.25 * std::sin(4 * x) * std::sin(4 * y); }

/// Of the mesh's area what is not on the wave over [-2, 2] × [-1.5, 1.5].
double area_beside_wave(const TriangleMesh& mesh) {
  double area = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vec3 middle = (1.0 / 3) * (mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c]);
    const bool is_over = std::fabs(middle.x) < 2.03 && std::fabs(middle.y) < 1.53;
    if (is_over && std::fabs(middle.z - wave(middle.x, middle.y)) < 0.05) continue;
    area += norm(cross(mesh.vertices[b] - mesh.vertices[a], mesh.vertices[c] - mesh.vertices[a])) / 2;
  }
  return area;
}

// Without the rule for strays at the rim, teeth of 0.4 to 0.7 stand out there; what is left stands on the wave itself.
TEST(Scenes, GroundHasNoTeethAtItsRimAmongStrays) {
  for (const std::uint32_t seed : {1u, 2u, 3u}) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(-1, 1);
    PointCloud cloud;
    for (int i = 0; i < 15000; ++i) {
      const double x = 2 * unit(random), y = 1.5 * unit(random);
      cloud.points.push_back({x, y, wave(x, y)});
    }
    for (int i = 0; i < 300; ++i) cloud.points.push_back({3 * unit(random), 2.25 * unit(random), 0.9 * unit(random)});
    const Result result = reconstruct(cloud);
    EXPECT_EQ(result.report.surroundings.kind, SceneKind::facade);
    EXPECT_LT(area_beside_wave(result.mesh), 0.25) << seed;
    EXPECT_EQ(result.report.mesh.genus, 0) << seed;
  }
}

// Coarse ground beside fine ground is no stray.
TEST(Scenes, GroundThatBecomesCoarseStays) {
  for (const int coarse : {400, 1700}) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> unit(0, 1);
    PointCloud cloud;
    for (int i = 0; i < 12000; ++i) cloud.points.push_back({-2 * unit(random), 3 * unit(random), 0});
    for (int i = 0; i < coarse; ++i) cloud.points.push_back({2 * unit(random), 3 * unit(random), 0});
    for (Vec3& p : cloud.points) p.z = 0.2 * std::sin(2 * p.x) * std::cos(3 * p.y);
    Options options;
    options.facade = Axis::plus_z;
    const Result result = reconstruct(cloud, options);
    EXPECT_GT(covered(result, cloud), 0.999);
    EXPECT_EQ(result.report.mesh.components, 1u);
  }
}

TEST(Scenes, SensorsDoNotMakeABodyOfGround) {
  // As an aircraft sees it, and a scanner that no hill hides anything from.
  const auto height = [](double x, double y) { return 0.4 * std::sin(0.7 * x) * std::cos(0.5 * y); };
  for (const Vec3& place : {Vec3{-4, 3, 30}, Vec3{6, -5, 4}}) {
    PointCloud cloud = ground_of(10, 0.25, height);
    cloud.sensors = {{place, false}};
    cloud.sensor_of.assign(cloud.points.size(), 0);
    const Result result = reconstruct(cloud);
    EXPECT_EQ(result.report.surroundings.kind, SceneKind::facade);
    EXPECT_EQ(result.report.mesh.components, 1u);
    EXPECT_GT(covered(result, cloud), 0.9);
    EXPECT_LT(result.report.unsupported_area, 0.1);
  }
}

TEST(Scenes, AnOverhangSeenFromBelowIsFreeBelow) {
  // A ledge: a wall that leans over the ground at its foot, samples everywhere.
  PointCloud cloud = ground_of(8, 0.2, [](double x, double) { return x > 0 ? 6.0 : 0.0; });
  const auto wall = [](double y, double z) { return 0.4 * std::sin(1.1 * y) + 0.5 * std::sin(1.6 * z) - 0.35 * z; };
  std::erase_if(cloud.points, [&](const Vec3& p) { return p.z > 0 ? false : p.x > wall(p.y, 0); });
  clouds::Random random(9);
  for (double y = -8; y <= 8; y += 0.2)
    for (double z = 0.1; z < 6; z += 0.2) {
      const double u = y + 0.08 * random.uniform(), v = z + 0.08 * random.uniform();
      cloud.points.push_back({wall(u, v), u, v});
    }
  for (double y = -8; y <= 8; y += 0.2)
    for (double x = 0; x > wall(y, 6); x -= 0.2) cloud.points.push_back({x - 0.05 * random.uniform(), y, 6});
  const Result result = reconstruct(cloud);
  EXPECT_EQ(result.report.surroundings.kind, SceneKind::facade);
  EXPECT_EQ(result.report.mesh.components, 1u);
  EXPECT_EQ(result.report.mesh.genus, 0);
  EXPECT_GT(covered(result, cloud), 0.98);
}

TEST(Scenes, ABaseClosesAPile) {
  for (const double slope : {0.0, 0.2}) {
    const PointCloud cloud = ground_of(10, 0.25, [&](double x, double y) { return pile(x, y) + slope * x; });
    Options options;
    options.base = true;
    const Result result = reconstruct(cloud, options);
    const MeshSummary& mesh = result.report.mesh;
    EXPECT_TRUE(mesh.closed());
    EXPECT_TRUE(mesh.manifold());
    EXPECT_TRUE(mesh.oriented());
    EXPECT_EQ(mesh.self_intersections, 0);
    EXPECT_EQ(mesh.genus, 0);
    EXPECT_GT(mesh.volume, 0);
    ASSERT_TRUE(result.report.base.has_value());
    EXPECT_NEAR(result.report.base->volume_above_rim / volume_of_pile, 1, 0.02) << slope;
    if (slope == 0) {
      EXPECT_NEAR(mesh.volume / volume_of_pile, 1, 0.02);
    }
    const Attribute& source = *find_attribute(result.mesh.vertex_attributes, "source_index");
    std::size_t invented = 0;
    for (std::size_t v = 0; v < source.rows(); ++v) invented += attribute_value(source, v) == no_index;
    EXPECT_EQ(invented, result.report.base->vertices);
    EXPECT_EQ(result.mesh.vertices.back().z, result.report.base->level);
  }
}

TEST(Scenes, ABaseStandsUnderASquareMap) {
  // Far away, on whole numbers: the rows at the map's edges are exactly in line.
  PointCloud cloud;
  for (int x = 0; x < 40; ++x)
    for (int y = 0; y < 40; ++y)
      cloud.points.push_back({455000.0 + x, 5880000.0 + y, 40 + 2 * std::sin(0.3 * x) + 1.5 * std::cos(0.4 * y + 1)});
  Options options;
  options.base = true;
  for (const std::uint32_t smooth : {0u, 3u}) {
    options.smooth = smooth;
    const Result result = reconstruct(cloud, options);
    const MeshSummary& mesh = result.report.mesh;
    EXPECT_TRUE(mesh.closed() && mesh.manifold() && mesh.oriented());
    EXPECT_EQ(mesh.self_intersections, 0);
    EXPECT_EQ(mesh.genus, 0);
    EXPECT_GT(result.mesh.vertices.size() - result.report.base->vertices, 1590u);
    EXPECT_LT(result.report.base->level, 38);
    EXPECT_GT(result.report.base->level, 35);
  }
}

TEST(Scenes, ABaseNeedsGround) {
  Options options;
  options.base = true;
  try {
    reconstruct(clouds::cloud_of(clouds::sphere(2000)), options);
    FAIL() << "a sphere has no ground";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::usage);
    EXPECT_THAT(error.what(), HasSubstr("--facade"));
  }
  options.trim = true;
  EXPECT_THROW(check_options(options), Error);
}

TEST(Scenes, AWallIsNamedAndTheOptionWorks) {
  // Which side of it was seen nothing tells.
  PointCloud wall = ground_of(6, 0.2, [](double x, double y) { return 0.4 * std::sin(x) * std::cos(y); });
  for (Vec3& p : wall.points) p = {p.x, p.z, p.y};
  const Result closed = reconstruct(wall);
  EXPECT_EQ(closed.report.surroundings.kind, SceneKind::body);
  EXPECT_EQ(closed.report.surroundings.likely_facade, Axis::plus_y);
  EXPECT_THAT(closed.report.warnings, testing::Contains(HasSubstr("--facade +y or --facade -y")));
  Options options;
  options.facade = Axis::minus_y;
  const Result open = reconstruct(wall, options);
  EXPECT_EQ(open.report.mesh.genus, 0);
  EXPECT_GT(covered(open, wall), 0.98);
}

TEST(Scenes, ACapOfABodyStaysABody) {
  // A roof, without what is below it: there is space for a body beneath, and hardly any above.
  PointCloud roof = ground_of(6, 0.25, [](double x, double) { return 8 - 0.6 * std::fabs(x); });
  for (const Vec3& p : {Vec3{-6, -6, 0}, Vec3{6, 6, 0}, Vec3{6, -6, 0}, Vec3{-6, 6, 0}}) roof.points.push_back(p);
  const Result result = reconstruct(roof);
  EXPECT_EQ(result.report.surroundings.kind, SceneKind::body);
  EXPECT_EQ(result.report.surroundings.likely_facade, Axis::plus_z);
  EXPECT_GT(result.report.mesh.volume, 100);
}

} // namespace
} // namespace eigencrust
