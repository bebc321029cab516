// SPDX-License-Identifier: GPL-3.0-or-later
#include "numerics/dominant_edges.h"

#include <eigencrust/stages.h>
#include <gmock/gmock.h>

#include <cmath>

#include "graphs.h"

namespace eigencrust {
namespace {

/// Sum of the weights that the signs contradict; supernodes are at +1.
double frustration(const SignedGraph& graph, const std::vector<int>& sign) {
  double sum = 0;
  for (std::uint32_t i = 0; i < graph.node_count(); ++i) {
    for (std::uint64_t e = graph.row_begin[i]; e < graph.row_begin[i + 1]; ++e) {
      const double w = static_cast<double>(graph.weight[e]) * sign[i] * sign[graph.column[e]];
      if (graph.column[e] > i && w < 0) sum -= w;
    }
    for (const SignedGraph::Supernode& super : graph.supernodes)
      if (const double w = static_cast<double>(super.weight[i]) * sign[i]; w < 0) sum -= w;
  }
  return sum;
}

/// The least over all signs.
std::vector<int> least_frustrated(const SignedGraph& graph) {
  const std::uint32_t n = graph.node_count();
  std::vector<int> best, sign(n);
  double least = std::numeric_limits<double>::infinity();
  for (std::uint32_t bits = 0; bits < 1u << n; ++bits) {
    for (std::uint32_t i = 0; i < n; ++i) sign[i] = (bits >> i) & 1 ? -1 : 1;
    if (const double f = frustration(graph, sign); f < least) {
      least = f;
      best = sign;
    }
  }
  return best;
}

TEST(DominantEdges, TheLeastFrustrationOfTheReducedGraphIsThatOfTheWhole) {
  std::size_t merged = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const graphs::Planted p = graphs::planted(10, 3, 0.3, true, seed);
    const ReducedGraph reduced = merge_dominated_nodes(p.graph, Threads(1));
    const std::vector<int> of_reduced = least_frustrated(reduced.graph);
    std::vector<int> sign(10);
    for (std::size_t i = 0; i < 10; ++i) sign[i] = reduced.sign[i] * of_reduced[reduced.node[i]];
    const double whole = frustration(p.graph, least_frustrated(p.graph));
    EXPECT_NEAR(frustration(p.graph, sign), whole, 1e-4 * (1 + whole)) << seed;
    merged += 10 - reduced.graph.node_count();
  }
  EXPECT_GT(merged, 600u);
}

TEST(DominantEdges, NodesThatRepelAreOneWithOppositeSigns) {
  const SignedGraph graph = graphs::from_edges(3, {{{0, 1}, -5.0}, {{1, 2}, 1.0}}, {{{2, 9.0}}});
  const ReducedGraph reduced = merge_dominated_nodes(graph, Threads(1));
  EXPECT_EQ(reduced.node[0], reduced.node[1]);
  EXPECT_EQ(reduced.sign[0] * reduced.sign[1], -1);
  EXPECT_EQ(reduced.node[2], reduced.node[0]); // its only other edge leads to the supernode and is no edge to a node
}

TEST(DominantEdges, WhatTheSupernodeHoldsStays) {
  const SignedGraph graph = graphs::from_edges(2, {{{0, 1}, 1.0}}, {{{0, 5.0}, {1, 5.0}}});
  const ReducedGraph reduced = merge_dominated_nodes(graph, Threads(1));
  EXPECT_EQ(reduced.graph.node_count(), 2u);
}

TEST(DominantEdges, NoNodesAreNoNodes) {
  EXPECT_EQ(merge_dominated_nodes(graphs::from_edges(0, {}, {{}}), Threads(2)).graph.node_count(), 0u);
}

TEST(DominantEdges, RowsAreTheSameForAnyNumberOfThreads) {
  const graphs::Planted p = graphs::planted(20000, 4, 0.1, true, 3);
  const ReducedGraph one = merge_dominated_nodes(p.graph, Threads(1));
  EXPECT_LT(one.graph.node_count(), 15000u);
  for (const unsigned threads : {2u, 3u, 8u}) {
    const ReducedGraph several = merge_dominated_nodes(p.graph, Threads(threads));
    EXPECT_EQ(several.node, one.node);
    EXPECT_EQ(several.sign, one.sign);
    EXPECT_EQ(several.graph.column, one.graph.column);
    EXPECT_EQ(several.graph.weight, one.graph.weight);
  }
}

TEST(DominantEdges, ASpeckThatHangsByAWeakEdgeDoesNotOwnTheEigenvector) {
  // Three nodes that hold together and to a graph with contradictions by one weak edge.
  const std::uint32_t n = 3000;
  graphs::Planted p = graphs::planted(n, 8, 0.05, true, 5);
  graphs::Edges edges{{{n, n + 1}, 7000.0}, {{n + 1, n + 2}, 5000.0}, {{0, n}, 1.0}};
  for (std::uint32_t i = 0; i < n; ++i)
    for (std::uint64_t e = p.graph.row_begin[i]; e < p.graph.row_begin[i + 1]; ++e)
      edges[std::minmax(i, p.graph.column[e])] = static_cast<double>(p.graph.weight[e]);
  std::vector<std::map<std::uint32_t, double>> super(1);
  for (std::uint32_t i = 0; i < n; ++i)
    if (p.graph.supernodes[0].weight[i] != 0) super[0][i] = static_cast<double>(p.graph.supernodes[0].weight[i]);
  const PoleGraph graph{graphs::from_edges(n + 3, edges, super), {}};
  SolverOptions options;
  options.stop_on_stable_signs = false;
  const auto typical = [&](bool reduce) {
    const Partition partition = partition_poles(graph, options, reduce, Threads(1));
    double sum = 0;
    for (std::uint32_t i = 0; i < n; ++i) sum += std::fabs(static_cast<double>(partition.value[i])) / n;
    return sum;
  };
  EXPECT_LT(typical(false), 0.01);
  EXPECT_GT(typical(true), 0.03);
}

} // namespace
} // namespace eigencrust
