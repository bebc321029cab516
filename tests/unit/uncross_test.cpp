// SPDX-License-Identifier: GPL-3.0-or-later
#include "fit/uncross.h"

#include <eigencrust/validate.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <tuple>

#include "counter_random.h"
#include "geometry/self_intersections.h"
#include "shapes.h"
#include "surface/clear_stars.h"

namespace eigencrust {
namespace {

constexpr double spacing = 0.1;

/// The sphere with some of its vertices moved by up to `most` at random.
TriangleMesh tangled(const TriangleMesh& sphere, unsigned every, double most) {
  TriangleMesh mesh = sphere;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> step(-most, most);
  for (std::size_t v = 0; v < mesh.vertices.size(); v += every)
    mesh.vertices[v] = mesh.vertices[v] + Vec3{step(random), step(random), step(random)};
  return mesh;
}

TEST(Uncross, WhatDoesNotCrossIsLeftAlone) {
  const TriangleMesh sphere = shapes::icosphere(3);
  TriangleMesh mesh = tangled(sphere, 1, 0.01);
  const std::vector<Vec3> moved = mesh.vertices;
  const UncrossCounts counts = uncross(sphere.vertices, spacing, SurfaceFans(mesh), mesh, Threads(2));
  EXPECT_EQ(counts.crossings, 0);
  EXPECT_EQ(counts.eased, 0);
  for (std::size_t v = 0; v < moved.size(); ++v) EXPECT_LT(distance(mesh.vertices[v], moved[v]), 1e-6);
}

TEST(Uncross, CoordinatesBecomeFloatsWhereThatIsFineEnough) {
  const TriangleMesh sphere = shapes::icosphere(2);
  TriangleMesh near = tangled(sphere, 1, 0.001), fine = near;
  uncross(sphere.vertices, spacing, SurfaceFans(near), near, Threads(1));
  for (const Vec3& p : near.vertices) EXPECT_EQ(p.x, static_cast<double>(static_cast<float>(p.x)));
  const std::vector<Vec3> exact = fine.vertices;
  uncross(sphere.vertices, 0, SurfaceFans(fine), fine, Threads(1));
  EXPECT_EQ(fine.vertices, exact);
}

TEST(Uncross, OneVertexPulledThroughTheOtherSideComesBack) {
  const TriangleMesh sphere = shapes::icosphere(3);
  TriangleMesh mesh = sphere;
  mesh.vertices[100] = -1.5 * mesh.vertices[100];
  ASSERT_GT(validate(mesh).self_intersections, 0);
  const UncrossCounts counts = uncross(sphere.vertices, spacing, SurfaceFans(mesh), mesh, Threads(2));
  EXPECT_GT(counts.crossings, 0);
  EXPECT_EQ(counts.left, 0);
  EXPECT_EQ(validate(mesh).self_intersections, 0);
  EXPECT_EQ(validate(mesh).degenerate_triangles, 0);
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    if (v != 100) {
      EXPECT_EQ(mesh.vertices[v], sphere.vertices[v]) << "it was never moved";
    }
}

TEST(Uncross, WildTanglesComeOutForAnyNumberOfThreads) {
  const TriangleMesh sphere = shapes::icosphere(3);
  for (const double most : {0.1, 0.5, 3.0}) {
    TriangleMesh mesh = tangled(sphere, 2, most), other = mesh;
    ASSERT_GT(validate(mesh).self_intersections, 0);
    EXPECT_EQ(uncross(sphere.vertices, spacing, SurfaceFans(mesh), mesh, Threads(1)).left, 0);
    uncross(sphere.vertices, spacing, SurfaceFans(other), other, Threads(3));
    EXPECT_EQ(validate(mesh).self_intersections, 0);
    EXPECT_EQ(validate(mesh).degenerate_triangles, 0);
    EXPECT_EQ(mesh.vertices, other.vertices);
  }
}

TEST(Uncross, VerticesThatMeetArePartedAndTrianglesWithoutAreaOpened) {
  const TriangleMesh sphere = shapes::icosphere(2);
  TriangleMesh mesh = sphere;
  mesh.vertices[0] = mesh.vertices[40];
  mesh.vertices[mesh.triangles[50][0]] =
      0.5 * (mesh.vertices[mesh.triangles[50][1]] + mesh.vertices[mesh.triangles[50][2]]);
  uncross(sphere.vertices, spacing, SurfaceFans(mesh), mesh, Threads(1));
  const MeshSummary summary = validate(mesh);
  EXPECT_TRUE(summary.closed() && summary.manifold());
  EXPECT_EQ(summary.self_intersections, 0);
  EXPECT_EQ(summary.degenerate_triangles, 0);
}

TEST(Uncross, AnOpenMeshKeepsItsRimWhereItIs) {
  const TriangleMesh before = shapes::grid(6, 6);
  TriangleMesh mesh = before;
  mesh.vertices[0] = {4.2, 4.3, 0}; // a corner, over to the other side
  ASSERT_GT(validate(mesh).self_intersections, 0);
  EXPECT_EQ(uncross(before.vertices, spacing, SurfaceFans(mesh), mesh, Threads(1)).left, 0);
  EXPECT_EQ(validate(mesh).self_intersections, 0);
}

std::vector<CrossingSearch::Pair> ordered(std::vector<CrossingSearch::Pair> pairs) {
  for (auto& [f, g] : pairs) std::tie(f, g) = std::minmax({f, g});
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

TEST(ClearStars, AreThoseOfASmoothSurfaceAndNotThoseAtRimsAndFolds) {
  const auto clear_of = [](const TriangleMesh& mesh) {
    return clear_stars(mesh.vertices, SurfaceFans(mesh), Threads(2));
  };
  TriangleMesh mesh = shapes::icosphere(3);
  EXPECT_EQ(clear_of(mesh), std::vector<std::uint8_t>(mesh.vertices.size(), 1));
  const std::uint32_t pulled = 100;
  mesh.vertices[pulled] = -1.5 * mesh.vertices[pulled];
  const auto clear = clear_of(mesh);
  const SurfaceFans fans(mesh);
  for (const auto& wing : fans[pulled]) EXPECT_EQ(clear[wing.next], 0) << "its star is folded";
  const TriangleMesh sheet = shapes::grid(4, 4);
  const std::vector<std::uint8_t> at_rim = SurfaceFans(sheet).rim_vertices(Threads(1)), known = clear_of(sheet);
  for (std::size_t v = 0; v < known.size(); ++v) EXPECT_EQ(known[v], at_rim[v] ? 0 : 1) << v;
}

TEST(ClearStars, ARingThatGoesAroundTwiceIsNone) {
  for (const int turns : {1, 2}) {
    TriangleMesh mesh;
    constexpr std::uint32_t n = 7;
    mesh.vertices.emplace_back();
    for (std::uint32_t i = 0; i < n; ++i) {
      const double angle = 2 * std::numbers::pi * turns * i / n;
      mesh.vertices.push_back({std::cos(angle), std::sin(angle), 0.1 * i});
      mesh.triangles.push_back({0, 1 + i, 1 + (i + 1) % n});
    }
    EXPECT_EQ(clear_stars(mesh.vertices, SurfaceFans(mesh), Threads(1))[0], turns == 1 ? 1 : 0);
  }
}

TEST(ClearStars, HideNoCrossing) {
  for (const double most : {0.06, 0.1, 0.6}) {
    const TriangleMesh mesh = tangled(shapes::icosphere(4), 2, most);
    const std::vector<std::uint8_t> sound(mesh.triangles.size(), 0),
        clear = clear_stars(mesh.vertices, SurfaceFans(mesh), Threads(2));
    EXPECT_GT(std::count(clear.begin(), clear.end(), 1), 10);
    CrossingSearch search(mesh.vertices, mesh.triangles, sound, Threads(2));
    const auto all = search.all(Threads(2));
    EXPECT_GT(all.size(), 10u);
    search.set_clear(clear);
    EXPECT_EQ(search.all(Threads(2)), all);
    EXPECT_EQ(all.size(), static_cast<std::size_t>(validate(mesh).self_intersections)) << "which looks another way";
  }
}

TEST(SurfaceFans, PiecesAreThoseThatTrianglesJoin) {
  const TriangleMesh mesh = shapes::joined(shapes::icosphere(1), shapes::grid(3, 3));
  const std::vector<std::uint32_t> piece = SurfaceFans(mesh).pieces();
  const std::size_t first = shapes::icosphere(1).vertices.size();
  for (std::size_t v = 0; v < piece.size(); ++v) EXPECT_EQ(piece[v], v < first ? 0u : 1u);
}

TEST(CrossingSearch, FindsThePairsThatItCountsEachOnce) {
  const TriangleMesh mesh = tangled(shapes::icosphere(3), 2, 0.6);
  const std::vector<std::uint8_t> sound(mesh.triangles.size(), 0);
  const CrossingSearch search(mesh.vertices, mesh.triangles, sound, Threads(2));
  const auto all = ordered(search.all(Threads(2)));
  EXPECT_EQ(all.size(), search.count(Threads(2)));
  EXPECT_EQ(std::adjacent_find(all.begin(), all.end()), all.end());
  EXPECT_EQ(search.all(Threads(2)), CrossingSearch(mesh.vertices, mesh.triangles, sound, Threads(1)).all(Threads(1)));
}

TEST(CrossingSearch, FindsThePairsOfWhatMovedAsANewSearchDoes) {
  TriangleMesh mesh = tangled(shapes::icosphere(3), 2, 0.6);
  std::vector<std::uint8_t> degenerate(mesh.triangles.size(), 0);
  const Threads threads(2);
  CrossingSearch search(mesh.vertices, mesh.triangles, degenerate, threads);
  for (std::uint32_t step = 0; step < 3; ++step) {
    // Other vertices in each step, some of them far away; one triangle comes to have no area, and is whole again.
    for (std::size_t v = step; v < mesh.vertices.size(); v += 11) {
      const tools::CounterRandom random(step, 5, v);
      mesh.vertices[v] = mesh.vertices[v] + 0.3 * Vec3{random.normal(0), random.normal(2), random.normal(4)};
    }
    degenerate[5] = step == 1;
    std::vector<std::uint32_t> changed;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
      for (const std::uint32_t v : mesh.triangles[t])
        if ((v % 11 == step || t == 5) && (changed.empty() || changed.back() != t)) changed.push_back(t);
    auto expected = ordered(CrossingSearch(mesh.vertices, mesh.triangles, degenerate, threads).all(threads));
    std::erase_if(expected, [&](const auto& pair) {
      return !std::binary_search(changed.begin(), changed.end(), pair[0]) &&
             !std::binary_search(changed.begin(), changed.end(), pair[1]);
    });
    ASSERT_GT(expected.size(), 10);
    EXPECT_EQ(ordered(search.of_changed(changed, threads)), expected) << step;
  }
}

TEST(CrossingSearch, KnowsSidesThatFloatingPointCannotTell) {
  // A tip exactly on another triangle, one last place above it, and below: apart only above.
  for (const double far : {0.0, 1e6}) {
    const auto crossings = [&](double height) {
      const std::vector<Vec3> p{{far, far, far},
                                {far + 1, far, far + 1},
                                {far, far + 1, far + 1},
                                {far + 0.25, far + 0.25, height},
                                {far + 0.3, far + 0.2, far + 9},
                                {far + 0.2, far + 0.3, far + 9}};
      const std::vector<Triangle> t{{0, 1, 2}, {3, 4, 5}};
      return CrossingSearch(p, t, std::vector<std::uint8_t>(2, 0), Threads(1)).count(Threads(1));
    };
    const double on = far + 0.5;
    EXPECT_EQ(crossings(on), 1u);
    EXPECT_EQ(crossings(std::nextafter(on, 2e9)), 0u);
    EXPECT_EQ(crossings(std::nextafter(on, 0)), 1u);
  }
}

} // namespace
} // namespace eigencrust
