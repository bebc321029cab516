// SPDX-License-Identifier: GPL-3.0-or-later
// Loops of meshes and solids whose genus is known by construction.
#include <eigencrust/validate.h>
#include <gmock/gmock.h>

#include <set>

#include "clouds.h"
#include "repair/handle_loops.h"
#include "repair/handles.h"
#include "repair/surface_part.h"

namespace eigencrust {
namespace {

using clouds::Prepared;
using Loop = std::vector<std::uint32_t>;

/// n · m vertices on a torus, vertex i m + j; every square is cut along the diagonal (1, 1).
std::vector<Triangle> torus_mesh(std::uint32_t n, std::uint32_t m, std::uint32_t first = 0) {
  std::vector<Triangle> triangles;
  const auto at = [&](std::uint32_t i, std::uint32_t j) { return first + i % n * m + j % m; };
  for (std::uint32_t i = 0; i < n; ++i)
    for (std::uint32_t j = 0; j < m; ++j) {
      triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  return triangles;
}

void expect_loops_along_edges(const std::vector<Loop>& loops, const std::vector<Triangle>& triangles) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const Triangle& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      edges.emplace(t[k], t[(k + 1) % 3]);
      edges.emplace(t[(k + 1) % 3], t[k]);
    }
  for (const Loop& loop : loops) {
    EXPECT_EQ(std::set<std::uint32_t>(loop.begin(), loop.end()).size(), loop.size()) << "a vertex twice";
    for (std::size_t k = 0; k < loop.size(); ++k) EXPECT_TRUE(edges.count({loop[k], loop[(k + 1) % loop.size()]}));
  }
}

/// How often the loop runs around the torus of n · m vertices, along i and along j.
std::pair<int, int> windings(const Loop& loop, int n, int m) {
  int along_i = 0, along_j = 0;
  const auto step = [](int from, int to, int size) { return (to - from + 1 + size) % size - 1; }; // -1, 0 or 1
  for (std::size_t k = 0; k < loop.size(); ++k) {
    const int a = static_cast<int>(loop[k]), b = static_cast<int>(loop[(k + 1) % loop.size()]);
    along_i += step(a / m, b / m, n);
    along_j += step(a % m, b % m, m);
  }
  return {along_i / n, along_j / m};
}

TEST(HandleLoops, SphereHasNone) {
  const std::vector<Triangle> tetrahedron{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  EXPECT_TRUE(handle_loops(tetrahedron, 4, 100, Threads(2)).empty());
  EXPECT_TRUE(handle_loops({}, 0, 100, Threads(2)).empty());
}

TEST(HandleLoops, TorusHasTwoThatGenerateAll) {
  for (const auto& [n, m] : {std::pair(5, 9), std::pair(9, 5), std::pair(4, 4), std::pair(3, 20)}) {
    const auto triangles = torus_mesh(static_cast<std::uint32_t>(n), static_cast<std::uint32_t>(m));
    const std::vector<Loop> loops =
        handle_loops(triangles, static_cast<std::size_t>(n) * static_cast<std::size_t>(m), 100, Threads(2));
    ASSERT_EQ(loops.size(), 2u);
    // A step moves by at most one along i and along j: n steps around one way, m around the other.
    EXPECT_EQ(loops[0].size(), static_cast<std::size_t>(std::min(n, m)));
    EXPECT_EQ(loops[1].size(), static_cast<std::size_t>(std::max(n, m)));
    expect_loops_along_edges(loops, triangles);
    // Two loops generate all of them exactly when their windings have determinant 1 or -1.
    const auto [ai, aj] = windings(loops[0], n, m);
    const auto [bi, bj] = windings(loops[1], n, m);
    EXPECT_EQ(std::abs(ai * bj - aj * bi), 1) << n << " x " << m;
  }
}

TEST(HandleLoops, OfTwoToriFourShortestFirst) {
  std::vector<Triangle> triangles = torus_mesh(4, 7);
  for (const Triangle& t : torus_mesh(6, 5, 28)) triangles.push_back(t);
  const std::vector<Loop> loops = handle_loops(triangles, 28 + 30, 100, Threads(2));
  std::vector<std::size_t> lengths;
  for (const Loop& loop : loops) lengths.push_back(loop.size());
  EXPECT_THAT(lengths, testing::ElementsAre(4, 5, 6, 7));
  expect_loops_along_edges(loops, triangles); // none runs from one torus to the other
}

std::vector<std::uint32_t> all_samples(const Tetrahedralization& t) {
  std::vector<std::uint32_t> all;
  for (std::uint32_t s = 0; s < t.sample_count; ++s) all.push_back(s);
  return all;
}

MeshSummary summary_of(const Tetrahedralization& t, const Labels& labels) {
  return validate(extract_surface(t, labels, Threads(2)).mesh,
                  {.self_intersections = false, .merge_equal_vertices = false});
}

TEST(SurfacePart, OfAllSamplesIsTheWholeSurface) {
  const Prepared p = clouds::prepare(clouds::random_box(400, 1));
  for (const double share : {0.1, 0.3, 0.5, 0.8}) { // few pieces up to many handles
    TetrahedronLabels labels = clouds::random_labels(p.t, share, 2);
    make_manifold(p.t, p.stars, p.poles, p.known, ManifoldRule::cheapest, labels, Threads(2));
    const MeshSummary whole = summary_of(p.t, labels.labels());
    ASSERT_GT(whole.components, 0u);
    const SurfacePart part = surface_part(p.t, p.stars, labels.labels(), all_samples(p.t));
    EXPECT_EQ(part.closed_pieces, static_cast<std::int64_t>(whole.components));
    EXPECT_EQ(part.euler, 2 * (static_cast<std::int64_t>(whole.components) - whole.genus));
  }
}

TEST(SurfacePart, ATetrahedronIsASphereAndOpenWhereASampleIsLeftOut) {
  const Prepared p = clouds::prepare(clouds::random_box(40, 3));
  TetrahedronIndex only{0};
  while (p.t.touches_cube(only)) ++only.value;
  Labels labels(p.t.tetrahedra.size(), Label::outside);
  labels[only] = Label::inside;
  std::vector<std::uint32_t> samples;
  for (const SampleIndex s : p.t.tetrahedra[only]) samples.push_back(s.value);
  std::sort(samples.begin(), samples.end());
  SurfacePart part = surface_part(p.t, p.stars, labels, samples);
  EXPECT_EQ(part.euler, 4 - 6 + 4);
  EXPECT_EQ(part.closed_pieces, 1);
  samples.pop_back(); // three vertices, six edges (each has one of them), four triangles; not closed any more
  part = surface_part(p.t, p.stars, labels, samples);
  EXPECT_EQ(part.euler, 3 - 6 + 4);
  EXPECT_EQ(part.closed_pieces, 0);
  part = surface_part(p.t, p.stars, labels, {});
  EXPECT_EQ(part.euler, 0);
  EXPECT_EQ(part.closed_pieces, 0);
}

TEST(SurfacePart, DifferenceOfAChangeIsThatOfTheWholeSurface) {
  const Prepared p = clouds::prepare(clouds::random_box(120, 4));
  Labels labels = clouds::random_labels(p.t, 0.5, 5).labels(); // not even a manifold
  clouds::Random random(6);
  std::set<std::int64_t> differences;
  for (int k = 0; k < 60; ++k) {
    TetrahedronIndex i{random.below(p.t.tetrahedra.size())};
    if (p.t.touches_cube(i)) continue;
    std::vector<std::uint32_t> samples;
    for (const SampleIndex s : p.t.tetrahedra[i]) samples.push_back(s.value);
    std::sort(samples.begin(), samples.end());
    const std::int64_t part = surface_part(p.t, p.stars, labels, samples).euler;
    const std::int64_t whole = summary_of(p.t, labels).euler;
    labels[i] = labels[i] == Label::inside ? Label::outside : Label::inside;
    const std::int64_t difference = summary_of(p.t, labels).euler - whole;
    EXPECT_EQ(surface_part(p.t, p.stars, labels, samples).euler - part, difference);
    differences.insert(difference);
  }
  EXPECT_GT(differences.size(), 2u); // else the test would say little
}

/// Random points in a box; a solid in it, part of which the first stage left open.
struct Solid {
  Prepared p = clouds::prepare(clouds::random_box(2500, 12));
  Labels first;
  TetrahedronLabels labels;
  std::vector<float> grid_spacing;

  /// `inside(c)` and `open(c)` say what is true of the tetrahedron with that centroid; open ones have a
  /// value of size `certainty`, the others of size 1.
  template <class Inside, class Open>
  Solid(Inside&& inside, Open&& open, float certainty) {
    const std::size_t n = p.t.tetrahedra.size();
    first = Labels(n, Label::outside);
    clouds::HandMade made(n, 1);
    for (TetrahedronIndex i{0}; i.value < n; ++i.value) {
      if (p.t.touches_cube(i)) continue;
      const Vec3 c = clouds::centroid(p.t, i);
      const bool is_open = open(c);
      const Label side = inside(c) ? Label::inside : Label::outside;
      made.set(i, side, is_open ? certainty : 1.0f);
      first[i] = is_open ? Label::unlabelled : side;
    }
    labels = made.done();
    make_manifold(p.t, p.stars, p.poles, p.known, ManifoldRule::cheapest, labels, Threads(2));
    grid_spacing.assign(p.t.sample_count, 0.05f); // loops of up to 3.2 are noise: all of them
  }
  std::uint64_t close() {
    return close_handles(p.t, p.stars, p.poles, first, p.known, grid_spacing, ManifoldRule::cheapest, labels,
                         Threads(2))
        .closed;
  }
  [[nodiscard]] MeshSummary summary() const { return summary_of(p.t, labels.labels()); }
};

constexpr double ball_radius = 0.75, tunnel_radius = 0.2; // the points are about 0.15 apart
bool in_ball(const Vec3& c) { return norm(c) < ball_radius; }
bool in_tunnel(const Vec3& c) { return std::hypot(c.x, c.y) < tunnel_radius && std::fabs(c.z) < ball_radius; }

/// A ball with a tunnel along the z axis.
Solid pierced_ball(float certainty) {
  return Solid([](const Vec3& c) { return in_ball(c) && !in_tunnel(c); }, in_tunnel, certainty);
}

void expect_unchanged(Solid& solid, std::int64_t genus = 1) {
  ASSERT_EQ(solid.summary().genus, genus); // with none there would be nothing to change anyway
  const TetrahedronLabels before = solid.labels;
  EXPECT_EQ(solid.close(), 0u);
  EXPECT_EQ(solid.labels.labels().raw(), before.labels().raw());
  EXPECT_EQ(solid.labels.values().raw(), before.values().raw());
}

TEST(CloseHandles, FillsATunnelThatNothingVouchesFor) {
  Solid solid = pierced_ball(0.3f);
  ASSERT_EQ(solid.summary().genus, 1);
  const TetrahedronLabels before = solid.labels;
  EXPECT_EQ(solid.close(), 1u);
  const MeshSummary after = solid.summary();
  EXPECT_EQ(after.genus, 0);
  EXPECT_TRUE(after.closed() && after.manifold() && after.oriented());
  int filled = 0, dug = 0;
  for (TetrahedronIndex i{0}; i.value < solid.first.size(); ++i.value) {
    EXPECT_EQ(std::fabs(solid.labels.value(i)), std::fabs(before.value(i)));
    if (solid.labels[i] == before[i]) continue;
    EXPECT_EQ(solid.labels.value(i) < 0, solid.labels[i] == Label::inside); // the sign follows
    filled += solid.labels[i] == Label::inside && in_tunnel(clouds::centroid(solid.p.t, i));
    dug += solid.labels[i] == Label::outside;
  }
  EXPECT_GT(filled, 0);
  EXPECT_LE(dug, filled);     // the repair may take away some, but the tunnel is filled and the ball not cut
  expect_unchanged(solid, 0); // nothing is left to do
}

TEST(CloseHandles, CutsAThinRing) {
  // All of a torus is open and the space around it is vouched for: its hole cannot be filled.
  const auto in_ring = [](const Vec3& c) { return std::hypot(std::hypot(c.x, c.y) - 0.55, c.z) < 0.2; };
  Solid solid(in_ring, in_ring, 0.3f);
  const MeshSummary before = solid.summary();
  ASSERT_EQ(before.genus, 1);
  EXPECT_EQ(solid.close(), 1u);
  const MeshSummary after = solid.summary();
  EXPECT_EQ(after.genus, 0);
  EXPECT_TRUE(after.closed() && after.manifold() && after.oriented());
  EXPECT_LT(after.volume, before.volume);
  EXPECT_GT(after.volume, 0.5 * before.volume); // a cut, not the end of the ring
}

TEST(CloseHandles, WithoutNoiseEveryHandleIsMeant) {
  Solid solid = pierced_ball(0.3f);
  solid.grid_spacing.clear();
  expect_unchanged(solid);
}

TEST(CloseHandles, LoopsLargerThanTheNoiseStay) {
  // The loop around the tunnel is about 0.5 across; 64 grid spacings are 0.064.
  Solid solid = pierced_ball(0.3f);
  solid.grid_spacing.assign(solid.p.t.sample_count, 0.001f);
  expect_unchanged(solid);
}

TEST(CloseHandles, WhatTheFirstStageVouchesForStays) {
  Solid solid = pierced_ball(0.3f);
  for (TetrahedronIndex i{0}; i.value < solid.first.size(); ++i.value) solid.first[i] = solid.labels[i];
  expect_unchanged(solid);
}

TEST(CloseHandles, WhatTheSecondStageIsSureOfStays) {
  Solid solid = pierced_ball(0.9f); // open, but nearly 1
  expect_unchanged(solid);
}

} // namespace
} // namespace eigencrust
