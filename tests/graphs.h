// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Small signed graphs for tests of the numerics and the partitions.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "clouds.h"

namespace eigencrust::graphs {

using Edges = std::map<std::pair<std::uint32_t, std::uint32_t>, double>;

/// Each edge is given once, in either order; supernode s has weight super[s][node].
inline SignedGraph from_edges(std::uint32_t nodes, const Edges& edges,
                              const std::vector<std::map<std::uint32_t, double>>& super = {}) {
  Edges both;
  for (const auto& [ends, w] : edges) both[ends] = both[{ends.second, ends.first}] = w;
  SignedGraph graph;
  graph.row_begin.assign(nodes + 1, 0);
  for (const auto& [ends, w] : both) {
    ++graph.row_begin[ends.first + 1];
    graph.column.push_back(ends.second);
    graph.weight.push_back(static_cast<float>(w));
  }
  for (std::uint32_t i = 0; i < nodes; ++i) graph.row_begin[i + 1] += graph.row_begin[i];
  for (const auto& weights : super) {
    SignedGraph::Supernode node{std::vector<float>(nodes, 0.0f)};
    for (const auto& [i, w] : weights) node.weight[i] = static_cast<float>(w);
    graph.supernodes.push_back(std::move(node));
  }
  graph.supernode_weight.assign(super.size(), std::vector<double>(super.size(), 0.0));
  return graph;
}

/// A graph with a planted side for every node.
struct Planted {
  SignedGraph graph;
  std::vector<int> side; ///< +1 or -1 for each node; the supernode, if any, is at +1
};

/// A ring of n nodes with random chords, about `degree` edges per node; the share `wrong` of the edges
/// contradicts the planted sides. With a supernode, one node in ten is joined to it.
inline Planted planted(std::uint32_t n, unsigned degree, double wrong, bool supernode, std::uint64_t seed) {
  clouds::Random random(seed);
  Planted result;
  for (std::uint32_t i = 0; i < n; ++i) result.side.push_back(random.uniform() < 0.5 ? -1 : 1);
  const auto weight = [&](int a, int b) {
    const double sign = a == b ? 1 : -1;
    const double size = std::exp(random.uniform(0, 4));
    return (random.uniform() < wrong ? -sign : sign) * size;
  };
  Edges edges;
  for (std::uint32_t i = 0; i < n; ++i)
    for (unsigned k = 0; 2 * k < degree; ++k) {
      const std::uint32_t j = k == 0 ? (i + 1) % n : random.below(n);
      if (i != j) edges[std::minmax(i, j)] = weight(result.side[i], result.side[j]);
    }
  std::vector<std::map<std::uint32_t, double>> super;
  if (supernode) {
    super.emplace_back();
    for (std::uint32_t i = 0; i < n; i += 10) super[0][i] = weight(1, result.side[i]);
  }
  result.graph = from_edges(n, edges, super);
  return result;
}

} // namespace eigencrust::graphs
