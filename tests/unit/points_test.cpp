// SPDX-License-Identifier: GPL-3.0-or-later
// classify_samples and orient_samples on surfaces whose every figure is known.
#include <eigencrust/stages.h>
#include <gmock/gmock.h>

#include "clouds.h"
#include "points/classify.h"
#include "points/orient.h"
#include "shapes.h"

namespace eigencrust {
namespace {

using clouds::Points;

/// A surface on the first samples, and samples beside it. The stages look at nothing else.
struct Scene {
  Tetrahedralization t;
  Surface surface;
};
Scene scene_of(const TriangleMesh& mesh, const Points& others) {
  Scene scene;
  scene.surface.mesh = mesh;
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) scene.surface.sample_of.push_back(SampleIndex{v});
  scene.t.positions = IndexedArray<VertexIndex, Vec3>(clouds::joined(mesh.vertices, others));
  scene.t.sample_count = scene.t.positions.size();
  return scene;
}

struct Answer {
  Classification classes;
  std::vector<Vec3> normals;
};
/// Even samples, none isolated; ℓ is 1.2 deviations.
SampleModel even_model(const Scene& scene, const SampleLengths& grid_spacing) {
  SampleModel model;
  model.spacing = SampleLengths(scene.t.sample_count, 1);
  model.isolated = SampleLengths(scene.t.sample_count, 0);
  model.noise = SampleLengths(scene.t.sample_count, 0);
  for (SampleIndex s{0}; s.value < grid_spacing.size(); ++s.value) model.noise[s] = grid_spacing[s] / 1.2f;
  model.input_noise = model.noise;
  return model;
}
Answer ask(const Scene& scene, const SampleModel& model, const SampleLengths& grid_spacing, unsigned threads = 1) {
  const Threads team(threads);
  Answer answer;
  answer.classes = classify_samples(scene.t, scene.surface, model, team);
  answer.normals = orient_samples(scene.t, scene.surface, answer.classes, grid_spacing, team).raw();
  return answer;
}
Answer ask(const Scene& scene, const SampleLengths& grid_spacing = {}) {
  return ask(scene, even_model(scene, grid_spacing), grid_spacing);
}
/// As the samples are.
SampleModel measured(const Scene& scene) { return sample_model(scene.t.positions.raw(), 0.0, Threads(1)); }

MATCHER_P(IsAbout, wanted, "") { return distance(arg, wanted) < 1e-9; }
bool is_nan(const Vec3& v) { return std::isnan(v.x) && std::isnan(v.y) && std::isnan(v.z); }

// The middle of a flat 10 × 10 grid of spacing 1 is vertex (5, 5).
constexpr std::uint32_t middle = 5 * 11 + 5;
constexpr std::uint32_t grid_vertices = 11 * 11;

TEST(Classify, DistanceToTheSurfaceInTolerances) {
  // τ is a spacing: at 0.8 above, 1/(1 + 0.64); at 1 the limit; at 2.4, 1/(1 + 5.76).
  const Answer answer = ask(scene_of(shapes::grid(10, 10), {{5.2, 5.3, 0.8}, {5.2, 5.3, -1}, {5.2, 5.3, 2.4}}));
  const auto& confidence = answer.classes.confidence.raw();
  EXPECT_FLOAT_EQ(confidence[middle], 1);
  EXPECT_NEAR(confidence[grid_vertices], 1 / 1.64, 1e-6);
  EXPECT_NEAR(confidence[grid_vertices + 1], 0.5, 1e-6);
  EXPECT_NEAR(confidence[grid_vertices + 2], 1 / 6.76, 1e-6);
  EXPECT_EQ(answer.classes.inlier.raw()[grid_vertices], 1);
  EXPECT_EQ(answer.classes.inlier.raw()[grid_vertices + 2], 0);
}

TEST(Classify, NoiseWidensTheTolerance) {
  const Scene scene = scene_of(shapes::grid(10, 10), {{5.2, 5.3, 2.9}, {5.2, 5.3, 3.1}});
  // ℓ = 1.2 is a deviation of 1, three of which are borne.
  const Answer answer = ask(scene, SampleLengths(scene.t.sample_count, 1.2f));
  EXPECT_EQ(answer.classes.inlier.raw()[grid_vertices], 1);
  EXPECT_EQ(answer.classes.inlier.raw()[grid_vertices + 1], 0);
  EXPECT_THAT(answer.normals[grid_vertices], IsAbout(Vec3{0, 0, 1}));
}

TEST(Classify, ASpikeIsNoInlierAndItsNeighboursAre) {
  TriangleMesh mesh = shapes::grid(10, 10);
  mesh.vertices[middle].z = 3;
  const Answer answer = ask(scene_of(mesh, {{5.1, 5, 2.5}})); // beside the spike, but 2.5 from all else
  for (std::uint32_t v = 0; v < grid_vertices; ++v) {
    EXPECT_EQ(answer.classes.inlier.raw()[v], v != middle) << v;
    // The spike's sides have no say in the normals around it.
    if (v != middle) {
      EXPECT_THAT(answer.normals[v], IsAbout(Vec3{0, 0, 1}));
    }
  }
  EXPECT_TRUE(is_nan(answer.normals[middle]));
  EXPECT_EQ(answer.classes.inlier.raw()[grid_vertices], 0);
}

TEST(Classify, AChangeOfSpacingIsNoSpike) {
  // Columns at 0, 1, ... 5, then 8, 11, ...: the middle of the neighbours lies aside, in the plane.
  TriangleMesh mesh = shapes::grid(10, 10);
  for (Vec3& p : mesh.vertices) p = {p.x > 5 ? 5 + 3 * (p.x - 5) : p.x, p.y > 5 ? 5 + 3 * (p.y - 5) : p.y, 0};
  const Answer answer = ask(scene_of(mesh, {}));
  EXPECT_THAT(answer.classes.inlier.raw(), testing::Each(1));
}

TEST(Classify, SurfaceMadeOfScatteredSamplesIsNone) {
  // A dense sphere, and a coarse closed surface around it whose vertices fill space rather than lie on anything.
  TriangleMesh shell = shapes::icosphere(2, 3);
  clouds::Random random(4);
  for (Vec3& p : shell.vertices) p = random.uniform(0.6, 1.6) * p;
  const TriangleMesh sphere = shapes::icosphere(5);
  const Scene scene = scene_of(shapes::joined(sphere, shell), {});
  const Answer answer = ask(scene, measured(scene), {});
  std::size_t inliers = 0, of_shell = 0;
  for (std::uint32_t v = 0; v < answer.classes.inlier.size(); ++v)
    (v < sphere.vertices.size() ? inliers : of_shell) += answer.classes.inlier.raw()[v];
  EXPECT_EQ(inliers, sphere.vertices.size());
  EXPECT_LE(of_shell, shell.vertices.size() / 20);
}

TEST(Classify, ASparseSmoothSurfaceIsKept) {
  // Twelve times as sparse, but round.
  const TriangleMesh dense = shapes::icosphere(5), sparse = shapes::icosphere(3, 3, {10, 0, 0});
  const Scene scene = scene_of(shapes::joined(dense, sparse), {});
  EXPECT_THAT(ask(scene, measured(scene), {}).classes.inlier.raw(), testing::Each(1));
}

TEST(Classify, NoSurfaceNoInliers) {
  const Answer answer = ask(scene_of({}, {{0, 0, 0}, {1, 0, 0}}));
  EXPECT_THAT(answer.classes.inlier.raw(), testing::Each(0));
  EXPECT_THAT(answer.classes.confidence.raw(), testing::Each(0.0f));
  EXPECT_TRUE(is_nan(answer.normals[0]));
}

TEST(Orient, SphereInsideOut) {
  for (const double sign : {1.0, -1.0}) {
    const TriangleMesh mesh = sign > 0 ? shapes::icosphere(3) : shapes::flipped(shapes::icosphere(3));
    const Answer answer = ask(scene_of(mesh, {}));
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
      EXPECT_GT(sign * dot(answer.normals[v], mesh.vertices[v]), std::cos(0.02)) << v;
  }
}

TEST(Orient, CornerOfACubeLooksAlongTheDiagonal) {
  // Two triangles meet the corner in one face, one in another: angles make up for it, areas and counts do not.
  const Scene scene = scene_of(shapes::box({-1, -1, -1}, {1, 1, 1}), {});
  const Answer answer = ask(scene, measured(scene), {});
  const double k = 1 / std::sqrt(3.0);
  EXPECT_THAT(answer.normals[0], IsAbout(Vec3{-k, -k, -k}));
  EXPECT_THAT(answer.normals[7], IsAbout(Vec3{k, k, k}));
}

TEST(Orient, CloseSheetsKeepTheirOwnSigns) {
  // A plate 0.1 thick at a spacing of 1, with and without noise.
  TriangleMesh below = shapes::flipped(shapes::grid(10, 10));
  for (Vec3& p : below.vertices) p = {p.x, p.y, -0.1};
  const Scene scene = scene_of(shapes::joined(shapes::grid(10, 10), below), {{5.2, 5.3, 0.04}, {5.2, 5.3, -0.14}});
  for (const float noise : {0.0f, 0.5f}) {
    const Answer answer = ask(scene, SampleLengths(scene.t.sample_count, noise));
    for (std::uint32_t v = 0; v < 2 * grid_vertices; ++v)
      EXPECT_THAT(answer.normals[v], IsAbout(Vec3{0, 0, v < grid_vertices ? 1.0 : -1.0}));
    EXPECT_THAT(answer.normals[2 * grid_vertices], IsAbout(Vec3{0, 0, 1}));
    EXPECT_THAT(answer.normals[2 * grid_vertices + 1], IsAbout(Vec3{0, 0, -1}));
  }
}

TEST(Orient, NoiseIsAveragedOut) {
  TriangleMesh mesh = shapes::grid(30, 30);
  clouds::Random random(3);
  for (Vec3& p : mesh.vertices) p.z = random.uniform(-0.6, 0.6);
  const Scene scene = scene_of(mesh, {});
  const auto mean_angle = [&](float grid_spacing) {
    const Answer answer = ask(scene, SampleLengths(scene.t.sample_count, grid_spacing));
    double sum = 0;
    for (const Vec3& n : answer.normals) sum += std::acos(n.z);
    return sum / static_cast<double>(answer.normals.size());
  };
  EXPECT_LT(mean_angle(0.42f), 0.35 * mean_angle(1e-6f)); // 0.35 is the deviation: ℓ = 0.42
}

TEST(Orient, EveryInlierHasAUnitNormalAndThreadsDoNotMatter) {
  const Scene scene = scene_of(shapes::torus(1, 0.4, 300, 120), clouds::random_box(500, 7, 1.4));
  const SampleLengths grid(scene.t.sample_count, 0.01f);
  const SampleModel model = measured(scene);
  const Answer one = ask(scene, model, grid, 1), three = ask(scene, model, grid, 3);
  EXPECT_EQ(one.classes.inlier.raw(), three.classes.inlier.raw());
  EXPECT_EQ(one.classes.confidence.raw(), three.classes.confidence.raw());
  for (std::size_t i = 0; i < one.normals.size(); ++i) {
    if (one.classes.inlier.raw()[i]) {
      EXPECT_NEAR(norm(one.normals[i]), 1, 1e-12);
      EXPECT_EQ(one.normals[i], three.normals[i]);
    } else {
      EXPECT_TRUE(is_nan(one.normals[i]) && is_nan(three.normals[i]));
    }
    EXPECT_EQ(one.classes.inlier.raw()[i] == 1, one.classes.confidence.raw()[i] >= 0.5f);
  }
}

} // namespace
} // namespace eigencrust
