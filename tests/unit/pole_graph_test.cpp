// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>

#include <map>
#include <set>

#include "clouds.h"

namespace eigencrust {
namespace {

using clouds::Points;
using clouds::Prepared;
using Pair = std::pair<std::uint32_t, std::uint32_t>; // poles, smaller first

Labels known_of(const Prepared& p, const Points& inside = {}) {
  return known_labels(p.t, p.stars, {}, inside, {}, Threads(1));
}

double cosine(const Sphere& a, const Sphere& b) {
  return (squared_norm(a.centre - b.centre) - a.radius * a.radius - b.radius * b.radius) / (2 * a.radius * b.radius);
}

/// Pairs of neighbouring samples.
std::set<Pair> delaunay_edges(const Prepared& p) {
  std::set<Pair> edges;
  for (const auto& v : p.t.tetrahedra)
    for (const VertexIndex a : v)
      for (const VertexIndex b : v)
        if (a < b && !p.t.is_corner(a) && !p.t.is_corner(b)) edges.insert({a.value, b.value});
  return edges;
}

/// The whole edge set of §3.1 from its definition, before anything is collapsed or left out.
std::map<Pair, double> all_edges(const Prepared& p) {
  std::map<Pair, double> edges;
  const auto& of_sample = p.poles.of_sample.raw();
  const auto& sphere = p.poles.sphere.raw();
  for (const auto& [s, other] : delaunay_edges(p))
    for (const PoleIndex a : {of_sample[s].first, of_sample[s].second})
      for (const PoleIndex b : {of_sample[other].first, of_sample[other].second}) {
        if (!a.valid() || !b.valid() || a == b) continue;
        const double c = cosine(sphere[a.value], sphere[b.value]);
        if (c <= 1) edges[std::minmax(a.value, b.value)] = std::exp(4 - 4 * std::max(c, -1.0));
      }
  for (const PolePair& pair : of_sample) // pole pairs override
    if (pair.second.valid()) {
      const double c = cosine(sphere[pair.first.value], sphere[pair.second.value]);
      edges[std::minmax(pair.first.value, pair.second.value)] = -std::exp(4 + 4 * std::clamp(c, -1.0, 1.0));
    }
  return edges;
}

struct Expected {
  std::vector<std::uint32_t> node; // of each pole, or none
  std::uint32_t nodes = 0;
  std::map<Pair, double> edges;                       // between nodes
  std::vector<std::map<std::uint32_t, double>> super; // node -> sum
};

struct OfSamples {
  std::vector<float> isolated;
  std::vector<std::uint8_t> noisy;
};

/// Clusters of poles that are nodes. From the largest ball on, each takes the first of the largest ball of neighbouring
/// samples that nearly coincides with its own, is larger and not its opposite; one of noisy samples the largest of all
/// their firsts that coincides with it as well. The smallest pole of its cluster for each.
std::vector<std::uint32_t> cluster_of(const Prepared& p, const std::vector<bool>& is_node, const OfSamples& of) {
  const auto& of_sample = p.poles.of_sample.raw();
  const auto& sphere = p.poles.sphere.raw();
  const auto is_larger = [&](std::uint32_t a, std::uint32_t b) {
    return sphere[a].radius > sphere[b].radius || (sphere[a].radius == sphere[b].radius && a < b);
  };
  std::set<Pair> pole_pairs;
  std::vector<bool> noisy(is_node.size());
  for (std::uint32_t s = 0; s < of_sample.size(); ++s)
    for (const PoleIndex a : {of_sample[s].first, of_sample[s].second})
      if (a.valid() && !of.noisy.empty() && of.noisy[s]) noisy[a.value] = true;
  for (const PolePair& pair : of_sample)
    if (pair.second.valid()) pole_pairs.insert(std::minmax(pair.first.value, pair.second.value));
  std::vector<std::set<std::uint32_t>> larger(is_node.size());
  for (const auto& [s, other] : delaunay_edges(p)) {
    if (!of.isolated.empty() && (of.isolated[s] > 0 || of.isolated[other] > 0)) continue;
    for (PoleIndex a : {of_sample[s].first, of_sample[s].second})
      for (PoleIndex b : {of_sample[other].first, of_sample[other].second}) {
        if (!a.valid() || !b.valid() || a == b || !is_node[a.value] || !is_node[b.value]) continue;
        if (pole_pairs.count(std::minmax(a.value, b.value))) continue;
        const auto [low, high] = is_larger(a.value, b.value) ? Pair(b.value, a.value) : Pair(a.value, b.value);
        if (cosine(sphere[low], sphere[high]) < -0.93) larger[low].insert(high);
      }
  }
  std::vector<std::uint32_t> order(is_node.size()), first(is_node.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), is_larger);
  for (const std::uint32_t a : order) {
    first[a] = a;
    std::vector<std::uint32_t> up(larger[a].begin(), larger[a].end());
    std::sort(up.begin(), up.end(), is_larger);
    if (noisy[a]) {
      for (const std::uint32_t b : up)
        if (is_larger(first[b], first[a]) && cosine(sphere[a], sphere[first[b]]) < -0.8) first[a] = first[b];
    } else if (!up.empty()) {
      first[a] = first[up.front()];
    }
  }
  std::map<std::uint32_t, std::uint32_t> smallest;
  for (std::uint32_t a = 0; a < first.size(); ++a) smallest.emplace(first[a], a);
  std::vector<std::uint32_t> cluster;
  for (const std::uint32_t f : first) cluster.push_back(smallest.at(f));
  return cluster;
}

Expected expected_graph(const Prepared& p, const Labels& known, const std::vector<std::uint8_t>& left_out,
                        std::size_t supernodes, const OfSamples* contract = nullptr) {
  Expected e;
  e.super.resize(supernodes);
  const std::uint32_t poles = p.poles.tetrahedron.size();
  const auto label = [&](std::uint32_t pole) { return known[p.poles.tetrahedron.raw()[pole]]; };
  std::vector<bool> is_node(poles);
  for (std::uint32_t pole = 0; pole < poles; ++pole) {
    const bool out = !left_out.empty() && left_out[p.poles.tetrahedron.raw()[pole].value];
    is_node[pole] = label(pole) == Label::unlabelled && !out;
  }
  const auto cluster =
      cluster_of(p, is_node, contract ? *contract : OfSamples{std::vector<float>(p.t.sample_count, 1.0f), {}});
  e.node.assign(poles, NodeIndex::none);
  for (std::uint32_t pole = 0; pole < poles; ++pole)
    if (is_node[pole]) e.node[pole] = cluster[pole] == pole ? e.nodes++ : e.node[cluster[pole]];
  for (const auto& [ends, w] : all_edges(p)) {
    for (const auto& [a, b] : {ends, Pair{ends.second, ends.first}}) {
      if (!is_node[a]) continue;
      if (label(b) == Label::outside) e.super[0][e.node[a]] += w;
      if (label(b) == Label::inside) e.super[1][e.node[a]] += w;
      if (is_node[b] && e.node[a] != e.node[b]) e.edges[{e.node[a], e.node[b]}] += w;
    }
  }
  return e;
}

void expect_equal(const PoleGraph& g, const Expected& e) {
  ASSERT_EQ(g.node.size(), e.node.size());
  for (std::uint32_t i = 0; i < e.node.size(); ++i) EXPECT_EQ(g.node.raw()[i].value, e.node[i]);
  ASSERT_EQ(g.graph.column.size(), e.edges.size());
  ASSERT_EQ(g.graph.node_count(), e.nodes);
  for (std::uint32_t i = 0; i < g.graph.node_count(); ++i)
    for (std::uint64_t k = g.graph.row_begin[i]; k < g.graph.row_begin[i + 1]; ++k) {
      const std::uint32_t j = g.graph.column[k];
      if (k > g.graph.row_begin[i]) {
        EXPECT_LT(g.graph.column[k - 1], j);
      }
      const auto at = e.edges.find({i, j});
      ASSERT_NE(at, e.edges.end()) << i << " " << j;
      EXPECT_NEAR(g.graph.weight[k], at->second, 1e-5 * (1 + std::fabs(at->second)));
    }
  ASSERT_EQ(g.graph.supernodes.size(), e.super.size());
  for (std::size_t s = 0; s < e.super.size(); ++s)
    for (std::uint32_t i = 0; i < g.graph.node_count(); ++i) {
      const auto at = e.super[s].find(i);
      const double sum = at == e.super[s].end() ? 0.0 : at->second;
      EXPECT_NEAR(g.graph.supernodes[s].weight[i], sum, 1e-5 * (1 + std::fabs(sum)) + 1e-2) << i;
    }
}

TEST(PoleGraph, EqualsTheEdgeSetOfTheDefinition) {
  for (const std::uint64_t seed : {1u, 2u, 3u, 4u}) {
    const Prepared p = clouds::prepare(clouds::random_box(30 + 10 * seed, seed));
    const Labels known = known_of(p);
    expect_equal(pole_graph(p.t, p.stars, p.poles, known, {}, {}, false, Threads(1)), expected_graph(p, known, {}, 1));
  }
}

TEST(PoleGraph, OnASurfaceTheSupernodeRepelsTheInside) {
  const Prepared p = clouds::prepare(clouds::jittered(clouds::sphere(60), 0.02, 5));
  const Labels known = known_of(p);
  const PoleGraph g = pole_graph(p.t, p.stars, p.poles, known, {}, {}, false, Threads(1));
  expect_equal(g, expected_graph(p, known, {}, 1));
  double smallest = 0;
  for (const float w : g.graph.supernodes[0].weight) smallest = std::min(smallest, static_cast<double>(w));
  EXPECT_LT(smallest, 0);
}

TEST(PoleGraph, LeftOutPolesAreNoNodes) {
  const Prepared p = clouds::prepare(clouds::random_box(50, 6));
  const Labels known = known_of(p);
  clouds::Random random(7);
  std::vector<std::uint8_t> left_out(p.t.tetrahedra.size());
  for (auto& flag : left_out) flag = random.uniform() < 0.3;
  const PoleGraph g = pole_graph(p.t, p.stars, p.poles, known, left_out, {}, false, Threads(1));
  expect_equal(g, expected_graph(p, known, left_out, 1));
  const PoleGraph none =
      pole_graph(p.t, p.stars, p.poles, known, std::vector<std::uint8_t>(left_out.size(), 1), {}, false, Threads(1));
  EXPECT_EQ(none.graph.node_count(), 0u);
}

TEST(PoleGraph, InsidePointsMakeASecondSupernode) {
  const Prepared p = clouds::prepare(clouds::random_box(50, 8));
  // The middle of the first pole away from the cube: that pole is no node any more.
  PoleIndex pole;
  for (std::uint32_t i = 0; i < p.poles.tetrahedron.size() && !pole.valid(); ++i)
    if (!p.t.touches_cube(p.poles.tetrahedron.raw()[i])) pole.value = i;
  const Vec3 middle = clouds::centroid(p.t, p.poles.tetrahedron[pole]) + p.t.origin;
  const Labels known = known_of(p, {middle});
  ASSERT_EQ(known[p.poles.tetrahedron[pole]], Label::inside);
  const PoleGraph g = pole_graph(p.t, p.stars, p.poles, known, {}, {}, false, Threads(1));
  expect_equal(g, expected_graph(p, known, {}, 2));
  double sum = 0;
  for (const auto& super : g.graph.supernodes)
    for (const float w : super.weight) sum += std::fabs(static_cast<double>(w));
  EXPECT_NEAR(g.graph.supernode_weight[0][1], -sum, 1e-6 * sum); // one large negative edge
  EXPECT_EQ(g.graph.supernode_weight[0][1], g.graph.supernode_weight[1][0]);
  EXPECT_EQ(g.graph.supernode_weight[0][0], 0);
}

TEST(PoleGraph, WeightsStayWithinTheirRanges) {
  // A lattice has poles shared by many samples and spheres that touch: cosines at their limits.
  for (const Points& points : {clouds::lattice(4, 4, 4), clouds::sphere(200), clouds::random_box(200, 9)}) {
    const Prepared p = clouds::prepare(points);
    const PoleGraph g = pole_graph(p.t, p.stars, p.poles, known_of(p), {}, {}, false, Threads(1));
    for (const float w : g.graph.weight) {
      const double size = std::fabs(static_cast<double>(w));
      EXPECT_LE(size, std::exp(8.0) * (1 + 1e-6));
      EXPECT_GE(size, (w < 0 ? std::exp(4.0) : 1.0) * (1 - 1e-6));
    }
  }
}

TEST(PoleGraph, ContractedItIsTheSumOverClusters) {
  std::size_t contracted = 0;
  for (const Points& points :
       {clouds::jittered(clouds::sphere(80), 0.01, 11), clouds::jittered(clouds::sphere(150), 0.002, 12),
        clouds::random_box(60, 13), clouds::jittered(clouds::lattice(3, 4, 5), 0.01, 14)}) {
    const Prepared p = clouds::prepare(points);
    const Labels known = known_of(p);
    clouds::Random random(15);
    OfSamples some_noisy, all_noisy;
    all_noisy.noisy.assign(p.t.sample_count, 1);
    for (std::uint32_t s = 0; s < p.t.sample_count; ++s) some_noisy.noisy.push_back(random.uniform() < 0.2);
    for (const OfSamples& of : {OfSamples{}, some_noisy, all_noisy}) {
      const Expected e = expected_graph(p, known, {}, 1, &of);
      contracted += expected_graph(p, known, {}, 1).nodes - e.nodes;
      expect_equal(pole_graph(p.t, p.stars, p.poles, known, {}, {{}, of.noisy}, true, Threads(2)), e);
      std::vector<std::uint8_t> left_out(p.t.tetrahedra.size());
      for (auto& flag : left_out) flag = random.uniform() < 0.3;
      expect_equal(pole_graph(p.t, p.stars, p.poles, known, left_out, {{}, of.noisy}, true, Threads(1)),
                   expected_graph(p, known, left_out, 1, &of));
    }
  }
  EXPECT_GT(contracted, 150u);
}

TEST(PoleGraph, IsolatedSamplesContractNothing) {
  const Prepared p = clouds::prepare(clouds::jittered(clouds::sphere(150), 0.005, 16));
  const Labels known = known_of(p);
  clouds::Random random(17);
  OfSamples of;
  for (std::uint32_t s = 0; s < p.t.sample_count; ++s) of.isolated.push_back(random.uniform() < 0.5 ? 0.5f : 0.0f);
  std::vector<bool> is_node;
  for (const TetrahedronIndex t : p.poles.tetrahedron) is_node.push_back(known[t] == Label::unlabelled);
  for (const bool noisy : {false, true}) {
    of.noisy.assign(p.t.sample_count, noisy ? 1 : 0);
    const PoleGraph g =
        pole_graph(p.t, p.stars, p.poles, known, {}, {SampleLengths(of.isolated), of.noisy}, true, Threads(1));
    const auto cluster = cluster_of(p, is_node, of), of_all = cluster_of(p, is_node, {{}, of.noisy});
    EXPECT_NE(cluster, of_all);
    for (std::uint32_t i = 0; i < cluster.size(); ++i)
      for (std::uint32_t j = 0; j < i; ++j)
        if (is_node[i] && is_node[j]) {
          ASSERT_EQ(g.node.raw()[i] == g.node.raw()[j], cluster[i] == cluster[j]) << i << " " << j;
        }
  }
}

/// Poles in noise are nowhere farther from the first of their node than their balls nearly coincide; along chains some
/// are.
TEST(PoleGraph, NoisyPolesJoinAlongNoChains) {
  const Prepared p = clouds::prepare(clouds::jittered(clouds::sphere(2000), 0.02, 18));
  const auto& sphere = p.poles.sphere.raw();
  const auto farthest = [&](const std::vector<std::uint8_t>& noisy) {
    const PoleGraph g = pole_graph(p.t, p.stars, p.poles, known_of(p), {}, {{}, noisy}, true, Threads(1));
    std::vector<std::uint32_t> first(g.graph.node_count(), NodeIndex::none);
    const auto for_each = [&](auto&& visit) {
      for (std::uint32_t i = 0; i < g.node.size(); ++i)
        if (g.node.raw()[i].valid()) visit(i, first[g.node.raw()[i].value]);
    };
    for_each([&](std::uint32_t i, std::uint32_t& f) {
      if (f == NodeIndex::none || sphere[i].radius > sphere[f].radius) f = i;
    });
    double largest = -1;
    for_each([&](std::uint32_t i, std::uint32_t f) {
      if (i != f) largest = std::max(largest, cosine(sphere[i], sphere[f]));
    });
    return largest;
  };
  EXPECT_LT(farthest(std::vector<std::uint8_t>(p.t.sample_count, 1)), -0.8);
  EXPECT_GT(farthest({}), -0.5);
}

TEST(PoleGraph, IsSymmetricAndTheSameForAnyThreads) {
  const Points points = clouds::random_box(1500, 10); // several blocks of nodes
  const Prepared p = clouds::prepare(points);
  const Labels known = known_of(p);
  for (const bool contract : {false, true}) {
    const PoleGraph g = pole_graph(p.t, p.stars, p.poles, known, {}, {}, contract, Threads(1));
    std::map<Pair, float> entries;
    for (std::uint32_t i = 0; i < g.graph.node_count(); ++i)
      for (std::uint64_t k = g.graph.row_begin[i]; k < g.graph.row_begin[i + 1]; ++k)
        entries[{i, g.graph.column[k]}] = g.graph.weight[k];
    for (const auto& [ends, w] : entries) {
      EXPECT_NE(ends.first, ends.second);
      EXPECT_EQ(w, entries.at({ends.second, ends.first}));
    }
    for (const unsigned threads : {2u, 3u}) {
      const PoleGraph other = pole_graph(p.t, p.stars, p.poles, known, {}, {}, contract, Threads(threads));
      EXPECT_EQ(other.graph.row_begin, g.graph.row_begin);
      EXPECT_EQ(other.graph.column, g.graph.column);
      EXPECT_EQ(other.graph.weight, g.graph.weight);
      EXPECT_EQ(other.graph.supernodes[0].weight, g.graph.supernodes[0].weight);
    }
  }
}

} // namespace
} // namespace eigencrust
