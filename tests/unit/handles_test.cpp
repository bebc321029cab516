// SPDX-License-Identifier: GPL-3.0-or-later
// Loops of meshes and solids whose genus is known by construction.
#include <eigencrust/validate.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <map>
#include <set>

#include "geometry/mesh_topology.h"
#include "moves.h"
#include "repair/handle_loops.h"
#include "repair/loop_sides.h"

namespace eigencrust {
namespace {

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

TEST(LoopsNearby, AreAsShortAsThereAreAnyThroughTheRoot) {
  const auto triangles = torus_mesh(6, 9);
  LoopsNearby nearby(54, [&](std::uint32_t v, std::vector<LoopsNearby::NamedTriangle>& at) {
    for (std::size_t i = 0; i < triangles.size(); ++i)
      if (std::find(triangles[i].begin(), triangles[i].end(), v) != triangles[i].end()) at.push_back({i, triangles[i]});
  });
  for (std::uint32_t root = 0; root < 54; ++root) {
    const std::vector<Loop> all = nearby.at(root, 9, Threads(2));
    expect_loops_along_edges(all, triangles);
    ASSERT_EQ(all.size(), 2u) << "from " << root;
    EXPECT_EQ(all[0].size(), 6u);
    EXPECT_EQ(all[1].size(), 9u);
    const std::vector<Loop> near = nearby.at(root, 3, Threads(2));
    ASSERT_EQ(near.size(), 1u) << "from " << root; // the longer way around is out of reach
    EXPECT_EQ(near[0].size(), 6u);
    EXPECT_TRUE(nearby.at(root, 2, Threads(2)).empty()); // a disc
  }
}

/// Random points in a box; a solid in it, part of which hardly anyone vouches for.
struct Solid : clouds::MoveStage {
  /// `inside(c)` and `open(c)` say what is true of the tetrahedron with that centroid; open ones have a data term of
  /// size `certainty`, the others of size 5.
  template <class Inside, class Open>
  Solid(Inside&& inside, Open&& open, float certainty) : Solid(clouds::prepare(clouds::random_box(2500, 12))) {
    clouds::HandMade made(p.t.tetrahedra.size(), 5);
    for (TetrahedronIndex i{0}; i.value < p.t.tetrahedra.size(); ++i.value) {
      if (p.t.touches_cube(i)) continue;
      const Vec3 c = clouds::centroid(p.t, i);
      made.set(i, inside(c) ? Label::inside : Label::outside, open(c) ? certainty : 5.0f);
    }
    labels = made.done();
    energy.data = labels.values();
    moves().make_manifold();
    set_noise(1);
  }
  explicit Solid(const clouds::Prepared& prepared)
      : MoveStage(prepared, clouds::HandMade(prepared.t.tetrahedra.size(), 1).done(), 0.15) {
  } // as far as the points are apart
  /// \param noise in spacings
  void set_noise(float noise) {
    model.noise = model.input_noise = SampleLengths(p.t.sample_count, noise * model.spacing.raw().front());
  }
  std::uint64_t close() {
    Moves engine = moves();
    const std::uint64_t closed = close_handles(engine).closed;
    if (closed > 0) engine.settle_values();
    return closed;
  }
};

/// A ball, and a small one beside it that may be noise.
Solid ball_and_speck(float certainty) {
  const auto in_speck = [](const Vec3& c) { return norm(c - Vec3{0.65, 0, 0}) < 0.2; };
  return Solid([&](const Vec3& c) { return norm(c + Vec3{0.3, 0, 0}) < 0.5 || in_speck(c); }, in_speck, certainty);
}
std::uint64_t drop(Solid& solid) {
  Moves engine = solid.moves();
  const std::uint64_t dropped = drop_pieces(engine).dropped;
  if (dropped > 0) engine.settle_values();
  return dropped;
}

TEST(DropPieces, WhatHardlyAnyoneVouchesForGoes) {
  Solid solid = ball_and_speck(0.05f);
  const MeshSummary before = solid.summary();
  ASSERT_EQ(before.components, 2);
  EXPECT_EQ(drop(solid), 1u);
  const MeshSummary after = solid.summary();
  EXPECT_EQ(after.components, 1);
  EXPECT_LT(after.volume, before.volume);
  EXPECT_TRUE(clouds::is_closed_manifold(after));
  EXPECT_EQ(drop(solid), 0u); // the ball stays
}

TEST(DropPieces, WhatTheSamplesVouchForStays) {
  Solid solid = ball_and_speck(5.0f);
  ASSERT_EQ(solid.summary().components, 2);
  solid.set_noise(0.25f);
  EXPECT_EQ(drop(solid), 0u);
  EXPECT_EQ(solid.summary().components, 2);
}

TEST(DropPieces, WhatIsKnownStays) {
  Solid solid = ball_and_speck(0.05f);
  for (TetrahedronIndex i{0}; i.value < solid.labels.size(); ++i.value)
    if (norm(clouds::centroid(solid.p.t, i) - Vec3{0.65, 0, 0}) < 0.12) solid.energy.known[i] = solid.labels[i];
  EXPECT_EQ(drop(solid), 0u);
  EXPECT_EQ(solid.summary().components, 2);
}

TEST(DropPieces, AHollowIsFilled) {
  const auto in_hollow = [](const Vec3& c) { return norm(c) < 0.2; };
  Solid solid([&](const Vec3& c) { return norm(c) < 0.75 && !in_hollow(c); }, in_hollow, 0.05f);
  const double before = solid.summary().volume;
  ASSERT_EQ(solid.summary().components, 2);
  EXPECT_EQ(drop(solid), 1u);
  EXPECT_EQ(solid.summary().components, 1);
  EXPECT_GT(solid.summary().volume, before);
}

constexpr double ball_radius = 0.75, tunnel_radius = 0.2;
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

TEST(CloseHandles, FillsATunnelThatHardlyAnyoneVouchesFor) {
  Solid solid = pierced_ball(0.3f);
  ASSERT_EQ(solid.summary().genus, 1);
  const Labels before = solid.labels.labels();
  EXPECT_EQ(solid.close(), 1u);
  const MeshSummary after = solid.summary();
  EXPECT_EQ(after.genus, 0);
  EXPECT_TRUE(clouds::is_closed_manifold(after));
  int filled = 0, dug = 0;
  for (TetrahedronIndex i{0}; i.value < before.size(); ++i.value) {
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
  // All of a torus is open and the space around it is vouched for: its hole cannot be filled as cheaply.
  const auto in_ring = [](const Vec3& c) { return std::hypot(std::hypot(c.x, c.y) - 0.55, c.z) < 0.2; };
  Solid solid(in_ring, in_ring, 0.3f);
  const MeshSummary before = solid.summary();
  ASSERT_EQ(before.genus, 1);
  EXPECT_EQ(solid.close(), 1u);
  const MeshSummary after = solid.summary();
  EXPECT_EQ(after.genus, 0);
  EXPECT_TRUE(clouds::is_closed_manifold(after));
  EXPECT_LT(after.volume, before.volume);
  EXPECT_GT(after.volume, 0.5 * before.volume); // a cut, not the end of the ring
}

TEST(CloseHandles, WithoutNoiseAWideHandleIsMeant) {
  // A tunnel three spacings in radius, as little vouched for as the narrow one.
  const auto in_wide = [](const Vec3& c) { return std::hypot(c.x, c.y) < 0.45 && std::fabs(c.z) < ball_radius; };
  Solid solid([&](const Vec3& c) { return in_ball(c) && !in_wide(c); }, in_wide, 0.3f);
  solid.set_noise(0);
  expect_unchanged(solid);
  solid.set_noise(0.02f);
  expect_unchanged(solid);
  solid.set_noise(1);
  EXPECT_GT(solid.close(), 0u); // noise makes such tunnels
  EXPECT_EQ(solid.summary().genus, 0);
}

TEST(CloseHandles, NarrowerThanSamplesShowIsClosedWhereHardlyAnyoneVouchesForIt) {
  Solid solid = pierced_ball(0.01f);
  solid.set_noise(0);
  ASSERT_EQ(solid.summary().genus, 1);
  EXPECT_EQ(solid.close(), 1u);
  EXPECT_EQ(solid.summary().genus, 0);
  Solid sure = pierced_ball(5.0f);
  sure.set_noise(0);
  expect_unchanged(sure);
}

TEST(CloseHandles, WhatTheSamplesVouchForStays) {
  Solid solid = pierced_ball(5.0f);
  solid.set_noise(0.25f);
  expect_unchanged(solid);
}

TEST(CloseHandles, WhatIsKnownStays) {
  Solid solid = pierced_ball(0.3f);
  for (TetrahedronIndex i{0}; i.value < solid.labels.size(); ++i.value)
    if (in_tunnel(clouds::centroid(solid.p.t, i))) solid.energy.known[i] = solid.labels[i];
  EXPECT_EQ(solid.close(), 0u);
  for (TetrahedronIndex i{0}; i.value < solid.labels.size(); ++i.value)
    if (solid.energy.known[i] != Label::unlabelled) {
      ASSERT_EQ(solid.labels[i], solid.energy.known[i]);
    }
}

using Edge = std::pair<std::uint32_t, std::uint32_t>;

/// Triangles between samples.
std::vector<Triangle> triangles_of(const clouds::MoveStage& stage) {
  Surface surface = stage.surface();
  for (Triangle& triangle : surface.mesh.triangles)
    for (std::uint32_t& v : triangle) v = surface.sample_of[v].value;
  return surface.mesh.triangles;
}

Edge edge_of(const Loop& loop, std::size_t k) { return std::minmax(loop[k], loop[(k + 1) % loop.size()]); }

/// The triangles at each edge.
std::map<Edge, std::vector<std::uint32_t>> edges_of(const std::vector<Triangle>& triangles) {
  std::map<Edge, std::vector<std::uint32_t>> edges;
  for (std::uint32_t i = 0; i < triangles.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) edges[std::minmax(triangles[i][k], triangles[i][(k + 1) % 3])].push_back(i);
  return edges;
}

bool hangs_together_without(const Loop& loop, const std::vector<Triangle>& triangles,
                            const std::map<Edge, std::vector<std::uint32_t>>& edges) {
  std::set<Edge> cut;
  for (std::size_t k = 0; k < loop.size(); ++k) cut.insert(edge_of(loop, k));
  DisjointSets joined(triangles.size());
  std::size_t parts = triangles.size();
  for (const auto& [edge, at] : edges) {
    if (cut.count(edge) || joined.find(at[0]) == joined.find(at[1])) continue;
    joined.unite(at[0], at[1]);
    --parts;
  }
  return parts == 1;
}

/// The loops that the edges off a tree of randomly chosen edges close, as winding as such trees are.
std::vector<Loop> loops_of_a_random_tree(const std::map<Edge, std::vector<std::uint32_t>>& edges, std::uint32_t samples,
                                         std::uint64_t seed) {
  std::vector<Edge> all;
  for (const auto& [edge, at] : edges) all.push_back(edge);
  clouds::Random random(seed);
  for (auto k = static_cast<std::uint32_t>(all.size()); k > 1; --k) std::swap(all[k - 1], all[random.below(k)]);
  DisjointSets joined(samples);
  std::map<std::uint32_t, std::vector<std::uint32_t>> tree;
  std::vector<Edge> off;
  for (const auto& [a, b] : all) {
    if (joined.find(a) == joined.find(b)) {
      off.emplace_back(a, b);
      continue;
    }
    joined.unite(a, b);
    tree[a].push_back(b);
    tree[b].push_back(a);
  }
  std::vector<Loop> loops;
  for (const auto& [a, b] : off) {
    std::map<std::uint32_t, std::uint32_t> from{{a, a}};
    Loop queue{a};
    for (std::size_t k = 0; k < queue.size(); ++k)
      for (const std::uint32_t next : tree[queue[k]])
        if (from.emplace(next, queue[k]).second) queue.push_back(next);
    Loop loop{b};
    while (loop.back() != a) loop.push_back(from.at(loop.back()));
    loops.push_back(std::move(loop));
  }
  return loops;
}

/// Against the triangles, joined across all edges that are not of the loop.
TEST(LoopSides, FallApartWhereTheTrianglesDo) {
  Solid stage = pierced_ball(5);
  ASSERT_EQ(stage.summary().genus, 1);
  const std::vector<Triangle> triangles = triangles_of(stage);
  const auto edges = edges_of(triangles);
  const Moves moves = stage.moves();
  LoopSides sides(stage.p.t, stage.p.stars, moves.labels());
  int together = 0, apart = 0;
  for (const std::uint64_t seed : {1, 2}) {
    for (Loop& loop : loops_of_a_random_tree(edges, stage.p.t.sample_count, seed)) {
      const bool expected = !hangs_together_without(loop, triangles, edges);
      (expected ? apart : together) += 1;
      EXPECT_EQ(sides.fall_apart(loop, ~std::uint64_t{0}), expected) << "of " << loop.size() << " samples";
      std::reverse(loop.begin(), loop.end());
      EXPECT_EQ(sides.fall_apart(loop, ~std::uint64_t{0}), expected) << "backwards";
      EXPECT_FALSE(sides.fall_apart(loop, 0));
    }
  }
  EXPECT_GT(together, 100);
  EXPECT_GT(apart, 100);
}

TEST(LoopSides, WhatIsNoLoopOfTheSurfaceHasNone) {
  Solid stage = pierced_ball(5);
  const std::vector<Triangle> triangles = triangles_of(stage);
  const Moves moves = stage.moves();
  LoopSides sides(stage.p.t, stage.p.stars, moves.labels());
  const auto [a, b, c] = triangles.front();
  EXPECT_TRUE(sides.fall_apart(Loop{a, b, c}, 1000)); // around one triangle
  const auto edges = edges_of(triangles);
  const auto far = std::find_if(triangles.begin(), triangles.end(), [&](const Triangle& t) {
    return edges.count(std::minmax(a, t[0])) == 0 && edges.count(std::minmax(b, t[0])) == 0;
  });
  ASSERT_NE(far, triangles.end());
  EXPECT_FALSE(sides.fall_apart(Loop{a, b, (*far)[0]}, 1000));
}

} // namespace
} // namespace eigencrust
