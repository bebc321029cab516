// SPDX-License-Identifier: GPL-3.0-or-later
// Points named again and again on one cloud.
#include <eigencrust/io.h>
#include <eigencrust/session.h>
#include <gmock/gmock.h>

#include <numbers>

#include "clouds.h"
#include "support.h"

namespace eigencrust {
namespace {

using clouds::Points;
constexpr double ball = 4 * std::numbers::pi / 3;

/// Of samples on two spheres, one within the other, nothing says whether the inner one bounds a cavity or a ball.
PointCloud hollow() { return clouds::cloud_of(clouds::joined(clouds::sphere(4000), clouds::sphere(1000, 0.5))); }

double volume(const Result& result) {
  EXPECT_THAT(result.report.broken_guarantees, testing::IsEmpty());
  EXPECT_TRUE(result.report.mesh.closed() && result.report.mesh.manifold() && result.report.mesh.oriented());
  return result.report.mesh.volume / ball;
}

/// A deep cup, its hollow so thinly sampled that the mouth seems closed.
PointCloud cup(double height) {
  Points points;
  int turn = 0;
  const auto ring = [&](double r, double z, double step) {
    const int n = std::max(6, static_cast<int>(2 * std::numbers::pi * r / step));
    ++turn;
    for (int i = 0; i < n; ++i) {
      const double u = 2 * std::numbers::pi * (i + 0.5 * (turn % 2)) / n;
      points.push_back({r * std::cos(u), r * std::sin(u), z});
    }
  };
  constexpr double dense = 0.1, thin = 0.4;
  for (int i = 0; i <= std::lround(height / dense); ++i) ring(1, dense * i, dense);
  for (int i = 1; i < 10; ++i) ring(1 - dense * i, 0, dense);
  for (int i = 0; i < 2; ++i) ring(0.96 - dense * i, height, dense);
  for (int i = 0; 0.25 + thin * i < height - dense; ++i) ring(0.8, 0.25 + thin * i, thin);
  ring(0.4, 0.25, thin);
  return clouds::cloud_of(points);
}

TEST(Session, PointsNamedOutsideOpenACup) {
  constexpr double height = 4, solid = std::numbers::pi * height,
                   open = solid - std::numbers::pi * 0.64 * (height - 0.25);
  const PointCloud cloud = cup(height);
  Session session(cloud);
  const Points hollow{{0, 0, 1}, {0, 0, 2}, {0, 0, 3}};
  EXPECT_GT(session.label({}, {}).report.mesh.volume, 0.85 * solid);
  const Result one = session.label(Points{{0, 0, 2}}, {}), three = session.label(hollow, {});
  volume(three); // sound
  EXPECT_LT(one.report.mesh.volume, 0.8 * solid);
  EXPECT_LT(three.report.mesh.volume, open + 0.1 * solid);
  EXPECT_GT(three.report.mesh.volume, open - 0.1 * solid);
  Options options;
  options.outside_points = hollow;
  EXPECT_NEAR(reconstruct(cloud, options).report.mesh.volume, three.report.mesh.volume, 0.05 * solid);
}

TEST(Session, APointKeepsACavityAndAnotherTheShell) {
  Session session(hollow());
  EXPECT_NEAR(volume(session.label(Points{{0, 0, 0}}, Points{{0.75, 0, 0}})), 1 - 0.125, 0.02);
  EXPECT_NEAR(volume(session.label({}, Points{{0, 0, 0}})), 1, 0.02); // the cavity is filled
}

TEST(Session, DoesWhatANewRunDoes) {
  const PointCloud cloud = hollow();
  Session session(cloud);
  for (const auto& [outside, inside] : std::vector<std::pair<Points, Points>>{
           {{}, {}}, {{{0, 0, 0}}, {{0.75, 0, 0}}}, {{}, {{0, 0, 0}, {0, 0.7, 0}}}}) {
    Options options;
    options.outside_points = outside;
    options.inside_points = inside;
    const Result anew = reconstruct(cloud, options), kept = session.label(outside, inside);
    EXPECT_NEAR(volume(kept), volume(anew), 0.01);
    EXPECT_EQ(kept.report.options.outside_points, outside);
    EXPECT_EQ(kept.labels.size(), session.tetrahedralization().tetrahedra.size());
  }
}

TEST(Session, RemembersNothingOfEarlierCalls) {
  Session session(hollow());
  const Points middle{{0, 0, 0}}, shell{{0.75, 0, 0}};
  const Result first = session.label(middle, shell);
  session.label({}, middle);
  const Result again = session.label(middle, shell);
  EXPECT_EQ(first.mesh.vertices, again.mesh.vertices);
  EXPECT_EQ(first.mesh.triangles, again.mesh.triangles);
  EXPECT_EQ(first.labels.raw(), again.labels.raw());
}

TEST(Session, WithoutPointsItIsTheSameRun) {
  const PointCloud cloud = clouds::cloud_of(clouds::jittered(clouds::torus(1, 0.4, 60, 30), 0.01, 3));
  const Result anew = reconstruct(cloud);
  Session session(cloud);
  const Result kept = session.label({}, {});
  EXPECT_EQ(kept.mesh.vertices, anew.mesh.vertices);
  EXPECT_EQ(kept.mesh.triangles, anew.mesh.triangles);
  EXPECT_EQ(kept.labels.raw(), anew.labels.raw());
}

TEST(Session, RefusesWhatCannotBe) {
  Session session(hollow());
  const Points middle{{0, 0, 0}};
  EXPECT_THROW(session.label(middle, middle), Error);
  EXPECT_THROW(session.label({}, Points{{5, 5, 5}}), Error);
  EXPECT_NO_THROW(session.label(middle, {})); // and goes on
}

TEST(Session, NamingAPointOnTheBunnyDoesNotTriangulateAgain) {
  const auto file = data_path("bunny/bunny_raw.ply");
  EIGENCRUST_NEED_DATA(file);
  const PointCloud cloud = read_point_cloud(file);
  const Result anew = reconstruct(cloud);
  Session session(cloud);
  const Result named = session.label({}, Points{anew.report.mesh.bounds.centre()});
  EXPECT_EQ(named.report.mesh.components, 1u);
  EXPECT_EQ(named.report.mesh.genus, anew.report.mesh.genus);
  EXPECT_NEAR(named.report.mesh.volume / anew.report.mesh.volume, 1, 0.001);
  for (const StageReport& stage : named.report.stages)
    for (const char* costly : {"samples", "delaunay", "stars", "sample_model", "pole_graph", "partition_poles"})
      EXPECT_NE(stage.name, costly);
}

} // namespace
} // namespace eigencrust
