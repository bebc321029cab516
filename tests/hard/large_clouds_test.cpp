// SPDX-License-Identifier: GPL-3.0-or-later
// Whole runs on clouds that take several blocks in every stage, with more threads than the machine may have. The tests
// of scripts/test.sh run these once more with sanitizers.
#include <eigencrust/eigencrust.h>
#include <eigencrust/session.h>
#include <gmock/gmock.h>

#include "clouds.h"

namespace eigencrust {
namespace {

using clouds::Points;
constexpr double ball = 4 * std::numbers::pi / 3;

Options on_three_threads() {
  Options options;
  options.threads = 3;
  return options;
}

double count_of(const Report& report, const std::string& stage, const std::string& name) {
  for (const StageReport& s : report.stages)
    for (const auto& [key, value] : s.counts)
      if (s.name == stage && key == name) return value;
  ADD_FAILURE() << "no " << name << " of " << stage;
  return 0;
}

/// Closed, manifold and oriented by the run's own count and by a fresh one.
MeshSummary sound(const Result& result) {
  EXPECT_THAT(result.report.broken_guarantees, testing::IsEmpty());
  const MeshSummary m = validate(result.mesh, {.self_intersections = false});
  EXPECT_TRUE(m.closed() && m.manifold() && m.oriented());
  EXPECT_EQ(m.triangles, result.report.mesh.triangles);
  return m;
}

TEST(LargeClouds, NoisyAndCleanBodiesAmongOutliers) {
  const Points clean = clouds::jittered(clouds::torus(1, 0.4, 200, 80), 0.004, 3);
  const Points noisy = clouds::jittered(clouds::sphere(24000, 0.8, {3, 0, 0}), 0.04, 4);
  const Points points = clouds::joined(clouds::joined(clean, noisy), clouds::random_box(800, 5, 3));
  Options options = on_three_threads();
  options.point_results = true;
  options.smooth = 1;
  const Result result = reconstruct(clouds::cloud_of(points), options);
  // More than one block of 16384 items, and more than one part of 65536 nodes of the cut.
  EXPECT_GT(result.tetrahedralization.sample_count, 2 * 16384u);
  EXPECT_GT(count_of(result.report, "minimum_cut", "undecided"), 2 * 65536);
  const MeshSummary m = sound(result);
  EXPECT_EQ(m.components, 2u);
  EXPECT_EQ(m.genus, 1);
  EXPECT_NEAR(m.volume / (2 * std::numbers::pi * std::numbers::pi * 0.16 + 0.512 * ball), 1, 0.02);
  const auto inliers = static_cast<double>(std::count(result.inlier.begin(), result.inlier.end(), 1));
  EXPECT_NEAR(inliers / static_cast<double>(clean.size() + noisy.size()), 1, 0.02);
}

TEST(LargeClouds, SessionOfSeveralEdits) {
  Session session(clouds::cloud_of(clouds::joined(clouds::sphere(26000), clouds::sphere(8000, 0.5))),
                  on_three_threads());
  const Points middle{{0, 0, 0}}, shell{{0.75, 0, 0}};
  const auto volume = [](const Result& result) { return sound(result).volume / ball; };
  const Result cavity = session.label(middle, shell);
  EXPECT_NEAR(volume(cavity), 1 - 0.125, 0.01);
  EXPECT_NEAR(volume(session.label({}, middle)), 1, 0.01);
  EXPECT_NEAR(volume(session.label(middle, {})), 1 - 0.125, 0.01);
  const Result again = session.label(middle, shell);
  EXPECT_EQ(again.mesh.triangles, cavity.mesh.triangles);
  EXPECT_EQ(again.labels.raw(), cavity.labels.raw());
}

/// Does the line from p to q stay out of the ball?
bool passes(const Vec3& p, const Vec3& q, const Vec3& centre) {
  const Vec3 way = q - p, to = centre - p;
  const double along = std::clamp(dot(to, way) / squared_norm(way), 0.0, 1.0);
  return norm(to - along * way) > 1;
}

/// Two balls a twentieth of their radius apart. Each point was seen from the place that faces it best of those that the
/// other ball does not hide; each hundredth says that it was seen through its own ball.
PointCloud balls_with_sensors() {
  const Vec3 first, second{2.05, 0, 0};
  PointCloud cloud = clouds::cloud_of(clouds::joined(clouds::sphere(18000), clouds::sphere(18000, 1, second)));
  for (const Vec3& direction : clouds::sphere(20)) cloud.sensors.push_back({6.0 * direction, false});
  for (const Vec3& p : cloud.points) {
    const bool is_first = p.x < 1.025;
    const double sign = cloud.sensor_of.size() % 100 == 0 ? -1 : 1;
    double best = 0.5;
    cloud.sensor_of.push_back(PointCloud::no_sensor);
    for (std::uint32_t s = 0; s < cloud.sensors.size(); ++s) {
      const Vec3 way = cloud.sensors[s].place - p;
      const double facing = sign * dot(way, p - (is_first ? first : second));
      if (facing <= best || (sign > 0 && !passes(p, cloud.sensors[s].place, is_first ? second : first))) continue;
      best = facing;
      cloud.sensor_of.back() = s;
    }
  }
  return cloud;
}

TEST(LargeClouds, LinesOfSight) {
  const PointCloud cloud = balls_with_sensors();
  const Result result = reconstruct(cloud, on_three_threads());
  const MeshSummary m = sound(result);
  EXPECT_EQ(m.components, 2u);
  EXPECT_EQ(m.genus, 0);
  EXPECT_NEAR(m.volume / (2 * ball), 1, 0.005);
  EXPECT_GT(result.report.sight_lines, 35000u);
  EXPECT_GT(result.report.contradicting_rays, 300u);
  EXPECT_LT(result.report.contradicting_rays, 500u);
}

} // namespace
} // namespace eigencrust
