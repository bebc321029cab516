// SPDX-License-Identifier: GPL-3.0-or-later
#include "numerics/components.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace eigencrust {

Components connected_components(const SignedGraph& graph) {
  const std::uint32_t n = graph.node_count();
  Components result;
  result.of_node.assign(n, no_index);
  std::vector<std::uint32_t> stack;
  const auto flood = [&](std::uint32_t number) {
    while (!stack.empty()) {
      const std::uint32_t i = stack.back();
      stack.pop_back();
      for (std::uint64_t e = graph.row_begin[i]; e < graph.row_begin[i + 1]; ++e) {
        const std::uint32_t j = graph.column[e];
        if (result.of_node[j] != no_index) continue;
        result.of_node[j] = number;
        stack.push_back(j);
      }
    }
  };
  for (const SignedGraph::Supernode& super : graph.supernodes)
    for (std::uint32_t i = 0; i < n; ++i)
      if (super.weight[i] != 0 && result.of_node[i] == no_index) {
        result.of_node[i] = 0;
        stack.push_back(i);
      }
  flood(0);
  result.count = 1;
  for (std::uint32_t i = 0; i < n; ++i) {
    if (result.of_node[i] != no_index) continue;
    result.of_node[i] = result.count;
    stack.push_back(i);
    flood(result.count++);
  }
  return result;
}

SignedGraph extract_component(const SignedGraph& graph, std::uint32_t component,
                              const std::vector<std::uint32_t>& nodes) {
  SignedGraph sub;
  sub.row_begin.push_back(0);
  const auto local = [&](std::uint32_t node) {
    return static_cast<std::uint32_t>(std::lower_bound(nodes.begin(), nodes.end(), node) - nodes.begin());
  };
  for (const std::uint32_t i : nodes) {
    for (std::uint64_t e = graph.row_begin[i]; e < graph.row_begin[i + 1]; ++e) {
      sub.column.push_back(local(graph.column[e]));
      sub.weight.push_back(graph.weight[e]);
    }
    sub.row_begin.push_back(sub.column.size());
  }
  if (component != 0) return sub;
  for (const SignedGraph::Supernode& super : graph.supernodes) {
    SignedGraph::Supernode part;
    for (const std::uint32_t i : nodes) part.weight.push_back(super.weight[i]);
    sub.supernodes.push_back(std::move(part));
  }
  sub.supernode_weight = graph.supernode_weight;
  return sub;
}

BorderedMatrix signed_laplacian(SignedGraph graph, const Threads& threads) {
  const std::uint32_t n = graph.node_count();
  const std::size_t k = graph.supernodes.size();
  BorderedMatrix m;
  m.row_begin = std::move(graph.row_begin);
  m.column = std::move(graph.column);
  m.value = std::move(graph.weight);
  m.diagonal.resize(n);
  for_each_index(threads, n, [&](std::size_t i) {
    double sum = 0;
    for (std::uint64_t e = m.row_begin[i]; e < m.row_begin[i + 1]; ++e) {
      sum += std::fabs(static_cast<double>(m.value[e]));
      m.value[e] = -m.value[e];
    }
    for (const SignedGraph::Supernode& super : graph.supernodes) sum += std::fabs(static_cast<double>(super.weight[i]));
    m.diagonal[i] = sum;
  });
  m.corner.assign(k, std::vector<double>(k, 0.0));
  for (std::size_t s = 0; s < k; ++s) {
    std::vector<float> column = std::move(graph.supernodes[s].weight);
    m.corner[s][s] = sum_blocks<double>(threads, n, [&](std::size_t begin, std::size_t end) {
      double part = 0;
      for (std::size_t i = begin; i < end; ++i) part += std::fabs(static_cast<double>(column[i]));
      return part;
    });
    for (float& w : column) w = -w;
    m.border.push_back(std::move(column));
    for (std::size_t u = 0; u < k; ++u)
      if (u != s) {
        m.corner[s][u] = -graph.supernode_weight[s][u];
        m.corner[s][s] += std::fabs(graph.supernode_weight[s][u]);
      }
  }
  return m;
}

} // namespace eigencrust
