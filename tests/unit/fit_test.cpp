// SPDX-License-Identifier: GPL-3.0-or-later
// The surface through the middle of the noise: the local fit, and what it makes of whole clouds.
#include "fit/fit.h"

#include <eigencrust/eigencrust.h>
#include <eigencrust/metrics.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "clouds.h"
#include "fit/local_quadric.h"
#include "fit/sample_clusters.h"
#include "noisy.h"

namespace eigencrust {
namespace {

using clouds::noisy;
using clouds::Points;

/// Spacing of so many samples of the unit sphere.
double spacing_of(std::size_t n) { return std::sqrt(4 * std::numbers::pi / static_cast<double>(n)); }

double mean_error(const TriangleMesh& mesh, const std::function<double(const Vec3&)>& distance) {
  double sum = 0;
  for (const Vec3& p : mesh.vertices) sum += std::fabs(distance(p));
  return sum / static_cast<double>(mesh.vertices.size());
}
double from_unit_sphere(const Vec3& p) { return norm(p) - 1; }

Result reconstructed(Points points, SurfaceKind kind, unsigned threads = 2) {
  Options options;
  options.surface = kind;
  options.threads = threads;
  return reconstruct(clouds::cloud_of(std::move(points)), options);
}

TEST(LocalQuadric, FindsAQuadricAndItsNormalInAnyFrame) {
  const Vec3 origin{3, -2, 5}, normal{0.6, 0, 0.8}, u{0.8, 0, -0.6}, v{0, 1, 0};
  const auto surface = [&](double x, double y) {
    return origin + x * u + y * v + (0.01 + 0.1 * x - 0.05 * y + 0.2 * x * x + 0.3 * x * y - 0.1 * y * y) * normal;
  };
  QuadricFit fit(origin, normal, 1);
  for (int i = -9; i <= 9; ++i)
    for (int j = -9; j <= 9; ++j) fit.add({surface(0.1 * i, 0.1 * j), {}, 1});
  const auto found = fit.solve();
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->noise_variance, 0, 1e-8);
  EXPECT_NEAR(found->sag, 0, 1e-9);
  EXPECT_NEAR(found->offset(origin, normal), 0.01 / 1, 1e-3); // to first order: the surface is tilted a little
  const Vec3 at = surface(0.3, -0.2);
  EXPECT_NEAR(found->offset(at, normal), 0, 1e-7);
  EXPECT_NEAR(found->offset(at - 0.05 * normal, normal), 0.05, 1e-7);
  const Vec3 tangent = surface(0.3 + 1e-6, -0.2) - surface(0.3 - 1e-6, -0.2);
  EXPECT_NEAR(dot(found->foot(at).normal, tangent) / norm(tangent), 0, 1e-6);
}

TEST(LocalQuadric, SeveralWidthsAtOnceAreThoseOneByOne) {
  const std::array<double, 3> widths{0.3, 0.42, 0.9};
  const Vec3 origin{0, 0, 1}, normal{0, 0.6, 0.8};
  QuadricFit all(origin, normal, widths);
  std::vector<QuadricFit> single;
  for (const double width : widths) single.emplace_back(origin, normal, width);
  for (const Vec3& p : noisy(clouds::sphere(20'000), 0.02, 3)) {
    all.add({p, {1e-5, 2e-6, 0, 1e-5, 0, 1e-5}, 2});
    for (QuadricFit& fit : single) fit.add({p, {1e-5, 2e-6, 0, 1e-5, 0, 1e-5}, 2});
  }
  for (std::size_t k = 0; k < widths.size(); ++k) {
    const auto one = single[k].solve(0.02), same = all.solve(0.02, k);
    ASSERT_TRUE(one && same);
    EXPECT_NEAR(norm(one->u), 1 / widths[k], 1e-12);
    EXPECT_NEAR(distance(one->u, same->u), 0, 1e-12);
    for (std::size_t i = 0; i < one->height.size(); ++i) EXPECT_NEAR(one->height[i], same->height[i], 1e-11) << i;
    EXPECT_NEAR(one->noise_variance, same->noise_variance, 1e-13);
    EXPECT_NEAR(one->variance, same->variance, 1e-11);
    EXPECT_NEAR(one->sag, same->sag, 1e-13);
  }
}

TEST(LocalQuadric, TooFewSamplesOrSamplesInARowMakeNoFitOrAHarmlessOne) {
  QuadricFit few({}, {0, 0, 1}, 1);
  for (int i = 0; i < 9; ++i) few.add({{0.3 * std::cos(i), 0.3 * std::sin(i), 0}, {}, 1});
  EXPECT_FALSE(few.solve());
  QuadricFit row({}, {0, 0, 1}, 1);
  for (int i = -50; i <= 50; ++i) row.add({{0.01 * i, 0, 0.1}, {}, 1});
  if (const auto fit = row.solve()) {
    EXPECT_NEAR(fit->offset({}, {0, 0, 1}), 0.1, 1e-3);
  }
}

TEST(LocalQuadric, NoiseInAllDirectionsSagsOnASphereAndThatIsAllowedFor) {
  // A cap of a sphere of radius 1: the samples above one place lie σ² / 1 too low.
  const double sigma = 0.08;
  QuadricFit fit({0, 0, 1}, {0, 0, 1}, 0.4);
  const Points cap = noisy(clouds::sphere(1'000'000), sigma, 5);
  for (const Vec3& p : cap)
    if (p.z > 0.5) fit.add({p, {}, 1});
  const auto found = fit.solve();
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->noise_variance, sigma * sigma, 0.05 * sigma * sigma);
  EXPECT_NEAR(found->sag, -sigma * sigma, 0.15 * sigma * sigma);
  EXPECT_NEAR(found->offset({0, 0, 1}, {0, 0, 1}), 0, 0.3 * sigma * sigma);
}

TEST(FittedSurface, VerticesGoToTheMiddleOfTheNoiseAndKeepWhatIsSaidOfThem) {
  const std::size_t n = 6000;
  for (const double sigma : {0.1, 0.25, 0.5, 1.0}) {
    const Points points = noisy(clouds::sphere(n), sigma * spacing_of(n), 1);
    const Result samples = reconstructed(points, SurfaceKind::samples),
                 fitted = reconstructed(points, SurfaceKind::automatic);
    if (sigma <= 0.5) { // eased samples have other tetrahedra
      ASSERT_EQ(fitted.mesh.triangles, samples.mesh.triangles);
      ASSERT_EQ(fitted.mesh.vertices.size(), samples.mesh.vertices.size());
      EXPECT_EQ(find_attribute(fitted.mesh.vertex_attributes, "source_index")->values,
                find_attribute(samples.mesh.vertex_attributes, "source_index")->values);
    }
    const double left = sigma > 0.5 ? 0.3 : 0.2;
    EXPECT_LT(mean_error(fitted.mesh, from_unit_sphere), left * mean_error(samples.mesh, from_unit_sphere)) << sigma;
    EXPECT_EQ(fitted.report.mesh.self_intersections, 0);
    EXPECT_EQ(fitted.report.mesh.genus, samples.report.mesh.genus);
    ASSERT_TRUE(fitted.report.moved);
    EXPECT_GT(fitted.report.moved->vertices, 0.99 * static_cast<double>(fitted.mesh.vertices.size()));
    EXPECT_NEAR(fitted.report.moved->median / spacing_of(n), sigma, sigma);
    EXPECT_LE(fitted.report.moved->median, fitted.report.moved->q99);
    EXPECT_LE(fitted.report.moved->q99, fitted.report.moved->max);
    EXPECT_FALSE(samples.report.moved);
  }
}

TEST(FittedSurface, WithoutNoiseNothingMoves) {
  for (const Points& points : {clouds::sphere(3000), clouds::torus(2, 0.7, 90, 40), clouds::cube_surface(16)}) {
    const Result samples = reconstructed(points, SurfaceKind::samples),
                 automatic = reconstructed(points, SurfaceKind::automatic);
    EXPECT_EQ(automatic.mesh.vertices, samples.mesh.vertices);
    EXPECT_FALSE(automatic.report.moved);
  }
}

TEST(FittedSurface, ForcedItFindsTheNoiseItself) {
  const std::size_t n = 3000;
  const Result clean = reconstructed(clouds::sphere(n), SurfaceKind::fitted);
  EXPECT_FALSE(clean.report.moved);
  const PointCloud cloud = clouds::cloud_of(noisy(clouds::sphere(n), 0.5 * spacing_of(n), 8));
  Options options;
  options.noise.kind = LengthChoice::Kind::off;
  EXPECT_FALSE(reconstruct(cloud, options).report.moved);
  options.surface = SurfaceKind::fitted;
  const Result forced = reconstruct(cloud, options);
  ASSERT_TRUE(forced.report.moved);
  EXPECT_LT(mean_error(forced.mesh, from_unit_sphere), 0.15 * spacing_of(n));
  EXPECT_EQ(forced.report.mesh.self_intersections, 0);
}

TEST(FittedSurface, ACleanBodyBesideANoisyOneStays) {
  const std::size_t n = 4000;
  const Points points =
      clouds::joined(noisy(clouds::sphere(n), 0.7 * spacing_of(n), 2), clouds::sphere(n, 1, {4, 0, 0}));
  const Result result = reconstructed(points, SurfaceKind::automatic);
  ASSERT_TRUE(result.report.moved);
  std::size_t clean = 0, moved = 0;
  const Attribute& source = *find_attribute(result.mesh.vertex_attributes, "source_index");
  for (std::size_t v = 0; v < result.mesh.vertices.size(); ++v) {
    const auto row = static_cast<std::size_t>(attribute_value(source, v));
    if (row < n) continue;
    ++clean;
    moved += result.mesh.vertices[v] != points[row];
  }
  EXPECT_EQ(clean, n);
  EXPECT_EQ(moved, 0);
}

TEST(FittedSurface, TheSidesOfAWallAreKeptApart) {
  // A plate 3 spacings thick with noise of 0.4 spacings: z = 0 and z = 3, and its rims.
  const int side = 40;
  Points points;
  for (int i = 0; i <= side; ++i)
    for (int j = 0; j <= side; ++j)
      for (int z = 0; z <= 3; ++z)
        if (z == 0 || z == 3 || i == 0 || j == 0 || i == side || j == side)
          points.push_back({double(i), double(j), double(z)});
  const Result result = reconstructed(noisy(points, 0.4, 3), SurfaceKind::automatic);
  double error = 0, count = 0;
  for (const Vec3& p : result.mesh.vertices) {
    if (std::min({p.x, p.y, side - p.x, side - p.y}) < 4) continue;
    error += std::min(std::fabs(p.z), std::fabs(p.z - 3));
    ++count;
  }
  ASSERT_GT(count, 1000);
  EXPECT_LT(error / count, 0.08) << "0.32 without the fit";
  EXPECT_EQ(result.report.mesh.self_intersections, 0);
}

TEST(FittedSurface, TheSameForAnyNumberOfThreads) {
  const Points points = noisy(clouds::torus(2, 0.7, 150, 60), 0.06, 4);
  const Result one = reconstructed(points, SurfaceKind::automatic, 1),
               three = reconstructed(points, SurfaceKind::automatic, 3);
  ASSERT_TRUE(one.report.moved);
  EXPECT_EQ(one.mesh.vertices, three.mesh.vertices);
}

TEST(FittedSurface, NoVertexMovesFartherThanNoiseExplains) {
  // The upper half has a hundredth of the samples of the lower: there the spacing is no measure for a step.
  const std::size_t n = 8000;
  const double spacing = spacing_of(n), sigma = 0.4 * spacing;
  Points points;
  for (const Vec3& p : noisy(clouds::sphere(n), sigma, 6))
    if (p.z < 0 || points.size() % 100 == 0 || static_cast<int>(1e6 * (p.x + 2)) % 100 == 0) points.push_back(p);
  const Result result = reconstructed(points, SurfaceKind::fitted);
  ASSERT_TRUE(result.report.moved);
  EXPECT_LT(result.report.moved->max, 3 * 1.5 * sigma + 1.5 * spacing);
  EXPECT_EQ(result.report.mesh.self_intersections, 0);
}

TEST(SampleClusters, MomentsAreThoseOfTheirSamples) {
  const Points points = noisy(clouds::sphere(50), 0.3, 7);
  SampleCluster first, second;
  for (std::size_t i = 0; i < points.size(); ++i) (i < 20 ? first : second).add({points[i], {}, 1});
  first.add(second);
  Vec3 mean;
  for (const Vec3& p : points) mean = mean + (1.0 / 50) * p;
  EXPECT_NEAR(distance(first.mean, mean), 0, 1e-14);
  EXPECT_EQ(first.count, 50);
  const Vec3 a{1, 2, -1}, b{0.5, -1, 3};
  double covariance = 0;
  for (const Vec3& p : points) covariance += dot(a, p - mean) * dot(b, p - mean) / 50;
  EXPECT_NEAR(first.covariance(a, b), covariance, 1e-12);
}

TEST(SampleClusters, AQuadricIsFoundFromClustersAsFromSamples) {
  // Far finer than the weights change.
  const auto height = [](double x, double y) { return 0.1 + 0.2 * x * x - 0.3 * x * y + 0.1 * y * y; };
  QuadricFit samples({}, {0, 0, 1}, 1), clusters({}, {0, 0, 1}, 1);
  for (int i = -60; i < 60; i += 4)
    for (int j = -60; j < 60; j += 4) {
      SampleCluster cluster;
      for (int k = 0; k < 16; ++k) {
        const double x = (i + k % 4) / 60.0, y = (j + k / 4) / 60.0;
        samples.add({{x, y, height(x, y)}, {}, 1});
        cluster.add({{x, y, height(x, y)}, {}, 1});
      }
      clusters.add(cluster);
    }
  const auto one = samples.solve(), other = clusters.solve();
  ASSERT_TRUE(one && other);
  EXPECT_NEAR(one->height[0], 0.1, 1e-6);
  for (std::size_t k = 0; k < one->height.size(); ++k) EXPECT_NEAR(one->height[k], other->height[k], 1e-6) << k;
  EXPECT_NEAR(one->variance, other->variance, 0.02 * one->variance);
}

TEST(SampleClusters, EveryLevelIsAboutAQuarterOfTheOneBelowAndHoldsAllItsSamples) {
  const Points points = clouds::sphere(5000);
  const Result result = reconstructed(points, SurfaceKind::samples);
  std::vector<std::uint32_t> vertex_of(points.size());
  for (std::uint32_t s = 0; s < points.size(); ++s) vertex_of[s] = s;
  const auto& vertices = result.mesh.vertices;
  const ClusterPyramid pyramid(SurfaceFans(result.mesh), vertices, vertices, vertices, vertex_of, Threads(2));
  ASSERT_GE(pyramid.levels(), 4);
  for (std::size_t l = 1; l < pyramid.levels(); ++l) {
    const auto &fine = pyramid[l - 1], &coarse = pyramid[l];
    EXPECT_NEAR(static_cast<double>(coarse.cluster.size()) / static_cast<double>(fine.cluster.size()), 0.25, 0.1);
    double count = 0;
    for (const SampleCluster& cluster : coarse.cluster) count += cluster.count;
    EXPECT_EQ(count, 5000);
    for (std::size_t c = 0; c < coarse.seed.size(); ++c) EXPECT_EQ(fine.parent[coarse.seed[c]], c);
  }
}

// A body of few samples, with hardly any noise and edges everywhere: fits across these take shape for noise.
TEST(FittedSurface, SharpEdgesOfACoarseBoxStay) {
  Points points = clouds::lattice(21, 17, 13);
  const Vec3 low = points.front(), high = points.back();
  std::erase_if(points, [&](const Vec3& p) {
    return p.x > low.x && p.y > low.y && p.z > low.z && p.x < high.x && p.y < high.y && p.z < high.z;
  });
  points = noisy(points, 0.02, 1);
  const Result result = reconstructed(points, SurfaceKind::automatic);
  EXPECT_FALSE(result.report.moved) << "not by 0.4 spacings, as without bounds by what noise explains";
  EXPECT_NEAR(result.report.mesh.volume, 20 * 16 * 12, 5);
}

/// Where the unit cells of a solid meet cells that are free: the lattice points of its surface.
Points surface_of_cells(int nx, int ny, int nz, const std::function<bool(int, int, int)>& solid) {
  const auto is_solid = [&](int x, int y, int z) {
    return x >= 0 && y >= 0 && z >= 0 && x < nx && y < ny && z < nz && solid(x, y, z);
  };
  Points points;
  for (int x = 0; x <= nx; ++x)
    for (int y = 0; y <= ny; ++y)
      for (int z = 0; z <= nz; ++z) {
        int around = 0;
        for (int k = 0; k < 8; ++k) around += is_solid(x - (k & 1), y - (k >> 1 & 1), z - (k >> 2));
        if (around > 0 && around < 8) points.push_back({1.0 * x, 1.0 * y, 1.0 * z});
      }
  return points;
}

TEST(FittedSurface, SharpEdgesOfCleanPartsStayHoweverTheyLie) {
  const Points window =
                   surface_of_cells(8, 20, 20, [](int, int y, int z) { return y < 6 || y > 13 || z < 6 || z > 13; }),
               rail = surface_of_cells(25, 9, 15, [](int x, int, int z) { return z > 9 || (x > 8 && x < 16); });
  const double window_area = 1568, rail_area = 1110;
  // Where the parts lie decides at which places noise is measured: near edges some is read.
  for (int turn = 0; turn < 6; ++turn) {
    const double c = std::cos(0.3 + turn), s = std::sin(0.3 + turn), d = std::cos(0.5 * turn), e = std::sin(0.5 * turn);
    const auto turned = [&](Points points) {
      for (Vec3& p : points) {
        p = {c * p.x - s * p.y, s * p.x + c * p.y, p.z};
        p = {p.x, d * p.y - e * p.z, e * p.y + d * p.z};
      }
      return points;
    };
    EXPECT_NEAR(reconstructed(turned(window), SurfaceKind::automatic).report.mesh.area / window_area, 1, 1e-6) << turn;
    EXPECT_NEAR(reconstructed(turned(rail), SurfaceKind::automatic).report.mesh.area / rail_area, 1, 1e-6) << turn;
  }
}

/// Samples at random places of a cube's six faces, [0, 1]³.
Points on_cube(std::size_t n, std::uint64_t seed) {
  clouds::Random random(seed);
  Points points;
  for (std::size_t i = 0; i < n; ++i) {
    const double a = random.uniform(), b = random.uniform(), c = i % 2 == 0 ? 0 : 1;
    points.push_back(i % 6 < 2 ? Vec3{a, b, c} : i % 6 < 4 ? Vec3{b, c, a} : Vec3{c, a, b});
  }
  return points;
}

TEST(FittedSurface, VerticesBesideAnEdgeGoToWhereItsSidesMeet) {
  const std::size_t n = 24000;
  const double spacing = std::sqrt(6.0 / static_cast<double>(n));
  Points edges;
  for (double t = 0.05; t < 0.95; t += 0.2 * spacing)
    for (const double a : {0.0, 1.0})
      for (const double b : {0.0, 1.0}) {
        edges.push_back({t, a, b});
        edges.push_back({a, t, b});
        edges.push_back({a, b, t});
      }
  double sum = 0;
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const Result result = reconstructed(noisy(on_cube(n, seed), 0.5 * spacing, seed), SurfaceKind::automatic);
    sum += summarize(distances_to_surface(edges, result.mesh, 2)).mean / spacing;
  }
  EXPECT_LT(sum / 3, 0.47);
}

TEST(FittedSurface, TinyCloudsAreFittedAsLargeOnes) {
  const Points points = noisy(clouds::sphere(4000), 0.5 * spacing_of(4000), 5);
  const double error = mean_error(reconstructed(points, SurfaceKind::automatic).mesh, from_unit_sphere);
  const double scale = std::ldexp(1.0, -40);
  Points tiny = points;
  for (Vec3& p : tiny) p = scale * p;
  const Result result = reconstructed(tiny, SurfaceKind::automatic);
  EXPECT_NEAR(mean_error(result.mesh, [&](const Vec3& p) { return norm((1 / scale) * p) - 1; }) / error, 1, 0.05);
}

TEST(FittedSurface, IsTheDefaultButOfThePaper) {
  EXPECT_EQ(Options::of(Preset::paper).surface, SurfaceKind::delaunay);
  EXPECT_EQ(Options::of(Preset::robust).surface, SurfaceKind::automatic);
}

} // namespace
} // namespace eigencrust
