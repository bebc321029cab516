// SPDX-License-Identifier: GPL-3.0-or-later
// §3.5 as in the paper on cases made by hand within a random Delaunay; moves_test.cpp has the rule by energy.
#include <eigencrust/validate.h>
#include <gmock/gmock.h>

#include <limits>
#include <map>
#include <set>

#include "clouds.h"

namespace eigencrust {
namespace {

using clouds::Prepared;

/// All outside with value 1.
TetrahedronLabels all_outside(const Tetrahedralization& t) { return clouds::HandMade(t.tetrahedra.size(), 1).done(); }
void set_inside(TetrahedronLabels& labels, TetrahedronIndex t, float certainty) {
  clouds::put(labels, t, Label::inside, certainty);
}

std::set<VertexIndex> vertices_of(const Tetrahedralization& t, TetrahedronIndex i) {
  return {t.tetrahedra[i].begin(), t.tetrahedra[i].end()};
}
std::vector<VertexIndex> shared(const Tetrahedralization& t, TetrahedronIndex a, TetrahedronIndex b) {
  const auto va = vertices_of(t, a), vb = vertices_of(t, b);
  std::vector<VertexIndex> common;
  std::set_intersection(va.begin(), va.end(), vb.begin(), vb.end(), std::back_inserter(common));
  return common;
}

std::vector<TetrahedronIndex> inside_of(const TetrahedronLabels& labels) {
  std::vector<TetrahedronIndex> inside;
  for (TetrahedronIndex i{0}; i.value < labels.size(); ++i.value)
    if (labels[i] == Label::inside) inside.push_back(i);
  return inside;
}

void expect_closed_manifold(const Tetrahedralization& t, const TetrahedronLabels& labels) {
  const Surface surface = extract_surface(t, labels.labels(), Threads(2));
  if (surface.mesh.triangles.empty()) return;
  const MeshSummary summary = validate(surface.mesh, {.self_intersections = false, .merge_equal_vertices = false});
  EXPECT_TRUE(summary.closed() && summary.manifold() && summary.oriented());
}

/// The first two tetrahedra away from the cube that have exactly `count` vertices in common.
std::pair<TetrahedronIndex, TetrahedronIndex> pair_sharing(const Tetrahedralization& t, std::size_t count,
                                                           std::uint32_t start = 0) {
  for (TetrahedronIndex a{start}; a.value < t.tetrahedra.size(); ++a.value)
    for (TetrahedronIndex b{a.value + 1}; b.value < t.tetrahedra.size(); ++b.value)
      if (!t.touches_cube(a) && !t.touches_cube(b) && shared(t, a, b).size() == count) return {a, b};
  return {};
}

TEST(Manifold, WhatIsManifoldIsLeftAlone) {
  const Prepared p = clouds::prepare(clouds::random_box(60, 1));
  const auto [a, b] = pair_sharing(p.t, 3);
  TetrahedronLabels labels = all_outside(p.t);
  set_inside(labels, a, 0.5f);
  set_inside(labels, b, 0.25f);
  const ManifoldCounts counts = make_manifold(p.t, p.stars, p.poles, p.known, labels, Threads(2));
  EXPECT_EQ(counts.edges + counts.vertices + counts.relabelled, 0u);
  EXPECT_THAT(inside_of(labels), testing::ElementsAre(a, b));
}

TEST(Manifold, OfTwoStrandsAtAnEdgeTheMoreCertainStays) {
  const Prepared p = clouds::prepare(clouds::random_box(60, 2));
  const auto [a, b] = pair_sharing(p.t, 2);
  for (const bool first_is_stronger : {true, false}) {
    TetrahedronLabels labels = all_outside(p.t); // outside is certain: filling up would cost more
    set_inside(labels, a, first_is_stronger ? 0.5f : 0.25f);
    set_inside(labels, b, first_is_stronger ? 0.25f : 0.5f);
    const ManifoldCounts counts = make_manifold(p.t, p.stars, p.poles, p.known, labels, Threads(2));
    EXPECT_THAT(inside_of(labels), testing::ElementsAre(first_is_stronger ? a : b));
    EXPECT_EQ(counts.edges, 1u);
    EXPECT_EQ(counts.relabelled, 1u);
  }
}

TEST(Manifold, OfEquallyCertainStrandsTheLargerStays) {
  const Prepared p = clouds::prepare(clouds::random_box(60, 3));
  for (std::uint32_t start = 0; start < 40; start += 10) {
    const auto [a, b] = pair_sharing(p.t, 2, start);
    TetrahedronLabels labels = all_outside(p.t);
    set_inside(labels, a, 0.5f);
    set_inside(labels, b, 0.5f);
    make_manifold(p.t, p.stars, p.poles, p.known, labels, Threads(2));
    EXPECT_THAT(inside_of(labels), testing::ElementsAre(clouds::volume(p.t, a) > clouds::volume(p.t, b) ? a : b));
  }
}

TEST(Manifold, AtABowTieTheComponentWithThePoleStays) {
  const Prepared p = clouds::prepare(clouds::random_box(80, 5));
  int tried = 0;
  for (std::uint32_t i = 0; i < p.t.sample_count; ++i) {
    const SampleIndex s{i};
    const PolePair pair = p.poles.of_sample[s];
    if (!pair.second.valid()) continue;
    const TetrahedronIndex pole = p.poles.tetrahedron[pair.second], first = p.poles.tetrahedron[pair.first];
    if (p.t.touches_cube(pole)) continue;
    for (const TetrahedronIndex other : p.stars[s]) {
      if (other == first || p.t.touches_cube(other) || shared(p.t, pole, other).size() != 1) continue;
      TetrahedronLabels labels = all_outside(p.t);
      set_inside(labels, pole, 0.25f);
      set_inside(labels, other, 0.5f); // more certain, but no pole
      const ManifoldCounts counts = make_manifold(p.t, p.stars, p.poles, p.known, labels, Threads(2));
      EXPECT_THAT(inside_of(labels), testing::ElementsAre(pole));
      EXPECT_EQ(counts.vertices, 1u);
      ++tried;
      break;
    }
  }
  EXPECT_GE(tried, 10);
}

TEST(Manifold, CavitiesThatTouchAreJoinedAlongTheShortestPath) {
  // Within a solid of inside tetrahedra two open cavities meet at one sample s. What is relabelled in its
  // star must be as cheap as the cheapest path between them, found here by relaxing all edges.
  const Prepared p = clouds::prepare(clouds::random_box(400, 6));
  clouds::Random random(7);
  int tried = 0;
  for (std::uint32_t i = 0; i < p.t.sample_count && tried < 20; ++i) {
    const SampleIndex s{i};
    const std::vector<TetrahedronIndex> star(p.stars[s].begin(), p.stars[s].end());
    const bool deep = std::none_of(star.begin(), star.end(), [&](TetrahedronIndex t) {
      const auto& n = p.t.neighbours[t];
      return std::any_of(n.begin(), n.end(), [&](TetrahedronIndex k) { return p.t.touches_cube(k); });
    });
    if (!deep) continue;
    TetrahedronIndex other;
    for (const TetrahedronIndex t : star)
      if (shared(p.t, t, star[0]).size() == 1) other = t;
    if (!other.valid()) continue;
    TetrahedronLabels labels = all_outside(p.t);
    for (std::uint32_t k = 0; k < p.t.tetrahedra.size(); ++k)
      if (!p.t.touches_cube(TetrahedronIndex{k}))
        set_inside(labels, TetrahedronIndex{k}, static_cast<float>(random.uniform(0.1, 1)));
    TetrahedronLabels solid = labels;
    make_manifold(p.t, p.stars, p.poles, p.known, solid,
                  Threads(2)); // its hull may need repair, once
    for (const TetrahedronIndex t : {star[0], other}) clouds::put(solid, t, Label::outside);
    // Bellman-Ford over the star.
    std::map<TetrahedronIndex, double> length;
    for (const TetrahedronIndex t : star) length[t] = std::numeric_limits<double>::infinity();
    length[star[0]] = 0;
    for (std::size_t round = 0; round < star.size(); ++round)
      for (const TetrahedronIndex t : star)
        for (const TetrahedronIndex n : p.t.neighbours[t])
          if (length.count(n))
            length[n] = std::min(length[n], length[t] + (n == other ? 0.0 : std::fabs(double(solid.value(n)))));
    const TetrahedronLabels before = solid;
    const ManifoldCounts counts = make_manifold(p.t, p.stars, p.poles, p.known, solid, Threads(2));
    expect_closed_manifold(p.t, solid);
    if (counts.vertices != 1 || counts.edges != 0) continue; // the path met something else
    double price = 0;
    for (const TetrahedronIndex t : star)
      if (before[t] != solid[t]) price += std::fabs(static_cast<double>(solid.value(t)));
    EXPECT_NEAR(price, length[other], 1e-9);
    ++tried;
  }
  EXPECT_GE(tried, 5);
}

TEST(Manifold, CheckpointMayCancel) {
  const Prepared p = clouds::prepare(clouds::random_box(60, 8));
  TetrahedronLabels labels = clouds::random_labels(p.t, 0.5, 9);
  const auto cancel = [](double) { throw std::runtime_error("cancelled"); };
  EXPECT_THROW(make_manifold(p.t, p.stars, p.poles, p.known, labels, Threads(2), cancel), std::runtime_error);
}

} // namespace
} // namespace eigencrust
