// SPDX-License-Identifier: GPL-3.0-or-later
// Surface over places without samples, among strays.
#include "fit/bridges.h"

#include <eigencrust/eigencrust.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "clouds.h"

namespace eigencrust {
namespace {

using clouds::Points;
using std::numbers::pi;

/// Mean of the other ends of a vertex's edges; on a closed surface each is the first of one wing.
Vec3 mean_of_neighbours(const SurfaceFans& fans, const std::vector<Vec3>& vertices, std::uint32_t v) {
  Vec3 sum;
  for (const auto& wing : fans[v]) sum = sum + vertices[wing.next];
  return (1 / static_cast<double>(fans[v].size())) * sum;
}

TEST(Bridges, AllVerticesGoToTheMeanOfTheirNeighboursAtOnce) {
  // A pyramid on a square whose tip is split in two.
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {1, 2, 9}, {3, 2, 7}};
  mesh.triangles = {{0, 1, 5}, {1, 2, 5}, {2, 3, 4}, {3, 0, 4}, {0, 5, 4}, {2, 4, 5}, {0, 2, 1}, {0, 3, 2}};
  const SurfaceFans fans(mesh);
  std::vector<Vec3> vertices = mesh.vertices;
  flatten_bridges(std::vector<std::uint32_t>{4, 5}, fans, vertices);
  for (std::uint32_t v = 0; v < 4; ++v) EXPECT_EQ(vertices[v], mesh.vertices[v]);
  for (const std::uint32_t v : {4u, 5u}) {
    EXPECT_LT(distance(vertices[v], mean_of_neighbours(fans, vertices, v)), 1e-12);
    EXPECT_NEAR(vertices[v].z, 0, 1e-12); // between what lies in a plane
  }
}

/// The side and the bottom of a cylinder of radius 1 and height 3, without its upper end.
Points open_cylinder(std::size_t n, std::uint64_t seed) {
  clouds::Random random(seed);
  Points points;
  const std::size_t side = n * 6 / 7; // 6 π of 7 π
  for (std::size_t i = 0; i < n; ++i) {
    const double angle = random.uniform(0, 2 * pi), r = i < side ? 1 : std::sqrt(random.uniform());
    points.push_back({r * std::cos(angle), r * std::sin(angle), i < side ? random.uniform(0, 3) : 0});
  }
  return points;
}

Points strays(std::size_t n, std::uint64_t seed) {
  clouds::Random random(seed);
  Points points;
  for (std::size_t i = 0; i < n; ++i)
    points.push_back({random.uniform(-1.5, 1.5), random.uniform(-1.5, 1.5), random.uniform(-0.75, 3.75)});
  return points;
}

TEST(Bridges, AreFlatAmongStrays) {
  for (const auto& [seed, count] : {std::pair<std::uint64_t, std::size_t>{1, 300}, {2, 1200}, {3, 300}, {4, 1200}}) {
    const PointCloud cloud = clouds::cloud_of(clouds::joined(open_cylinder(6000, seed), strays(count, seed + 10)));
    Options options;
    options.threads = 2;
    const Result evened = reconstruct(cloud, options);
    const double error = std::fabs(evened.report.mesh.volume / (3 * pi) - 1);
    EXPECT_LT(error, 0.05) << "seed " << seed;
    EXPECT_TRUE(evened.report.mesh.closed() && evened.report.mesh.manifold());
    EXPECT_EQ(evened.report.mesh.genus, 0);
    EXPECT_EQ(evened.report.mesh.self_intersections, 0);
    ASSERT_TRUE(evened.report.moved);
    EXPECT_GT(evened.report.moved->strays, 0u);
    EXPECT_EQ(evened.report.moved->vertices, 0u);
    options.surface = SurfaceKind::samples;
    const Result samples = reconstruct(cloud, options);
    EXPECT_FALSE(samples.report.moved);
    EXPECT_GT(std::fabs(samples.report.mesh.volume / (3 * pi) - 1), 1.25 * error); // a hat of strays
  }
}

/// A ball of radius 1, its lower half of few samples that are off by up to `roughness`.
Points half_coarse_ball(double roughness, std::uint64_t seed) {
  Points points = clouds::sphere(8000), others = clouds::sphere(220);
  std::erase_if(points, [](const Vec3& p) { return p.z <= 0; });
  std::erase_if(others, [](const Vec3& p) { return p.z > 0; });
  clouds::Random random(seed);
  for (Vec3& p : others) p = (1 + random.uniform(-roughness, roughness)) * p;
  return clouds::joined(points, others);
}

TEST(Bridges, CoarsePartsAreNone) {
  Options options;
  options.threads = 2;
  const Points smooth = half_coarse_ball(0.02, 1), rough = half_coarse_ball(0.15, 2);
  // As far apart as strays, but smooth; rough, but most of what stands alone is on the surface; closer than strays.
  for (const Points& points :
       {clouds::joined(smooth, clouds::random_box(400, 3, 1.3)), clouds::joined(rough, clouds::random_box(60, 4, 1.3)),
        clouds::joined(rough, clouds::random_box(1000, 5, 8))}) {
    const Result result = reconstruct(clouds::cloud_of(points), options);
    EXPECT_LT(result.report.moved ? result.report.moved->strays : 0, 5u);
  }
}

TEST(Bridges, WhatAScannerSawStays) {
  PointCloud cloud = clouds::cloud_of(clouds::joined(open_cylinder(6000, 1), strays(300, 11)));
  Options options;
  options.threads = 2;
  EXPECT_TRUE(reconstruct(cloud, options).report.moved);
  cloud.sensors = {{{10, 0, 2}, false}, {{-10, 0, 2}, false}};
  for (const Vec3& p : cloud.points) cloud.sensor_of.push_back(p.x < 0);
  EXPECT_FALSE(reconstruct(cloud, options).report.moved);
}

TEST(Bridges, NothingMovesWhereThereIsNone) {
  Options options;
  options.threads = 2;
  const Points points = clouds::joined(clouds::sphere(5000), clouds::moved(strays(250, 3), {0, 0, -1.5}));
  const Result result = reconstruct(clouds::cloud_of(points), options);
  EXPECT_FALSE(result.report.moved);
  // Isolated samples have long triangles only where something is missing; what is but sparse keeps its place.
  const Result sparse =
      reconstruct(clouds::cloud_of(clouds::joined(clouds::sphere(8000), clouds::sphere(200, 1, {4, 0, 0}))), options);
  EXPECT_FALSE(sparse.report.moved);
  EXPECT_EQ(sparse.report.mesh.components, 2u);
}

} // namespace
} // namespace eigencrust
