// SPDX-License-Identifier: GPL-3.0-or-later
#include <eigencrust/error.h>
#include <eigencrust/metrics.h>
#include <gmock/gmock.h>

#include <numbers>
#include <random>

#include "shapes.h"

namespace eigencrust {
namespace {

using testing::DoubleNear;

std::vector<Vec3> random_points(std::size_t count, double size, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto coordinate = [&] { return size * (static_cast<double>(random() >> 11) * 0x1p-52 - 1); };
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < count; ++i) points.push_back({coordinate(), coordinate(), coordinate()});
  return points;
}

TEST(TriangleTree, NearestOnEachPartOfATriangle) {
  const TriangleTree tree({{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, {{0, 1, 2}}, {}, {}});
  const auto expect = [&](const Vec3& query, const Vec3& point) {
    const TriangleTree::Nearest n = tree.nearest(query);
    EXPECT_NEAR(distance(n.point, point), 0, 1e-15);
    EXPECT_DOUBLE_EQ(n.distance, distance(query, point));
    EXPECT_EQ(n.triangle, 0u);
  };
  expect({1, 1, 5}, {1, 1, 0});   // face
  expect({1, 1, -5}, {1, 1, 0});  // face from below
  expect({-1, -1, 2}, {0, 0, 0}); // vertices
  expect({9, -1, 2}, {4, 0, 0});
  expect({-1, 9, 2}, {0, 4, 0});
  expect({2, -3, 1}, {2, 0, 0}); // edges
  expect({-3, 2, 1}, {0, 2, 0});
  expect({4, 4, 1}, {2, 2, 0});
}

TEST(TriangleTree, DegenerateTrianglesAreSegmentsAndPoints) {
  const TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {5, 5, 5}}, {{0, 1, 2}, {3, 3, 3}, {0, 0, 2}}, {}, {}};
  const TriangleTree tree(mesh);
  EXPECT_DOUBLE_EQ(tree.nearest({1.5, 2, 0}).distance, 2);
  EXPECT_EQ(tree.nearest({1.5, 2, 0}).triangle, 0u) << "of two at the same distance the first";
  EXPECT_DOUBLE_EQ(tree.nearest({5, 5, 6}).distance, 1);
  EXPECT_FALSE(tree.first_hit({1, 0, 5}, {0, 0, -1}).valid()) << "edge-on is no hit";
}

// Brute force over a soup with slivers: distances by minimizing over a fine grid of each triangle would
// be coarse, so the single-triangle tree (tested above) is the oracle.
TEST(TriangleTree, NearestAgreesWithEveryTriangleAlone) {
  TriangleMesh mesh = shapes::torus(1, 0.3, 24, 10);
  mesh.vertices[17] = mesh.vertices[18]; // a few degenerate ones
  const TriangleTree tree(mesh);
  for (const Vec3& query : random_points(200, 2, 3)) {
    double best = std::numeric_limits<double>::infinity();
    for (const auto& t : mesh.triangles)
      best = std::min(best, TriangleTree({mesh.vertices, {t}, {}, {}}).nearest(query).distance);
    EXPECT_EQ(tree.nearest(query).distance, best);
  }
}

TEST(TriangleTree, FirstHit) {
  const TriangleTree tree(shapes::box({0, 0, 0}, {1, 1, 1}));
  EXPECT_DOUBLE_EQ(tree.first_hit({0.3, 0.6, 5}, {0, 0, -2}).distance, 2) << "in units of |direction|";
  EXPECT_DOUBLE_EQ(tree.first_hit({0.3, 0.6, 0.5}, {0, 0, -1}).distance, 0.5) << "from inside";
  EXPECT_FALSE(tree.first_hit({0.3, 0.6, 5}, {0, 0, 1}).valid()) << "away";
  EXPECT_FALSE(tree.first_hit({3, 0.6, 5}, {0, 0, -1}).valid()) << "beside, parallel to an axis";
  EXPECT_DOUBLE_EQ(tree.first_hit({0.3, 0.6, 1}, {0, 0, -1}).distance, 1) << "t = 0 does not count";
  EXPECT_FALSE(tree.first_hit({0.3, 0.6, 5}, {0, 0, 0}).valid());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(tree.first_hit({nan, 0, 0}, {0, 0, 1}).valid());
  EXPECT_TRUE(std::isnan(tree.nearest({nan, 0, 0}).distance));
}

// Rays aimed exactly at vertices and edge midpoints must not slip through.
TEST(TriangleTree, RaysDoNotSlipBetweenTriangles) {
  const TriangleMesh mesh = shapes::icosphere(3);
  const TriangleTree tree(mesh);
  for (const Vec3& origin : {Vec3{0, 0, 0}, Vec3{0.1, -0.2, 0.3}}) {
    for (const Vec3& v : mesh.vertices) EXPECT_TRUE(tree.first_hit(origin, v - origin).valid());
    for (const auto& t : mesh.triangles)
      for (int k = 0; k < 3; ++k) {
        const Vec3 middle = 0.5 * (mesh.vertices[t[k]] + mesh.vertices[t[(k + 1) % 3]]);
        EXPECT_TRUE(tree.first_hit(origin, middle - origin).valid());
      }
  }
}

TEST(TriangleTree, FirstHitAgreesWithEveryTriangleAlone) {
  const TriangleMesh mesh = shapes::torus(1, 0.3, 24, 10);
  const TriangleTree tree(mesh);
  const auto origins = random_points(300, 2, 5), directions = random_points(300, 1, 6);
  int hits = 0;
  for (std::size_t i = 0; i < origins.size(); ++i) {
    TriangleTree::Hit best;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      const auto hit = TriangleTree({mesh.vertices, {mesh.triangles[t]}, {}, {}}).first_hit(origins[i], directions[i]);
      if (hit.valid() && (!best.valid() || hit.distance < best.distance)) best = {hit.distance, t};
    }
    const auto hit = tree.first_hit(origins[i], directions[i]);
    EXPECT_EQ(hit.distance, best.distance);
    EXPECT_EQ(hit.triangle, best.triangle);
    hits += hit.valid() ? 1 : 0;
  }
  EXPECT_GT(hits, 30);
}

TEST(TriangleTree, RefusesAnEmptyOrBrokenMesh) {
  EXPECT_THROW(TriangleTree({}), Error);
  EXPECT_THROW(TriangleTree({{{0, 0, 0}}, {{0, 0, 1}}, {}, {}}), Error);
  EXPECT_THROW(TriangleTree({{{0, 0, std::numeric_limits<double>::infinity()}}, {{0, 0, 0}}, {}, {}}), Error);
}

TEST(Summarize, QuantilesAreLinearBetweenRanks) {
  const DistanceStatistics s = summarize({4, 0, 1, 3, 2});
  EXPECT_EQ(s.count, 5u);
  EXPECT_DOUBLE_EQ(s.mean, 2);
  EXPECT_DOUBLE_EQ(s.rms, std::sqrt(6.0));
  EXPECT_DOUBLE_EQ(s.median, 2);
  EXPECT_DOUBLE_EQ(s.q90, 3.6);
  EXPECT_DOUBLE_EQ(s.q95, 3.8);
  EXPECT_DOUBLE_EQ(s.q99, 3.96);
  EXPECT_DOUBLE_EQ(s.max, 4);
  EXPECT_EQ(summarize({}).count, 0u);
  EXPECT_EQ(summarize({1, std::numeric_limits<double>::quiet_NaN()}).count, 1u);
  EXPECT_DOUBLE_EQ(summarize({7}).q99, 7);
}

TEST(Distances, ToASphereAreExactUpToItsFacets) {
  const auto points = random_points(500, 3, 1);
  const auto d = distances_to_surface(points, shapes::icosphere(5), 2);
  for (std::size_t i = 0; i < points.size(); ++i) EXPECT_NEAR(d[i], std::fabs(norm(points[i]) - 1), 1e-3);
  EXPECT_EQ(d, distances_to_surface(points, shapes::icosphere(5), 1));
}

TEST(Distances, ToPointsAgreeWithBruteForce) {
  auto targets = random_points(300, 1, 2);
  targets.push_back({std::numeric_limits<double>::quiet_NaN(), 0, 0});
  const auto points = random_points(100, 1.5, 4);
  const auto d = distances_to_points(points, targets, 2);
  for (std::size_t i = 0; i < points.size(); ++i) {
    double best = std::numeric_limits<double>::infinity();
    for (const Vec3& t : targets)
      if (is_finite(t)) best = std::min(best, distance(points[i], t));
    EXPECT_DOUBLE_EQ(d[i], best);
  }
  EXPECT_THROW(distances_to_points(points, {}), Error);
}

TEST(SampleSurface, SpreadsOverTheAreaAndRepeats) {
  // Two separate squares, one nine times the other.
  TriangleMesh mesh = shapes::joined(shapes::grid(1, 1), shapes::moved(shapes::grid(1, 1), {10, 0, 0}, 3));
  std::vector<std::uint32_t> triangle_of;
  const auto points = sample_surface(mesh, 10000, 42, &triangle_of);
  ASSERT_EQ(points.size(), 10000u);
  ASSERT_EQ(triangle_of.size(), 10000u);
  int small = 0;
  Vec3 mean;
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(points[i].z, 0);
    EXPECT_EQ(triangle_of[i] < 2, points[i].x <= 1);
    if (triangle_of[i] < 2)
      ++small;
    else
      mean = mean + points[i];
  }
  EXPECT_NEAR(small, 1000, 2) << "equal shares of the area: no scatter";
  EXPECT_NEAR(mean.x / (10000 - small), 11.5, 0.05);
  EXPECT_NEAR(mean.y / (10000 - small), 1.5, 0.05);
  EXPECT_EQ(points, sample_surface(mesh, 10000, 42));
  EXPECT_NE(points, sample_surface(mesh, 10000, 43));
  EXPECT_TRUE(sample_surface(mesh, 0, 1).empty());
  EXPECT_THROW(sample_surface({{{0, 0, 0}}, {{0, 0, 0}}, {}, {}}, 5, 1), Error);
}

// The generator is fixed by the standard and nothing else comes in: these digits hold everywhere.
TEST(SampleSurface, FirstPointOfSeedOne) {
  std::mt19937_64 random(1);
  random();
  const double root = std::sqrt(static_cast<double>(random() >> 11) * 0x1p-53);
  const double v = static_cast<double>(random() >> 11) * 0x1p-53;
  const auto points = sample_surface({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}, {}, {}}, 1, 1);
  EXPECT_EQ(points[0], (Vec3{root * (1 - v), root * v, 0}));
}

TEST(VolumeIou, Boxes) {
  const TriangleMesh unit = shapes::box({0, 0, 0}, {1, 1, 1});
  EXPECT_DOUBLE_EQ(volume_iou(unit, unit), 1);
  EXPECT_DOUBLE_EQ(volume_iou(unit, shapes::box({2, 0, 0}, {3, 1, 1})), 0);
  EXPECT_DOUBLE_EQ(volume_iou(unit, shapes::box({0, 0, 1}, {1, 1, 2})), 0) << "touching";
  EXPECT_NEAR(volume_iou(unit, shapes::box({0.5, 0, 0}, {1.5, 1, 1})), 1.0 / 3, 2.0 / 512);
  EXPECT_NEAR(volume_iou(unit, shapes::box({0, 0, 0.5}, {1, 1, 1.5})), 1.0 / 3, 1e-12) << "exact along the columns";
  EXPECT_NEAR(volume_iou(unit, shapes::box({0.5, 0.5, 0.5}, {1.5, 1.5, 1.5})), 0.125 / 1.875, 2.0 / 512);
  EXPECT_NEAR(volume_iou(unit, shapes::box({0.25, 0.25, 0.25}, {0.75, 0.75, 0.75})), 0.125, 2.0 / 512);
}

TEST(VolumeIou, OrientationAndCavities) {
  const TriangleMesh ball = shapes::icosphere(4, 2), core = shapes::icosphere(4, 1);
  EXPECT_NEAR(volume_iou(ball, core), 1.0 / 8, 2.0 / 512);
  EXPECT_NEAR(volume_iou(shapes::flipped(ball), core), 1.0 / 8, 2.0 / 512) << "inside out is as full";
  const TriangleMesh shell = shapes::hollow_sphere(4, 2, 1);
  EXPECT_NEAR(volume_iou(ball, shell), 7.0 / 8, 2.0 / 512);
  EXPECT_NEAR(volume_iou(shell, core), 0, 1e-6) << "the core fills the cavity";
  EXPECT_NEAR(volume_iou(shapes::joined(ball, core), ball), 1, 1e-9) << "winding number 2 is inside as well";
}

// With 2, 4, 8 ... columns over [0, 8] the lines run exactly through the grid's vertices and edges.
TEST(VolumeIou, ColumnsThroughVerticesAndEdges) {
  TriangleMesh roof = shapes::grid(8, 8);
  const auto bottom = shapes::flipped(shapes::grid(8, 8));
  roof = shapes::moved(std::move(roof), {0.5, 0.5, 1});
  TriangleMesh slab = shapes::joined(std::move(roof), shapes::moved(bottom, {0.5, 0.5, 0}));
  for (std::uint32_t i = 0; i < 8; ++i) { // walls
    const auto wall = [&](std::uint32_t a, std::uint32_t b) {
      slab.triangles.push_back({a + 81, b + 81, b});
      slab.triangles.push_back({a + 81, b, a});
    };
    wall(i, i + 1);
    wall(72 + i + 1, 72 + i);
    wall(9 * (i + 1), 9 * i);
    wall(9 * i + 8, 9 * (i + 1) + 8);
  }
  const TriangleMesh frame = shapes::box({0, 0, 0}, {9, 9, 1});
  EXPECT_NEAR(volume_iou(slab, frame, 9), 64.0 / 81, 1e-12) << "columns at 0.5, 1.5 ... stand on the vertices";
  EXPECT_NEAR(volume_iou(frame, slab, 9, 1), 64.0 / 81, 1e-12);
}

TEST(VolumeIou, SameForAnyNumberOfThreadsAndRefusesOpenMeshes) {
  const TriangleMesh a = shapes::torus(1, 0.4, 40, 20), b = shapes::icosphere(3, 1.2);
  EXPECT_EQ(volume_iou(a, b, 200, 1), volume_iou(a, b, 200, 3));
  TriangleMesh open = b;
  open.triangles.erase(open.triangles.begin()); // one that no line parallel to z can miss
  EXPECT_THAT([&] { volume_iou(a, open); },
              testing::Throws<Error>(testing::Property(&Error::kind, testing::Eq(ErrorKind::input))));
  EXPECT_THROW(volume_iou(a, {}), Error);
  EXPECT_THROW(volume_iou(a, b, 0), Error);
}

TEST(Compare, IdenticalMeshes) {
  const TriangleMesh mesh = shapes::torus(1, 0.4, 60, 30);
  const Comparison c = compare(mesh, mesh, {20000, 1, 0, 2});
  EXPECT_LT(c.hausdorff, 1e-12);
  EXPECT_EQ(c.f_score, 1);
  EXPECT_THAT(c.normal_consistency, DoubleNear(1, 1e-4)); // a sample on an edge may find the neighbour
  EXPECT_THAT(c.oriented_normal_consistency, DoubleNear(1, 1e-4));
  EXPECT_DOUBLE_EQ(c.volume_iou, 1);
}

TEST(Compare, ConcentricSpheres) {
  const TriangleMesh outer = shapes::icosphere(5, 1.1), inner = shapes::icosphere(5, 1);
  CompareOptions options;
  options.samples = 20000;
  options.threshold = 0.05;
  const Comparison far = compare(outer, inner, options);
  EXPECT_NEAR(far.to_reference.mean, 0.1, 2e-3);
  EXPECT_NEAR(far.from_reference.max, 0.1, 2e-3);
  EXPECT_EQ(far.f_score, 0) << "all farther than the threshold";
  EXPECT_NEAR(far.volume_iou, 1 / 1.331, 5e-3);
  options.threshold = 0.2;
  EXPECT_EQ(compare(outer, inner, options).f_score, 1);
}

TEST(Compare, InsideOutShowsInTheSignedNormalsOnly) {
  const TriangleMesh mesh = shapes::icosphere(4);
  const Comparison c = compare(shapes::flipped(mesh), mesh, {5000, 1, 0, 1});
  EXPECT_NEAR(c.normal_consistency, 1, 1e-4);
  EXPECT_NEAR(c.oriented_normal_consistency, -1, 1e-4);
}

// Half a sphere: everything it has is right, but half is missing, and it bounds nothing.
TEST(Compare, MissingHalfShowsInTheRecall) {
  const TriangleMesh whole = shapes::icosphere(4);
  TriangleMesh half = whole;
  std::erase_if(half.triangles, [&](const auto& t) {
    return whole.vertices[t[0]].z + whole.vertices[t[1]].z + whole.vertices[t[2]].z < 0;
  });
  const Comparison c = compare(half, whole, {20000, 1, 0.01, 0});
  EXPECT_EQ(c.precision, 1);
  EXPECT_NEAR(c.recall, 0.5, 0.02);
  EXPECT_NEAR(c.from_reference.max, std::sqrt(2.0), 0.1) << "the south pole is that far from the equator";
  EXPECT_EQ(c.volume_iou, -1);
  EXPECT_THROW(compare(half, {}), Error);
  EXPECT_THROW(compare(half, whole, {0, 1, 0, 0}), Error);
}

} // namespace
} // namespace eigencrust
