// SPDX-License-Identifier: GPL-3.0-or-later
// What the robustness benchmark makes its clouds of: bodies, samples, outliers, noise, cuts.
#include <eigencrust/metrics.h>
#include <eigencrust/validate.h>
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>
#include <set>

#include "bodies.h"
#include "cases.h"
#include "clouds.h"
#include "degradations.h"
#include "sampling.h"
#include "shapes.h"
#include "support.h"

namespace eigencrust::bench {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;
using testing::Gt;
using testing::Le;

/// Share of random points of [-2, 2]³ that are inside, times its volume.
double volume_by_darts(const std::function<bool(const Vec3&)>& inside, std::size_t count = 400'000) {
  clouds::Random random(5);
  std::size_t hits = 0;
  for (std::size_t i = 0; i < count; ++i) hits += inside(random.in_box(2));
  return 64 * static_cast<double>(hits) / static_cast<double>(count);
}

TEST(RobustnessBodies, MeshVolumeAndInsideAgree) {
  struct Row {
    const char* name;
    Truth truth;
  };
  for (const auto& [name, truth] :
       {Row{"bumpy", bumpy_sphere({0.2, 0, 0}, 5)}, Row{"torus", torus(1, 0.4)}, Row{"nested", nested_spheres(1.5, 1)},
        Row{"pair", side_by_side(bumpy_sphere({-0.8, 0, 0}, 5), torus(0.4, 0.2, {1.2, 0, 0}))}}) {
    SCOPED_TRACE(name);
    const MeshSummary summary = validate(*truth.mesh, {.self_intersections = false});
    EXPECT_TRUE(summary.closed() && summary.manifold() && summary.oriented());
    EXPECT_EQ(summary.components, truth.components);
    EXPECT_EQ(summary.genus, truth.genus);
    EXPECT_NEAR(summary.volume / truth.volume, 1, 1e-3);
    EXPECT_NEAR(volume_by_darts(truth.inside) / truth.volume, 1, 0.03);
  }
}

TEST(RobustnessBodies, BumpySphereIsBetween0_9And1_1) {
  const Truth truth = bumpy_sphere({1, 2, 3}, 5);
  double least = 2, most = 0;
  for (const Vec3& p : truth.mesh->vertices) {
    const double r = distance(p, {1, 2, 3});
    EXPECT_NEAR(r, bumpy_radius((1 / r) * (p - Vec3{1, 2, 3})), 1e-12);
    least = std::min(least, r);
    most = std::max(most, r);
  }
  EXPECT_THAT(least, testing::AllOf(testing::Ge(0.9), Le(0.95)));
  EXPECT_THAT(most, testing::AllOf(testing::Ge(1.05), Le(1.1)));
}

TEST(RobustnessBodies, BallWithSheetIsTheOuterSurfaceOfBoth) {
  const double h = 0.2;
  const Truth truth = ball_with_sheet(h);
  EXPECT_NEAR(volume_by_darts(truth.inside, 1'000'000) / truth.volume, 1, 0.02);
  // No vertex deep within the other body, none that belongs to no triangle.
  std::set<std::uint32_t> used;
  for (const auto& t : truth.mesh->triangles) used.insert(t.begin(), t.end());
  EXPECT_EQ(used.size(), truth.mesh->vertices.size());
  for (const Vec3& p : truth.mesh->vertices) {
    const bool in_plate = std::fabs(p.y) < h / 2 - 0.02 && std::fabs(p.x) < 1.48 && std::fabs(p.z) < 1.48;
    EXPECT_TRUE(!in_plate && norm(p) > 0.98) << p.x << " " << p.y << " " << p.z;
  }
}

TEST(RobustnessBodies, InwardMeshIsTurned) {
  const Truth truth = truth_of(shapes::flipped(shapes::box({0, 0, 0}, {1, 2, 3})));
  EXPECT_NEAR(truth.volume, 6, 1e-12);
  EXPECT_NEAR(validate(*truth.mesh).volume, 6, 1e-12);
}

TEST(RobustnessSampling, MedianSpacingCountsEqualPointsOnce) {
  // 0, 1, 3: nearest others at 1, 1, 2. Were the second 0 counted, the median would be 0 or 0.5.
  EXPECT_DOUBLE_EQ(median_spacing(std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {3, 0, 0}, {0, 0, 0}}, 1), 1);
  EXPECT_EQ(median_spacing(std::vector<Vec3>{{1, 2, 3}}, 1), 0);
}

TEST(RobustnessSampling, EvenSamplesKeepApartAndLeaveNoGap) {
  const TriangleMesh sphere = shapes::icosphere(5);
  const std::vector<Vec3> points = even_samples(sphere, 3000, 7);
  EXPECT_NEAR(static_cast<double>(points.size()), 3000, 300);
  double closest = 10;
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) closest = std::min(closest, distance(points[i], points[j]));
  const double spacing = median_spacing(points, 1);
  EXPECT_GT(closest, 0.8 * spacing); // random samples come as near as 0.01 of it
  for (const Vec3& v : sphere.vertices) {
    double gap = 10;
    for (const Vec3& p : points) gap = std::min(gap, distance(v, p));
    EXPECT_LT(gap, 1.6 * spacing);
  }
  EXPECT_EQ(fingerprint(points), fingerprint(even_samples(sphere, 3000, 7)));
  EXPECT_NE(fingerprint(points), fingerprint(even_samples(sphere, 3000, 8)));
}

TEST(RobustnessSampling, EvenSamplesFollowTheRadius) {
  // Three times the radius for x > 0: a ninth of the points there.
  const auto radius = [](const Vec3& p) { return p.x > 0 ? 3.0 : 1.0; };
  const std::vector<Vec3> points = even_samples(shapes::icosphere(5), 4000, 1, radius);
  const auto right = std::count_if(points.begin(), points.end(), [](const Vec3& p) { return p.x > 0; });
  EXPECT_NEAR(static_cast<double>(points.size() - right) / static_cast<double>(right), 9, 1.2);
  EXPECT_NEAR(static_cast<double>(points.size()), 4000, 400);
}

TEST(RobustnessSampling, ThinningKeepsTheFirst) {
  EXPECT_THAT(thinned({{0, 0, 0}, {0.9, 0, 0}, {1.5, 0, 0}, {2.4, 0, 0}, {2.6, 0, 0}}, 1),
              ElementsAre(Vec3{0, 0, 0}, Vec3{1.5, 0, 0}, Vec3{2.6, 0, 0}));
}

TEST(RobustnessSampling, VertexAreasShareTheTriangles) {
  const std::vector<double> areas = vertex_areas(shapes::grid(1, 1)); // two triangles of area 1/2
  EXPECT_THAT(areas, ElementsAre(DoubleNear(1.0 / 3, 1e-12), DoubleNear(1.0 / 6, 1e-12), DoubleNear(1.0 / 6, 1e-12),
                                 DoubleNear(1.0 / 3, 1e-12)));
}

TEST(RobustnessSampling, FingerprintSeesOrderAndLastBit) {
  const std::vector<Vec3> a{{1, 2, 3}, {4, 5, 6}}, swapped{{4, 5, 6}, {1, 2, 3}};
  const std::vector<Vec3> near_a{{1, 2, 3}, {4, 5, std::nextafter(6, 7)}};
  EXPECT_NE(fingerprint(a), fingerprint(swapped));
  EXPECT_NE(fingerprint(a), fingerprint(near_a));
  // FNV-1a of 24 zero bytes, by multiplying 24 times: the clouds of another machine can be told apart.
  std::uint64_t expected = 0xcbf29ce484222325;
  for (int i = 0; i < 24; ++i) expected *= 0x100000001b3;
  EXPECT_EQ(fingerprint(std::vector<Vec3>{{0, 0, 0}}), expected);
}

class RobustnessOutliers : public testing::Test {
 protected:
  const std::vector<Vec3> samples = clouds::sphere(2000, 2, {10, 0, 0}); // box [8, 12] × [-2, 2]²
};

TEST_F(RobustnessOutliers, OfABoxFillIt) {
  Box3 box;
  for (const Vec3& p : outliers(samples, 20'000, {1, OutlierPlace::box, 3}, 1)) box.add(p);
  EXPECT_NEAR(box.min.x, 4, 0.02);
  EXPECT_NEAR(box.max.x, 16, 0.02);
  EXPECT_NEAR(box.min.y, -6, 0.02);
  EXPECT_NEAR(box.max.z, 6, 0.02);
  EXPECT_LE(box.max.x, 16);
}

TEST_F(RobustnessOutliers, OfAShellSurroundTheSamples) {
  const std::vector<Vec3> points = outliers(samples, 4000, {1, OutlierPlace::shell}, 1);
  Vec3 mean;
  std::size_t outer = 0;
  for (const Vec3& p : points) {
    const double r = distance(p, {10, 0, 0});
    EXPECT_THAT(r, testing::AllOf(Gt(2 * 1.095), testing::Lt(2 * 1.305)));
    outer += r > 2 * 1.2;
    mean = mean + (1.0 / 4000) * (p - Vec3{10, 0, 0});
  }
  EXPECT_LT(norm(mean), 0.15);
  // (1.3³ - 1.2³) / (1.3³ - 1.1³) of the volume.
  EXPECT_NEAR(static_cast<double>(outer) / 4000, 0.542, 0.03);
}

TEST_F(RobustnessOutliers, OfClustersCrowd) {
  const std::vector<Vec3> points = outliers(samples, 400, {1, OutlierPlace::clusters, 1.2}, 1);
  const double sigma = 0.02 * 4 * std::sqrt(3.0); // about: the samples' box is nearly a cube of side 4
  double sum = 0;
  for (std::size_t i = 20; i < 400; ++i) sum += squared_norm(points[i] - points[i - 20]); // every 20th shares one
  EXPECT_NEAR(std::sqrt(sum / 380 / 6), sigma, 0.1 * sigma); // two deviates in each of three coordinates
  EXPECT_GT(distance(points[0], points[1]), 2 * sigma);
}

TEST_F(RobustnessOutliers, AreAppendedAndMoreOfThemBeginWithTheFewer) {
  Scene few = clean_scene(samples, {}, 1), many = few;
  add_outliers(few, {0.1}, 3);
  add_outliers(many, {0.25}, 3);
  ASSERT_EQ(few.cloud.points.size(), 2200u);
  ASSERT_EQ(many.cloud.points.size(), 2500u);
  EXPECT_EQ(few.true_samples, 2000u);
  EXPECT_TRUE(std::equal(samples.begin(), samples.end(), few.cloud.points.begin()));
  EXPECT_TRUE(std::equal(few.cloud.points.begin(), few.cloud.points.end(), many.cloud.points.begin()));
}

TEST(RobustnessDegradations, NoiseHasThatDeviationInEveryCoordinate) {
  std::vector<Vec3> points(20'000);
  add_noise(points, 0.3, 9);
  Vec3 mean, square;
  for (const Vec3& p : points) {
    mean = mean + (1.0 / 20'000) * p;
    square = square + (1.0 / 20'000) * Vec3{p.x * p.x, p.y * p.y, p.z * p.z};
  }
  EXPECT_LT(norm(mean), 0.01);
  for (const double s : {square.x, square.y, square.z}) EXPECT_NEAR(std::sqrt(s), 0.3, 0.006);
}

TEST(RobustnessDegradations, CutTakesTheFarEnd) {
  std::vector<Vec3> points;
  for (int x : {3, 0, 9, 1, 2}) points.push_back({double(x), 0, 0});
  EXPECT_THAT(rows_before_cut(points, {}, {1, 0, 0}, 0.4), ElementsAre(1, 3, 4));     // 9 and 3 go
  EXPECT_THAT(rows_before_cut(points, {}, {-1, 0, 0}, 0.2), ElementsAre(0, 2, 3, 4)); // 0 goes
  EXPECT_THAT(rows_before_cut(points, {}, {1, 0, 0}, 0), ElementsAre(0, 1, 2, 3, 4));
  // The 9 alone holds half of the weight.
  EXPECT_THAT(rows_before_cut(points, std::vector<double>{1, 1, 4, 1, 1}, {1, 0, 0}, 0.4), ElementsAre(0, 1, 3, 4));
}

TEST(RobustnessDegradations, ScansMoveAsAWhole) {
  const std::vector<Vec3> before = clouds::random_box(6, 1);
  std::vector<Vec3> after = before;
  displace_scans(after, std::vector<std::uint32_t>{0, 1, 0, 2, 1, 0}, 0.5, 1);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(distance(before[i], after[i]), 0.5, 1e-12);
  EXPECT_LT(distance(after[0] - before[0], after[5] - before[5]), 1e-12);
  EXPECT_GT(distance(after[0] - before[0], after[1] - before[1]), 0.01);
}

TEST(RobustnessCases, HaveNamesOfTheirOwnAndCanBeChosen) {
  const std::vector<Case> all = all_cases();
  std::set<std::string> names;
  for (const Case& c : all) {
    EXPECT_TRUE(names.insert(c.name).second) << c.name;
    EXPECT_EQ(c.name.find('/'), std::string::npos) << c.name; // names become file names
    EXPECT_TRUE(c.make != nullptr) << c.name;
  }
  EXPECT_EQ(select_cases(all, {"torus-cut,happy", "horse-cut"}, false).size(), 3u);
  EXPECT_EQ(select_cases(all, {"missing/"}, true).size(), 3u);
  EXPECT_TRUE(select_cases(all, {"happy"}, true).empty()); // large
  EXPECT_THAT(error_of([&] { select_cases(all, {"torus,nonsense"}, false); }), testing::HasSubstr("'nonsense'"));
}

TEST(RobustnessCases, AreTheSameCloudEveryTime) {
  const Case c = select_cases(all_cases(), {"nested+3%"}, true).front();
  std::vector<std::uint64_t> prints;
  for (const unsigned threads : {1u, 3u}) {
    Sources sources("", threads);
    prints.push_back(fingerprint(c.make(sources, c.seed).cloud.points));
  }
  EXPECT_EQ(prints[0], prints[1]);
}

TEST(RobustnessCases, SheetsAreTwoSpacingsThick) {
  Sources sources("", 1);
  for (const Case& c : select_cases(all_cases(), {"bodies/sheet"}, true)) {
    const Scene scene = c.make(sources, c.seed);
    EXPECT_NEAR(0.05 / scene.spacing, 2, 0.1) << c.name;
    const auto first = std::span(scene.cloud.points).first(scene.true_samples);
    const DistanceStatistics off = summarize(distances_to_surface(first, *scene.truth.mesh, 1));
    EXPECT_LT(off.q95, 1e-4) << c.name;
    EXPECT_LT(off.max, 0.01) << c.name; // at the seam the mesh lacks up to a triangle
  }
}

} // namespace
} // namespace eigencrust::bench
