// SPDX-License-Identifier: GPL-3.0-or-later
// Clouds whose surface is known in closed form.
#include <eigencrust/eigencrust.h>
#include <gmock/gmock.h>

#include <random>

#include "clouds.h"

namespace eigencrust {
namespace {

using clouds::Points;
constexpr double pi = std::numbers::pi;

Result reconstructed(const Points& points, const Options& options = {}) {
  return reconstruct(clouds::cloud_of(points), options);
}

/// Closed, manifold, oriented, without self-intersections, and the report says the same as a fresh look.
MeshSummary expect_sound(const Result& result) {
  EXPECT_THAT(result.report.broken_guarantees, testing::IsEmpty());
  const MeshSummary m = validate(result.mesh);
  EXPECT_TRUE(m.closed());
  EXPECT_TRUE(m.manifold());
  EXPECT_TRUE(m.oriented());
  EXPECT_EQ(m.self_intersections, 0);
  EXPECT_EQ(m.degenerate_triangles, 0u);
  EXPECT_EQ(m.unreferenced_vertices, 0u);
  EXPECT_EQ(m.triangles, result.report.mesh.triangles);
  EXPECT_EQ(m.volume, result.report.mesh.volume);
  return m;
}

void expect_topology(const MeshSummary& m, std::uint64_t components, std::int64_t genus) {
  EXPECT_EQ(m.components, components);
  EXPECT_EQ(m.genus, genus);
}

TEST(Shapes, SphereInEveryPreset) {
  for (const Preset preset : {Preset::robust, Preset::paper}) {
    const Result result = reconstructed(clouds::sphere(2000), Options::of(preset));
    const MeshSummary m = expect_sound(result);
    expect_topology(m, 1, 0);
    EXPECT_EQ(m.vertices, 2000u); // clean data lose no sample
    EXPECT_NEAR(m.volume, 4 * pi / 3, 0.01 * 4 * pi / 3);
    EXPECT_NEAR(m.area, 4 * pi, 0.01 * 4 * pi);
  }
}

TEST(Shapes, SphereWithEverySolverAndStage) {
  const Points points = clouds::jittered(clouds::sphere(1500), 0.01, 1);
  for (const Eigensolver solver : {Eigensolver::multigrid, Eigensolver::lanczos})
    for (const SecondStage stage : {SecondStage::harmonic, SecondStage::eigenvector})
      for (const ManifoldRule rule : {ManifoldRule::cheapest, ManifoldRule::paper}) {
        Options options;
        options.solver.eigensolver = solver;
        options.second_stage = stage;
        options.manifold_rule = rule;
        expect_topology(expect_sound(reconstructed(points, options)), 1, 0);
      }
}

TEST(Shapes, ErrorsFallWithTheNumberOfSamples) {
  double volume_error = 1, area_error = 1;
  for (const std::size_t n : {500u, 2000u, 8000u}) {
    const MeshSummary m = expect_sound(reconstructed(clouds::sphere(n)));
    const double volume = std::fabs(1 - m.volume / (4 * pi / 3)), area = std::fabs(1 - m.area / (4 * pi));
    EXPECT_LT(volume, volume_error / 2); // second order: four times the samples, a quarter of the error
    EXPECT_LT(area, area_error / 2);
    volume_error = volume;
    area_error = area;
  }
}

TEST(Shapes, JitteredSphere) {
  // Noise of a fifth of the spacing: the closed surface stays in the noise's band.
  const Result result = reconstructed(clouds::jittered(clouds::sphere(4000), 0.01, 2));
  const MeshSummary m = expect_sound(result);
  expect_topology(m, 1, 0);
  EXPECT_NEAR(m.volume, 4 * pi / 3, 0.03 * 4 * pi / 3);
}

TEST(Shapes, TorusHasOneHandle) {
  const MeshSummary m = expect_sound(reconstructed(clouds::torus(1, 0.4, 100, 40)));
  expect_topology(m, 1, 1);
  EXPECT_NEAR(m.volume / (2 * pi * pi * 0.16), 1, 0.02);
}

TEST(Shapes, TwoSpheresFarApart) {
  const Points points =
      clouds::joined(clouds::sphere(1500), clouds::jittered(clouds::sphere(1000, 0.8, {30, 5, 0}), 1e-3, 3));
  const MeshSummary m = expect_sound(reconstructed(points));
  expect_topology(m, 2, 0);
  EXPECT_NEAR(m.volume / (4 * pi / 3 * (1 + 0.512)), 1, 0.02);
}

TEST(Shapes, SphereWithinASphereIsACavity) {
  // The space between is solid; the inner surface faces its own middle.
  const Points points = clouds::joined(clouds::sphere(4000), clouds::sphere(1000, 0.5));
  const MeshSummary m = expect_sound(reconstructed(points));
  expect_topology(m, 2, 0);
  EXPECT_NEAR(m.volume / (4 * pi / 3 * (1 - 0.125)), 1, 0.02);
}

TEST(Shapes, CubeOfExactlyCosphericalPoints) {
  const MeshSummary m = expect_sound(reconstructed(clouds::cube_surface(12)));
  expect_topology(m, 1, 0);
  EXPECT_EQ(m.bounds.min, (Vec3{0, 0, 0}));
  EXPECT_EQ(m.bounds.max, (Vec3{12, 12, 12}));
  // Edges of the cube may be cut by half a step at worst.
  EXPECT_LE(m.volume, 1728.0);
  EXPECT_GT(m.volume, 1728.0 - 12 * 12 * 0.5 - 1);
}

TEST(Shapes, FewestPointsGiveTheirHull) {
  const std::vector<std::pair<Points, double>> bodies{
      {{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}, 4.0 / 3},
      {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}}, 0.5},
      {clouds::cube_surface(1), 1}};
  for (const auto& [points, volume] : bodies) {
    const MeshSummary m = expect_sound(reconstructed(points));
    expect_topology(m, 1, 0);
    EXPECT_EQ(m.vertices, points.size());
    EXPECT_NEAR(m.volume, volume, 1e-12);
  }
}

TEST(Shapes, RandomPointsGiveASoundMesh) {
  // No surface in sight: what comes out must keep the promises, and stay where the points are.
  for (const std::uint64_t seed : {1u, 2u, 3u, 4u, 5u, 6u})
    for (const Preset preset : {Preset::robust, Preset::paper}) {
      const Points points = clouds::random_box(50 * seed * seed, seed);
      const MeshSummary m = expect_sound(reconstructed(points, Options::of(preset)));
      EXPECT_GT(m.volume, 0);
      EXPECT_LT(m.volume, 8); // that of the box
      EXPECT_GT(m.vertices, points.size() / 2);
    }
}

TEST(Shapes, OutliersDoNotTurnTheSphereInsideOut) {
  Points points = clouds::sphere(4000);
  const Points stray = clouds::random_box(80, 4, 2.0); // 2 %
  points.insert(points.end(), stray.begin(), stray.end());
  const MeshSummary m = expect_sound(reconstructed(points));
  EXPECT_NEAR(m.volume, 4 * pi / 3, 0.1 * 4 * pi / 3);
}

TEST(Shapes, WithoutTheManifoldStepTheSurfaceIsStillClosed) {
  Options options;
  options.manifold = false;
  options.components.kind = KeepComponents::Kind::all;
  const Result result = reconstructed(clouds::jittered(clouds::sphere(800), 0.1, 5), options);
  EXPECT_THAT(result.report.broken_guarantees, testing::IsEmpty());
  EXPECT_EQ(result.report.mesh.boundary_edges, 0u);
}

TEST(Shapes, SmoothingKeepsTopology) {
  Options options;
  options.smooth = 5;
  for (const Smoothing method : {Smoothing::laplacian, Smoothing::taubin}) {
    options.smoothing = method;
    const Result result = reconstructed(clouds::torus(1, 0.4, 60, 30), options);
    const MeshSummary m = validate(result.mesh);
    EXPECT_TRUE(m.closed() && m.manifold() && m.oriented());
    expect_topology(m, 1, 1);
  }
}

/// Two scans of one sphere of unlike spacing, the second shifted by `shift`.
PointCloud two_scans(double shift) {
  const Points a = clouds::sphere(6000), b = clouds::sphere(5500, 1, {shift, 0, 0});
  PointCloud cloud = clouds::cloud_of(clouds::joined(a, b));
  cloud.scan_index.assign(cloud.points.size(), 0);
  std::fill(cloud.scan_index.begin() + static_cast<std::ptrdiff_t>(a.size()), cloud.scan_index.end(), 1);
  return cloud;
}

void expect_two_scans_are_one_sphere(const Result& result) {
  EXPECT_GT(result.report.grid_spacing, 0); // ℓ comes from the scans
  const MeshSummary m = expect_sound(result);
  expect_topology(m, 1, 0);
  EXPECT_NEAR(m.volume, 4 * pi / 3, 0.03 * 4 * pi / 3);
}

TEST(Shapes, TwoScansThatAgreeAreOneSphere) { expect_two_scans_are_one_sphere(reconstruct(two_scans(0.002))); }

TEST(Shapes, TwoScansThatDisagreeAreOneSphere) {
  // By a third of the spacing; questionable poles must then keep their place in the graph.
  Options options;
  options.questionable = Questionable::after;
  expect_two_scans_are_one_sphere(reconstruct(two_scans(0.016), options));
}

// Left out before the partition, they take with them every sample that sees both sides: the graph falls
// apart, nothing is known of the inside and no surface is left.
TEST(Shapes, TwoScansThatDisagreeAreOneSphereByDefault) {
  expect_two_scans_are_one_sphere(reconstruct(two_scans(0.016)));
}

TEST(Shapes, OutsideAndInsidePointsSettleWhatIsOpen) {
  // The cavity again. Named outside, it stays a cavity; named inside, the ball is solid there.
  const Points points = clouds::joined(clouds::sphere(4000), clouds::sphere(1000, 0.5));
  Options options;
  options.outside_points = {{0, 0, 0}};
  options.inside_points = {{0.75, 0, 0}};
  const Result result = reconstructed(points, options);
  const MeshSummary m = expect_sound(result);
  EXPECT_NEAR(m.volume / (4 * pi / 3 * (1 - 0.125)), 1, 0.02);
}

TEST(Shapes, FacadeIsAnOpenSheet) {
  // A wavy wall seen from +z: one side of it is all there is.
  Points points;
  for (int i = 0; i < 40; ++i)
    for (int j = 0; j < 40; ++j) points.push_back({0.1 * i, 0.1 * j, 0.2 * std::sin(0.3 * i) * std::cos(0.2 * j)});
  points = clouds::jittered(points, 0.005, 6);
  Options options;
  options.facade = Axis::plus_z;
  const Result result = reconstructed(points, options);
  EXPECT_THAT(result.report.broken_guarantees, testing::IsEmpty());
  const MeshSummary m = result.report.mesh;
  EXPECT_GT(m.boundary_edges, 0u);
  EXPECT_TRUE(m.oriented());
  EXPECT_GT(m.area, 0.9 * 3.9 * 3.9);
  double up = 0;
  for (const auto& [a, b, c] : result.mesh.triangles) {
    const Vec3& o = result.mesh.vertices[a];
    up += cross(result.mesh.vertices[b] - o, result.mesh.vertices[c] - o).z / 2;
  }
  EXPECT_GT(up, 0.8 * 3.9 * 3.9); // triangles face the front
}

TEST(Shapes, OutliersAllAroundLeaveTheSphereAlone) {
  Points points = clouds::sphere(8000);
  std::mt19937_64 generator(4);
  const auto uniform = [&] { return static_cast<double>(generator() >> 11) * 0x1p-53 - 0.5; };
  for (int i = 0; i < 400; ++i) points.push_back({6 * uniform(), 6 * uniform(), 6 * uniform()});
  const MeshSummary m = expect_sound(reconstructed(points));
  expect_topology(m, 1, 0);
  EXPECT_NEAR(m.volume / (4 * pi / 3), 1, 0.01);
  EXPECT_GE(m.vertices, 7990u);
}

} // namespace
} // namespace eigencrust
