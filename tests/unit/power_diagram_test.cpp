// SPDX-License-Identifier: GPL-3.0-or-later
#include "crusts/power_diagram.h"

#include <gtest/gtest.h>

#include <set>

#include "clouds.h"

namespace eigencrust {
namespace {

std::vector<Sphere> random_balls(std::size_t n, std::uint64_t seed) {
  clouds::Random random(seed);
  std::vector<Sphere> balls;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3 centre = random.in_box(1);
    balls.push_back({centre, random.uniform(0, 0.4)});
  }
  return balls;
}

double power(const Sphere& ball, const Vec3& p) { return squared_norm(p - ball.centre) - ball.radius * ball.radius; }

TEST(PowerDiagram, CornersAreNearestToTheTwoBallsOfTheirFacet) {
  const auto balls = random_balls(200, 3);
  const PowerDiagram diagram = power_diagram(balls);
  std::size_t corners = 0;
  for (std::size_t f = 0; f < diagram.facets.size(); ++f)
    for (const std::uint32_t v : diagram.polygon(f)) {
      const Vec3& p = diagram.vertices[v];
      if (norm(p) > 10) continue; // far away all distances are about equal
      ++corners;
      const auto [a, b] = diagram.facets[f];
      EXPECT_NEAR(power(balls[a], p), power(balls[b], p), 1e-9);
      for (const Sphere& other : balls) EXPECT_GE(power(other, p), power(balls[a], p) - 1e-9);
    }
  EXPECT_GT(corners, 500u);
}

TEST(PowerDiagram, PolygonsTurnCounterClockwiseSeenFromTheSecondBall) {
  const auto balls = random_balls(200, 4);
  const PowerDiagram diagram = power_diagram(balls);
  std::size_t polygons = 0;
  for (std::size_t f = 0; f < diagram.facets.size(); ++f) {
    const auto polygon = diagram.polygon(f);
    Vec3 area;
    for (std::size_t k = 2; k < polygon.size(); ++k)
      area = area + cross(diagram.vertices[polygon[k - 1]] - diagram.vertices[polygon[0]],
                          diagram.vertices[polygon[k]] - diagram.vertices[polygon[0]]);
    if (norm(area) < 1e-6) continue;
    ++polygons;
    const auto [a, b] = diagram.facets[f];
    EXPECT_GT(dot(area, balls[b].centre - balls[a].centre), 0);
  }
  EXPECT_GT(polygons, 300u);
}

TEST(PowerDiagram, BallsWithoutACellAreInNoFacet) {
  auto balls = random_balls(50, 5);
  balls.push_back({balls[7].centre, balls[7].radius / 2});
  for (const auto& facet : power_diagram(balls).facets)
    for (const std::uint32_t ball : facet) EXPECT_NE(ball, 50u);
}

} // namespace
} // namespace eigencrust
