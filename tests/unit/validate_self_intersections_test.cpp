// SPDX-License-Identifier: GPL-3.0-or-later
#include <eigencrust/validate.h>
#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "geometry/self_intersections.h"
#include "shapes.h"

namespace eigencrust {
namespace {

std::int64_t crossings(const TriangleMesh& mesh) { return validate(mesh).self_intersections; }

TriangleMesh two(const std::array<Vec3, 3>& f, const std::array<Vec3, 3>& g) {
  return {{f[0], f[1], f[2], g[0], g[1], g[2]}, {{0, 1, 2}, {3, 4, 5}}, {}, {}};
}
const std::array<Vec3, 3> flat{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}};

TEST(SelfIntersections, NothingShared) {
  EXPECT_EQ(crossings(two(flat, {{{1, 1, -1}, {1, 1, 1}, {9, 9, 0}}})), 1) << "a spike through the middle";
  EXPECT_EQ(crossings(two(flat, {{{1, 1, 1}, {1, 1, 2}, {9, 9, 1}}})), 0) << "above";
  EXPECT_EQ(crossings(two(flat, {{{1, 1, 0}, {1, 1, 2}, {9, 9, 1}}})), 1) << "a vertex on the face";
  EXPECT_EQ(crossings(two(flat, {{{1, 1, 0}, {2, 1, 0}, {1, 2, 0}}})), 1) << "inside, same plane";
  EXPECT_EQ(crossings(two(flat, {{{5, 5, 0}, {6, 5, 0}, {5, 6, 0}}})), 0) << "beside, same plane";
  EXPECT_EQ(crossings(two(flat, {{{2, 0, 0}, {3, -1, 0}, {2, -1, 0}}})), 1) << "T-junction: a vertex on an edge";
}

TEST(SelfIntersections, OneVertexShared) {
  EXPECT_EQ(crossings(two(flat, {{{0, 0, 0}, {0, 0, 3}, {-1, 0, 3}}})), 0) << "meets in the vertex only";
  EXPECT_EQ(crossings(two(flat, {{{0, 0, 0}, {2, 2, -1}, {2, 2, 1}}})), 1) << "its far side pierces the face";
  EXPECT_EQ(crossings(two(flat, {{{0, 0, 0}, {9, 9, -1}, {9, 9, 1}}})), 1) << "cuts the far side of the other";
  EXPECT_EQ(crossings(two(flat, {{{0, 0, 0}, {-4, 0, 0}, {0, -4, 0}}})), 0) << "same plane, opposite corners";
  EXPECT_EQ(crossings(two(flat, {{{0, 0, 0}, {9, 1, 0}, {1, 9, 0}}})), 1) << "same plane, overlapping";
  EXPECT_EQ(crossings(two(flat, {{{0, 0, 0}, {1, 0, 0}, {0, 0, 1}}})), 1) << "runs along part of an edge: T-junction";
}

TEST(SelfIntersections, OneEdgeShared) {
  EXPECT_EQ(crossings(two(flat, {{{0, 0, 0}, {4, 0, 0}, {0, 4, 4}}})), 0) << "folded";
  EXPECT_EQ(crossings(two(flat, {{{4, 0, 0}, {0, 0, 0}, {2, -3, 0}}})), 0) << "flat";
  EXPECT_EQ(crossings(two(flat, {{{4, 0, 0}, {0, 0, 0}, {2, 3, 0}}})), 1) << "folded back onto itself";
  // Half an ulp above the plane is not in it.
  EXPECT_EQ(crossings(two(flat, {{{4, 0, 0}, {0, 0, 0}, {2, 3, 1e-300}}})), 0);
}

TEST(SelfIntersections, ThreeVerticesShared) { EXPECT_EQ(crossings(two(flat, {{flat[1], flat[0], flat[2]}})), 1); }

// A T-junction as it comes out of careless subdivision: one side has the edge's middle, the other not.
// The long triangle meets both short ones in more than a shared vertex.
TEST(SelfIntersections, TJunction) {
  const TriangleMesh mesh{
      {{0, 0, 0}, {2, 0, 0}, {1, 1, 0}, {1, 0, 0}, {1, -1, 0}}, {{0, 1, 2}, {0, 4, 3}, {3, 4, 1}}, {}, {}};
  EXPECT_EQ(crossings(mesh), 2);
  EXPECT_EQ(validate(mesh).boundary_edges, 7u);
}

TEST(SelfIntersections, DegenerateTrianglesAreLeftOut) {
  EXPECT_EQ(crossings(two(flat, {{{1, 1, -1}, {1, 1, 0}, {1, 1, 1}}})), 0);
  EXPECT_EQ(crossings(two({{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}}, {{{1, 1, -1}, {1, 1, 0}, {1, 1, 1}}})), 0);
}

TEST(SelfIntersections, NonManifoldEdgesAndVerticesAreNoCrossings) {
  EXPECT_EQ(crossings(shapes::two_tetrahedra_sharing_an_edge()), 0);
  EXPECT_EQ(crossings(shapes::two_tetrahedra_sharing_a_vertex()), 0);
}

// Two unit boxes, one shifted by half along all axes. Counted by hand on paper it is tedious; what must
// hold is that shifting, scaling by 2 and turning inside out change nothing, and that touching boxes count.
TEST(SelfIntersections, OverlappingBoxes) {
  const TriangleMesh unit = shapes::box({0, 0, 0}, {1, 1, 1});
  const TriangleMesh mesh = shapes::joined(unit, shapes::box({0.5, 0.5, 0.5}, {1.5, 1.5, 1.5}));
  const std::int64_t pairs = crossings(mesh);
  EXPECT_GE(pairs, 6);
  EXPECT_EQ(crossings(shapes::moved(mesh, {1024, -512, 256}, 2)), pairs);
  EXPECT_EQ(crossings(shapes::flipped(mesh)), pairs);
  EXPECT_EQ(crossings(shapes::joined(unit, shapes::box({0.1, 0.1, 1}, {0.3, 0.3, 2}))), 10)
      << "a small box standing on one of the roof's triangles: two of its floor, eight of its walls touch it";
  EXPECT_EQ(crossings(shapes::joined(unit, shapes::box({2, 0, 0}, {3, 1, 1}))), 0);
}

// The box tree against all pairs, each pair as a mesh of its own.
TEST(SelfIntersections, AgreesWithAllPairsOfARandomSoup) {
  std::mt19937_64 random(7);
  const auto coordinate = [&] { return static_cast<double>(random() % 8); }; // few values: many exact contacts
  TriangleMesh soup;
  for (std::uint32_t t = 0; t < 60; ++t) {
    const Vec3 corner{coordinate() * 2, coordinate() * 2, coordinate() * 2};
    for (int k = 0; k < 3; ++k) soup.vertices.push_back(corner + Vec3{coordinate(), coordinate(), coordinate()});
    soup.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  }
  std::int64_t pairs = 0;
  for (std::size_t i = 0; i < soup.triangles.size(); ++i)
    for (std::size_t j = i + 1; j < soup.triangles.size(); ++j)
      pairs += crossings({soup.vertices, {soup.triangles[i], soup.triangles[j]}, {}, {}});
  EXPECT_GT(pairs, 20);
  EXPECT_EQ(crossings(soup), pairs);
}

/// Triangles that all cross one another, like the pages of a book around the z axis through their middles.
TriangleMesh sheaf(std::uint32_t n) {
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < n; ++i) {
    const double angle = std::numbers::pi * (i + 0.5) / n, x = std::cos(angle), y = std::sin(angle);
    for (const Vec3& p : {Vec3{-x, -y, 0}, Vec3{x, y, 0}, Vec3{0, 0, 1}}) mesh.vertices.push_back(p);
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    mesh.vertices.back().z += i; // no two have a vertex in common
  }
  return mesh;
}

Crossings crossings_within(const TriangleMesh& mesh, const CrossingLimits& limits, unsigned threads = 2) {
  const std::vector<std::uint8_t> sound(mesh.triangles.size(), 0);
  return count_self_intersections(mesh.vertices, mesh.triangles, sound, Threads(threads), limits);
}

TEST(SelfIntersections, WorkIsBoundedAndTheCountSaysSo) {
  constexpr std::uint64_t n = 1000, all = n * (n - 1) / 2;
  const TriangleMesh mesh = sheaf(n);
  const Crossings exact = crossings_within(mesh, {256, n * n});
  EXPECT_TRUE(exact.all);
  EXPECT_EQ(exact.pairs, all);

  const CrossingLimits limits{100, 100000};
  const Crossings some = crossings_within(mesh, limits);
  EXPECT_FALSE(some.all);
  EXPECT_LT(some.pairs, all);
  EXPECT_GT(some.pairs, limits.in_all / 4); // about half of what is looked at has the smaller number first
  EXPECT_LE(some.looked, n * limits.always + limits.in_all + 64 * n);
  const Crossings three = crossings_within(mesh, limits, 3);
  EXPECT_EQ(three.pairs, some.pairs);
  EXPECT_EQ(three.looked, some.looked);
  // Ten times as many take ten times the work, where the limit of all was reached before.
  const Crossings tenfold = crossings_within(sheaf(10 * n), {100, 0});
  EXPECT_EQ(tenfold.looked, 10 * n * 100);
}

TEST(SelfIntersections, ASurfaceIsCountedToTheEndWithinAnyLimit) {
  // The box of a large slope overlaps those of many small boxes beside it; nothing crosses.
  TriangleMesh mesh{{{-100, -100, -300}, {300, -100, 100}, {-100, 300, -300}}, {{0, 1, 2}}, {}, {}};
  for (int i = 0; i < 400; ++i)
    mesh = shapes::joined(mesh, shapes::box({i % 20 * 2.0, i / 20 * 2.0, 0}, {i % 20 * 2.0 + 1, i / 20 * 2.0 + 1, 1}));
  const Crossings counted = crossings_within(mesh, {});
  EXPECT_TRUE(counted.all);
  EXPECT_EQ(counted.pairs, 0u);
  EXPECT_LT(counted.looked, 100 * mesh.triangles.size());
  EXPECT_TRUE(validate(mesh).all_self_intersections);
}

} // namespace
} // namespace eigencrust
