// SPDX-License-Identifier: GPL-3.0-or-later
// The robustness benchmark's ruler, held against results that are wrong in a known way.
#include <eigencrust/io.h>
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "clouds.h"
#include "measures.h"
#include "reference_measures.h"
#include "registration.h"
#include "shapes.h"
#include "support.h"

namespace eigencrust::bench {
namespace {

using testing::ElementsAre;

double value(const Figures& figures, const char* name) { return figures.find(name).value_or(-1); }

Truth sphere_truth(double radius = 1) {
  Truth truth = truth_of(shapes::icosphere(5, radius));
  truth.inside = [radius](const Vec3& p) { return norm(p) < radius; };
  return truth;
}

Scene sphere_scene() {
  Scene scene;
  scene.cloud.points = clouds::sphere(3000);
  scene.true_samples = 3000;
  scene.spacing = 0.06;
  scene.truth = sphere_truth();
  return scene;
}

TEST(RobustnessMeasures, GoodResultHasGoodFigures) {
  const Scene scene = sphere_scene();
  const Result result = reconstruct(scene.cloud);
  Figures figures;
  measure(scene, result, 1, figures);
  EXPECT_EQ(value(figures, "components"), 1);
  EXPECT_EQ(value(figures, "genus"), 0);
  EXPECT_EQ(value(figures, "true_samples_kept"), 1);
  EXPECT_EQ(value(figures, "outliers_kept"), 0);
  EXPECT_EQ(value(figures, "far_vertices"), 0);
  EXPECT_EQ(value(figures, "wrong_deep_tetrahedra"), 0);
  EXPECT_GT(value(figures, "deep_tetrahedra"), 1000);
  EXPECT_LT(value(figures, "hausdorff"), 0.1);
  EXPECT_NEAR(value(figures, "volume_error"), 0, 0.01);
}

TEST(RobustnessMeasures, EveryWrongLabelIsCounted) {
  const Scene scene = sphere_scene();
  Result result = reconstruct(scene.cloud);
  Figures before, after;
  measure_deep_tetrahedra(scene, result, 1, before);
  for (Label& label : result.labels.raw()) label = label == Label::inside ? Label::outside : Label::inside;
  measure_deep_tetrahedra(scene, result, 1, after);
  EXPECT_EQ(value(after, "wrong_deep_tetrahedra"), value(before, "deep_tetrahedra"));
  EXPECT_EQ(value(after, "wrong_deep_share"), 1);
}

TEST(RobustnessMeasures, DistancesAreInSpacings) {
  Scene scene = sphere_scene();
  scene.truth = truth_of(shapes::icosphere(4));
  Result result;
  result.mesh = shapes::icosphere(4, 1.12); // two spacings above the truth
  result.mesh.vertices[7] = 1.5 * result.mesh.vertices[7];
  Figures figures;
  measure_distances(scene, result, 1, figures);
  EXPECT_NEAR(value(figures, "to_truth_mean"), 2, 0.05);
  EXPECT_NEAR(value(figures, "from_truth_mean"), 2, 0.05);
  EXPECT_NEAR(value(figures, "hausdorff"), 0.68 / 0.06, 0.1); // the one vertex, though no sample hits it
  scene.spacing = 0.1;                                        // now only that one is farther than 2 spacings
  Figures again;
  measure_distances(scene, result, 1, again);
  EXPECT_DOUBLE_EQ(value(again, "far_vertices"), 1.0 / static_cast<double>(result.mesh.vertices.size()));
}

TEST(RobustnessMeasures, KeptCountsDistinctTrueSamples) {
  Scene scene;
  scene.true_samples = 6; // rows 0 to 5; row 3 equals row 2 and is no sample of its own
  Result result;
  result.tetrahedralization.source =
      IndexedArray<SampleIndex, std::uint32_t>(std::vector<std::uint32_t>{0, 1, 2, 4, 5, 6, 7});
  const std::vector<std::uint32_t> source{0, 2, 4, 7};
  result.mesh.vertex_attributes.push_back(make_attribute("source_index", source));
  Figures figures;
  measure_kept(scene, result, figures);
  EXPECT_DOUBLE_EQ(value(figures, "true_samples_kept"), 3.0 / 5);
  EXPECT_DOUBLE_EQ(value(figures, "outliers_kept"), 1.0 / 4);
}

TEST(RobustnessMeasures, GenusIsOfAsManyBodiesAsThereShouldBe) {
  Scene scene;
  Result result;
  result.report.mesh.components = 2;
  result.report.mesh.genus = 4;
  result.report.mesh.component_list = {{100, 200, 0, 1}, {10, 20, -4, 3}};
  Figures one, two;
  measure_topology(scene, result, one);
  scene.truth.components = 2;
  measure_topology(scene, result, two);
  EXPECT_EQ(value(one, "genus"), 1); // the speck's handles do not count
  EXPECT_EQ(value(two, "genus"), 4);
  EXPECT_EQ(value(one, "genus_total"), 4);
}

TEST(RobustnessMeasures, PatchIsTheLidOverTheHole) {
  // The unit sphere cut at z = 0.8; the lid is flat. A lid point at distance r from the axis is
  // 1 - sqrt(0.64 + r²) below the sphere; 5 % of the lid have r² < 0.05 · 0.36.
  Scene scene;
  scene.spacing = 0.02;
  scene.truth = truth_of(shapes::icosphere(6));
  TriangleMesh mesh = *scene.truth.mesh;
  for (Vec3& p : mesh.vertices)
    if (p.z > 0.8)
      p.z = 0.8;
    else
      scene.cloud.points.push_back(p);
  scene.true_samples = scene.cloud.points.size();
  Figures figures;
  measure_patch(scene, mesh, 1, figures);
  const double rim = 0.6 - 0.06; // the patch begins 3 spacings from the samples
  EXPECT_NEAR(value(figures, "patch_q95_of_diagonal"), (1 - std::sqrt(0.64 + 0.05 * rim * rim)) / std::sqrt(12.0),
              2e-3);
  EXPECT_NEAR(value(figures, "patch_area"), rim * rim / (0.36 + 2 * 1.8), 0.01);
}

TEST(RobustnessMeasures, NoPatchIsNoError) {
  const Scene scene = sphere_scene();
  Figures figures;
  measure_patch(scene, *scene.truth.mesh, 1, figures);
  EXPECT_EQ(value(figures, "patch_area"), 0);
  EXPECT_EQ(value(figures, "patch_q95_of_diagonal"), 0);
}

TEST(RobustnessMeasures, ToleranceIsMeasuredBothWays) {
  // The reference has a second sphere that the mesh lacks: half of it is out of reach.
  const TriangleMesh mesh = shapes::icosphere(4);
  const TriangleMesh reference = shapes::joined(mesh, shapes::icosphere(4, 1, {5, 0, 0}));
  Figures figures;
  measure_tolerance(mesh, reference, 0.1, 1, figures);
  EXPECT_EQ(value(figures, "within_tolerance_of_reference"), 1);
  EXPECT_NEAR(value(figures, "reference_within_tolerance"), 0.5, 0.01);
}

/// A sheet with a high hump, a low one with a small step on its slope, and ripples.
TriangleMesh hills() {
  TriangleMesh mesh = shapes::grid(40, 20);
  for (Vec3& p : mesh.vertices) {
    const auto hump = [&](double x, double height) {
      return height * std::exp(-((p.x - x) * (p.x - x) + (p.y - 10) * (p.y - 10)) / 20);
    };
    p.z = hump(10, 5) + hump(30, 3) + 0.2 * std::fabs(std::sin(p.x * 1.3 + p.y));
  }
  return mesh;
}

TEST(RobustnessMeasures, PeaksAreTheProminentOnes) {
  const TriangleMesh mesh = hills();
  const std::vector<std::uint32_t> tops = peaks(mesh, {0, 0, 1}, 2);
  ASSERT_EQ(tops.size(), 2u);
  EXPECT_NEAR(mesh.vertices[tops[0]].x, 10, 1.5);
  EXPECT_NEAR(mesh.vertices[tops[1]].x, 30, 1.5); // not a ripple beside the highest
  EXPECT_EQ(peaks(shapes::icosphere(3), {0, 1, 0}, 2).size(), 1u);
}

TEST(RobustnessMeasures, TipsTellWhichOneIsGone) {
  TriangleMesh mesh = hills();
  for (Vec3& p : mesh.vertices) p = {p.x, p.z, p.y}; // up is y
  TriangleMesh cut = mesh;
  for (Vec3& p : cut.vertices)
    if (p.x > 20) p.y = std::min(p.y, 1.0); // the lower hump loses 2 of its 3
  Figures figures;
  measure_tips(cut, mesh, 1.5, 10, 1, figures);
  EXPECT_NEAR(value(figures, "tip_1"), 0, 1e-6);
  EXPECT_NEAR(value(figures, "tip_2"), 10 * 2.1, 2);
}

Similarity turned(double scale, double degrees) {
  Similarity s;
  const double a = degrees * std::numbers::pi / 180;
  s.scale = scale;
  s.rotation = {Vec3{std::cos(a), -std::sin(a), 0}, Vec3{std::sin(a), std::cos(a), 0}, Vec3{0, 0, 1}};
  s.translation = {5, -7, 11};
  return s;
}

/// Three boxes without any symmetry, not joined.
TriangleMesh crooked() {
  return shapes::joined(shapes::joined(shapes::box({0, 0, 0}, {3, 1, 1}), shapes::box({0, 1.1, 0}, {1, 2, 2})),
                        shapes::box({2, 0, 1.1}, {2.5, 0.7, 1.9}));
}

TEST(RobustnessRegistration, InverseUndoes) {
  const Similarity s = turned(2.5, 30), back = s.inverse();
  const Vec3 p{1, 2, 3};
  EXPECT_LT(distance(back.apply(s.apply(p)), p), 1e-12);
  EXPECT_LT(distance(s.apply({1, 0, 0}), Vec3{5 + 2.5 * std::cos(std::numbers::pi / 6), -7 + 1.25, 11}), 1e-12);
}

TEST(RobustnessRegistration, FitIsExactForExactPairs) {
  const Similarity s = turned(0.1, 200);
  const std::vector<Vec3> from{{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 0, 3}, {1, 1, 1}};
  std::vector<Vec3> to;
  for (const Vec3& p : from) to.push_back(s.apply(p));
  const Similarity fit = fit_similarity(from, to);
  EXPECT_NEAR(fit.scale, 0.1, 1e-12);
  EXPECT_LT(distance(fit.apply({-3, 4, 5}), s.apply({-3, 4, 5})), 1e-12);
}

TEST(RobustnessRegistration, LaysAModelOntoItsTurnedCopy) {
  const TriangleMesh model = crooked();
  const Similarity s = turned(0.01, 130);
  TriangleMesh scan = model;
  for (Vec3& p : scan.vertices) p = s.apply(p);
  const Similarity fit = lay_onto(model, scan, 1);
  for (const Vec3& p : model.vertices) EXPECT_LT(distance(fit.apply(p), s.apply(p)), 0.01 * 0.02);
}

TEST(RobustnessRegistration, ModelFiguresShowASpike) {
  TriangleMesh scan = shapes::joined(crooked(), shapes::box({1.5, 0.4, 1}, {1.52, 0.42, 1.5})); // a needle of 0.5
  for (Vec3& p : scan.vertices) p = turned(1, 40).apply(p);
  Figures figures;
  measure_against_model(scan, crooked(), 100, 1, figures);
  EXPECT_NEAR(value(figures, "fitted_scale"), 1, 0.01);
  EXPECT_NEAR(value(figures, "model_max"), 50, 3); // 0.5 in hundredths
  EXPECT_LT(value(figures, "model_mean"), 1);
  EXPECT_LT(value(figures, "model_from_max"), 3); // the model lacks nothing
}

} // namespace
} // namespace eigencrust::bench
