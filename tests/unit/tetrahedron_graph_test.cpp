// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>

#include <map>

#include "clouds.h"

namespace eigencrust {
namespace {

using clouds::Prepared;

/// Cube tetrahedra outside, the others outside, inside or open at random.
Labels random_partial_labels(const Tetrahedralization& t, std::uint64_t seed) {
  clouds::Random random(seed);
  Labels labels(t.tetrahedra.size(), Label::outside);
  for (std::uint32_t i = 0; i < t.tetrahedra.size(); ++i)
    if (!t.touches_cube(TetrahedronIndex{i})) labels.raw()[i] = static_cast<Label>(random.below(3));
  return labels;
}

double longest_over_shortest(const Tetrahedralization& t, const std::vector<VertexIndex>& face) {
  const double a = distance(t.positions[face[0]], t.positions[face[1]]),
               b = distance(t.positions[face[1]], t.positions[face[2]]),
               c = distance(t.positions[face[2]], t.positions[face[0]]);
  return std::max({a, b, c}) / std::min({a, b, c});
}

/// §3.4 from its definition: every pair of tetrahedra that share three vertices.
void expect_faces(const Tetrahedralization& t, const Labels& labels, const TetrahedronGraph& h) {
  std::map<std::vector<VertexIndex>, std::vector<std::uint32_t>> sharing;
  for (std::uint32_t i = 0; i < t.tetrahedra.size(); ++i)
    for (const VertexIndex left_out : t.tetrahedra.raw()[i]) {
      std::vector<VertexIndex> face;
      for (const VertexIndex s : t.tetrahedra.raw()[i])
        if (s != left_out) face.push_back(s);
      std::sort(face.begin(), face.end());
      sharing[face].push_back(i);
    }
  std::map<std::uint32_t, std::uint32_t> node_of;
  for (std::uint32_t i = 0; i < h.tetrahedron.size(); ++i) node_of[h.tetrahedron.raw()[i].value] = i;
  std::map<std::pair<std::uint32_t, std::uint32_t>, double> edges;
  std::array<std::vector<double>, 2> super{std::vector<double>(node_of.size(), 0.0),
                                           std::vector<double>(node_of.size(), 0.0)};
  for (const auto& [face, pair] : sharing) {
    if (pair.size() < 2) continue;
    const double w = longest_over_shortest(t, face);
    for (const auto& [a, b] : {std::pair(pair[0], pair[1]), std::pair(pair[1], pair[0])}) {
      if (!node_of.count(a)) continue;
      if (node_of.count(b))
        edges[{node_of[a], node_of[b]}] += w;
      else
        super[labels.raw()[b] == Label::outside ? 0 : 1][node_of[a]] += w;
    }
  }
  ASSERT_EQ(h.graph.column.size(), edges.size());
  for (std::uint32_t i = 0; i < h.graph.node_count(); ++i) {
    for (std::uint64_t e = h.graph.row_begin[i]; e < h.graph.row_begin[i + 1]; ++e) {
      if (e > h.graph.row_begin[i]) {
        EXPECT_LT(h.graph.column[e - 1], h.graph.column[e]);
      }
      EXPECT_NEAR((h.graph.weight[e] / edges.at({i, h.graph.column[e]})), 1, 1e-6);
      EXPECT_GE(h.graph.weight[e], 1);
    }
    for (std::size_t s = 0; s < 2; ++s)
      EXPECT_NEAR(h.graph.supernodes[s].weight[i], super[s][i], 1e-5 * (1 + super[s][i]));
  }
}

TEST(TetrahedronGraph, EqualsItsDefinition) {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const Prepared p = clouds::prepare(clouds::random_box(60, seed));
    const Labels labels = random_partial_labels(p.t, seed);
    expect_faces(p.t, labels, tetrahedron_graph(p.t, labels, Threads(2)));
  }
}

TEST(TetrahedronGraph, SupernodesRepelAsMuchAsTheyAttract) {
  const Prepared p = clouds::prepare(clouds::random_box(100, 4));
  const TetrahedronGraph h = tetrahedron_graph(p.t, random_partial_labels(p.t, 5), Threads(1));
  double sum = 0;
  for (const auto& super : h.graph.supernodes)
    for (const float w : super.weight) sum += static_cast<double>(w);
  EXPECT_GT(sum, 0);
  EXPECT_NEAR(h.graph.supernode_weight[0][1], -sum, 1e-6 * sum);
  EXPECT_EQ(h.graph.supernode_weight[1][0], h.graph.supernode_weight[0][1]);
}

TEST(TetrahedronGraph, OfNothingOpenIsEmpty) {
  const Prepared p = clouds::prepare(clouds::random_box(30, 8));
  const TetrahedronGraph h = tetrahedron_graph(p.t, Labels(p.t.tetrahedra.size(), Label::outside), Threads(1));
  EXPECT_EQ(h.graph.node_count(), 0u);
  EXPECT_EQ(h.graph.supernodes.size(), 2u);
}

} // namespace
} // namespace eigencrust
