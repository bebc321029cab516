// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>

#include <map>

#include "clouds.h"
#include "tetrahedra/circumsphere.h"

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

double longest_over_shortest(const Tetrahedralization& t, const std::vector<SampleIndex>& face) {
  const double a = distance(t.positions[face[0]], t.positions[face[1]]),
               b = distance(t.positions[face[1]], t.positions[face[2]]),
               c = distance(t.positions[face[2]], t.positions[face[0]]);
  return std::max({a, b, c}) / std::min({a, b, c});
}

/// §3.4 from its definition: every pair of tetrahedra that share three vertices.
void expect_faces(const Tetrahedralization& t, const Labels& labels, const TetrahedronGraph& h) {
  std::map<std::vector<SampleIndex>, std::vector<std::uint32_t>> sharing;
  for (std::uint32_t i = 0; i < t.tetrahedra.size(); ++i)
    for (const SampleIndex left_out : t.tetrahedra.raw()[i]) {
      std::vector<SampleIndex> face;
      for (const SampleIndex s : t.tetrahedra.raw()[i])
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
    expect_faces(p.t, labels, tetrahedron_graph(p.t, p.poles, labels, 0, {}, Threads(2)));
  }
}

TEST(TetrahedronGraph, SupernodesRepelAsMuchAsTheyAttract) {
  const Prepared p = clouds::prepare(clouds::random_box(100, 4));
  for (const double ties : {0.0, 0.5}) {
    const TetrahedronGraph h = tetrahedron_graph(p.t, p.poles, random_partial_labels(p.t, 5), ties, {}, Threads(1));
    double sum = 0;
    for (const auto& super : h.graph.supernodes)
      for (const float w : super.weight) sum += static_cast<double>(w);
    EXPECT_GT(sum, 0);
    EXPECT_NEAR(h.graph.supernode_weight[0][1], -sum, 1e-6 * sum);
    EXPECT_EQ(h.graph.supernode_weight[1][0], h.graph.supernode_weight[0][1]);
  }
}

TEST(TetrahedronGraph, PoleTiesFollowTheirFormula) {
  const Prepared p = clouds::prepare(clouds::random_box(80, 6));
  const Labels labels = random_partial_labels(p.t, 7);
  const TetrahedronGraph with = tetrahedron_graph(p.t, p.poles, labels, 0.25, {}, Threads(2));
  const TetrahedronGraph without = tetrahedron_graph(p.t, p.poles, labels, 0, {}, Threads(2));
  EXPECT_EQ(with.graph.weight, without.graph.weight);
  int tied = 0;
  for (std::uint32_t i = 0; i < with.graph.node_count(); ++i) {
    const auto& v = p.t.tetrahedra[with.tetrahedron.raw()[i]];
    const Vec3 c = circumcentre(p.t.positions[v[0]], p.t.positions[v[1]], p.t.positions[v[2]], p.t.positions[v[3]]);
    std::array<double, 2> expected{0, 0};
    for (const SampleIndex s : v) {
      if (p.t.is_corner(s)) continue;
      const PolePair pair = p.poles.of_sample[s];
      if (!pair.first.valid() || !pair.second.valid()) continue;
      const Label first = labels[p.poles.tetrahedron[pair.first]], second = labels[p.poles.tetrahedron[pair.second]];
      if (first == Label::unlabelled || second == Label::unlabelled || first == second) continue;
      for (const PoleIndex pole : {pair.first, pair.second}) {
        const Vec3 a = p.poles.sphere[pole].centre - p.t.positions[s], b = c - p.t.positions[s];
        const bool outside = labels[p.poles.tetrahedron[pole]] == Label::outside;
        expected[outside ? 0 : 1] += 0.25 * std::exp(4 * dot(a, b) / (norm(a) * norm(b)));
      }
    }
    for (std::size_t s = 0; s < 2; ++s) {
      const double tie = static_cast<double>(with.graph.supernodes[s].weight[i]) -
                         static_cast<double>(without.graph.supernodes[s].weight[i]);
      EXPECT_NEAR(tie, expected[s], 1e-4 * (1 + expected[s]));
      tied += expected[s] > 0;
    }
  }
  EXPECT_GT(tied, 0);
}

TEST(TetrahedronGraph, OfNothingOpenIsEmpty) {
  const Prepared p = clouds::prepare(clouds::random_box(30, 8));
  const TetrahedronGraph h =
      tetrahedron_graph(p.t, p.poles, Labels(p.t.tetrahedra.size(), Label::outside), 0.1, {}, Threads(1));
  EXPECT_EQ(h.graph.node_count(), 0u);
  EXPECT_EQ(h.graph.supernodes.size(), 2u);
}

} // namespace
} // namespace eigencrust
