// SPDX-License-Identifier: GPL-3.0-or-later
#include <eigencrust/measures.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "shapes.h"

namespace eigencrust {
namespace {

using ::testing::HasSubstr;

MeshMeasures measures_of(const TriangleMesh& mesh, const MeasureOptions& options = {}) {
  return measure(mesh, validate(mesh), options);
}

TEST(Measures, OfABox) {
  const TriangleMesh box = shapes::box({0, 0, 0}, {3, 4, 0.25});
  const MeshMeasures m = measures_of(box);
  EXPECT_NEAR(m.shortest_edge, 0.25, 1e-12);
  EXPECT_NEAR(m.longest_edge, 5, 1e-12);
  ASSERT_TRUE(m.thinnest_wall);
  EXPECT_NEAR(*m.thinnest_wall, 0.25, 1e-9);
  EXPECT_EQ(m.wall_rays, 12u);
  EXPECT_NEAR(m.largest_angle, 90, 1e-9);
  EXPECT_NEAR(m.smallest_angle, std::atan2(0.25, 4) * 180 / std::numbers::pi, 1e-9);
  // 0.25, 4 and the long side, which has as much as both but 0.24: l (a + b + l) / (2 √3 a b).
  const double l = std::hypot(0.25, 4);
  EXPECT_NEAR(m.worst_aspect, l * (4.25 + l) / (2 * std::numbers::sqrt3), 1e-9);
  EXPECT_EQ(printability(validate(box), m, 0), "printable: closed, manifold, no crossings, thinnest wall 0.25");
  EXPECT_EQ(printability(validate(box), m, 1e-3), "printable: closed, manifold, no crossings, thinnest wall 0.25 mm");
  EXPECT_EQ(printability(validate(box), m, 10), "printable: closed, manifold, no crossings, thinnest wall 2.5 m");
}

TEST(Measures, OfRegularTriangles) {
  const MeshMeasures m = measures_of(shapes::icosphere(0, 2));
  EXPECT_NEAR(m.smallest_angle, 60, 1e-9);
  EXPECT_NEAR(m.largest_angle, 60, 1e-9);
  EXPECT_NEAR(m.worst_aspect, 1, 1e-9);
  EXPECT_NEAR(m.median_edge, 2 / std::sin(2 * std::numbers::pi / 5), 1e-9); // of an icosahedron of radius 2
}

TEST(Measures, WallsOfBallsAndShells) {
  const double radius = 2;
  const TriangleMesh ball = shapes::icosphere(4, radius);
  const MeshMeasures m = measures_of(ball);
  ASSERT_TRUE(m.thinnest_wall);
  EXPECT_LT(*m.thinnest_wall, 2 * radius);
  EXPECT_GT(*m.thinnest_wall, 0.995 * 2 * radius); // triangles lie below the sphere
  const MeshMeasures shell = measures_of(shapes::hollow_sphere(4, 2, 1.9));
  ASSERT_TRUE(shell.thinnest_wall);
  EXPECT_NEAR(*shell.thinnest_wall, 0.1, 0.01);
  const MeshMeasures tube = measures_of(shapes::torus(10, 1, 200, 60));
  ASSERT_TRUE(tube.thinnest_wall);
  EXPECT_NEAR(*tube.thinnest_wall, 2, 0.02);
  EXPECT_NEAR(std::abs(tube.thinnest_place.x * tube.thinnest_place.x + tube.thinnest_place.y * tube.thinnest_place.y),
              100, 25);
}

TEST(Measures, SpecksAndFoldsAreNoWalls) {
  const TriangleMesh ball = shapes::icosphere(5, 2); // 20,480 triangles with edges of 0.06
  const auto with_flake = [&](double size) {
    return shapes::joined(ball, shapes::box({5, 0, 0}, {5 + size, size, 1e-6}));
  };
  const double flake = *measures_of(with_flake(0.5)).thinnest_wall,
               speck = *measures_of(with_flake(0.05)).thinnest_wall;
  EXPECT_NEAR(flake, 1e-6, 1e-8);
  EXPECT_GT(speck, 3.98);
}

TEST(Measures, FarAwayAndInsideOut) {
  const TriangleMesh plate = shapes::box({512000, 5412000, 300}, {512003, 5412004, 300.001});
  ASSERT_TRUE(measures_of(plate).thinnest_wall);
  EXPECT_NEAR(*measures_of(plate).thinnest_wall, 0.001, 1e-7);
  const TriangleMesh inward = shapes::flipped(plate);
  ASSERT_TRUE(measures_of(inward).thinnest_wall);
  EXPECT_NEAR(*measures_of(inward).thinnest_wall, 0.001, 1e-7);
  EXPECT_EQ(printability(validate(inward), measures_of(inward), 0), "not printable: triangles look inward");
}

TEST(Measures, WhatHasNoWalls) {
  EXPECT_FALSE(measures_of(shapes::grid(3, 3)).thinnest_wall);
  EXPECT_EQ(printability(validate(shapes::grid(3, 3)), measures_of(shapes::grid(3, 3)), 0),
            "not printable: 12 boundary edges");
  // No two sides of a regular tetrahedron are within 45° of parallel.
  const TriangleMesh pyramid = {
      {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}}, {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}}, {}, {}};
  ASSERT_GT(validate(pyramid).volume, 0);
  EXPECT_FALSE(measures_of(pyramid).thinnest_wall);
  EXPECT_EQ(printability(validate(pyramid), measures_of(pyramid), 0), "printable: closed, manifold, no crossings");
  EXPECT_EQ(measures_of(TriangleMesh{}).wall_rays, 0u);
  EXPECT_EQ(printability(validate({}), measures_of({}), 0), "not printable: no triangle");
  const TriangleMesh crossing = shapes::joined(shapes::box({0, 0, 0}, {2, 2, 2}), shapes::box({1, 1, 1}, {3, 3, 3.5}));
  EXPECT_THAT(printability(validate(crossing), measures_of(crossing), 0), HasSubstr("crossings"));
  EXPECT_THAT(printability(validate(crossing, {.self_intersections = false}), measures_of(crossing), 0),
              HasSubstr("printable: closed, manifold, crossings not looked for"));
}

TEST(Measures, FewerRaysAndAnyNumberOfThreads) {
  const TriangleMesh mesh = shapes::torus(10, 1, 200, 60); // 24,000 triangles
  EXPECT_EQ(measures_of(mesh, {.most_rays = 5000}).wall_rays, 4800u);
  EXPECT_FALSE(measures_of(mesh, {.most_rays = 0}).thinnest_wall);
  const MeshMeasures one = measures_of(mesh, {.threads = 1}), four = measures_of(mesh, {.threads = 4});
  EXPECT_EQ(one.thinnest_wall, four.thinnest_wall);
  EXPECT_EQ(one.thinnest_place, four.thinnest_place);
  EXPECT_EQ(to_json(validate(mesh), one, 0), to_json(validate(mesh), four, 0));
}

TEST(Measures, AsJson) {
  const TriangleMesh box = shapes::box({0, 0, 0}, {3, 4, 0.25});
  const auto json = nlohmann::json::parse(to_json(validate(box), measures_of(box), 0.001));
  EXPECT_EQ(json["vertices"], 8);
  EXPECT_EQ(json["unit_metres"], 0.001);
  EXPECT_NEAR(json["thinnest_wall"].get<double>(), 0.25, 1e-9);
  EXPECT_NEAR(json["edges"]["longest"].get<double>(), 5, 1e-12);
  EXPECT_THAT(json["printability"].get<std::string>(), HasSubstr("0.25 mm"));
}

} // namespace
} // namespace eigencrust
