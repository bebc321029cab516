// SPDX-License-Identifier: GPL-3.0-or-later
// Loops of a ball with a tunnel against its triangles, joined across all edges that are not of the loop.
#include <gmock/gmock.h>

#include <algorithm>
#include <map>
#include <set>

#include "geometry/mesh_topology.h"
#include "moves.h"
#include "repair/loop_sides.h"

namespace eigencrust {
namespace {

using Loop = std::vector<std::uint32_t>;
using Edge = std::pair<std::uint32_t, std::uint32_t>;

TetrahedronLabels labels_of_pierced_ball(const Tetrahedralization& t) {
  clouds::HandMade made(t.tetrahedra.size(), 5);
  for (TetrahedronIndex i{0}; i.value < t.tetrahedra.size(); ++i.value) {
    if (t.touches_cube(i)) continue;
    const Vec3 c = clouds::centroid(t, i);
    made.set(i, norm(c) < 0.75 && std::hypot(c.x, c.y) > 0.2 ? Label::inside : Label::outside, 5);
  }
  return made.done();
}

struct PiercedBall : clouds::MoveStage {
  PiercedBall() : PiercedBall(clouds::prepare(clouds::random_box(2500, 12))) {}
  explicit PiercedBall(const clouds::Prepared& prepared)
      : MoveStage(prepared, labels_of_pierced_ball(prepared.t), 0.15) {
    moves().make_manifold();
  }
};

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

TEST(LoopSides, FallApartWhereTheTrianglesDo) {
  PiercedBall stage;
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
  PiercedBall stage;
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
