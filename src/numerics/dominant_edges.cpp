// SPDX-License-Identifier: GPL-3.0-or-later
#include "numerics/dominant_edges.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "numerics/weight_table.h"
#include "parallel/compressed_rows.h"

namespace eigencrust {
namespace {

// A round that merges fewer nodes is the last: what is left is a few long chains at large nodes, and each round costs a
// pass over all edges.
constexpr double least_share = 0.01;

/// Disjoint sets that remember on which side of its set's root each member is.
class SignedSets {
 public:
  explicit SignedSets(std::uint32_t n) : parent_(n), sign_(n, 1) { std::iota(parent_.begin(), parent_.end(), 0u); }

  struct Place {
    std::uint32_t root;
    std::int8_t sign;
  };
  Place find(std::uint32_t i) {
    std::uint32_t root = i;
    std::int8_t sign = 1;
    for (; parent_[root] != root; root = parent_[root]) sign = static_cast<std::int8_t>(sign * sign_[root]);
    const Place place{root, sign};
    while (parent_[i] != i) {
      const std::uint32_t next = parent_[i];
      const auto rest = static_cast<std::int8_t>(sign * sign_[i]);
      parent_[i] = root;
      sign_[i] = sign;
      sign = rest;
      i = next;
    }
    return place;
  }
  /// Puts both into one set, rooted at the smaller root.
  void unite(std::uint32_t a, std::uint32_t b, std::int8_t sign) {
    Place first = find(a), second = find(b);
    if (first.root == second.root) return;
    if (second.root < first.root) std::swap(first, second);
    parent_[second.root] = first.root;
    sign_[second.root] = static_cast<std::int8_t>(first.sign * second.sign * sign);
  }

 private:
  std::vector<std::uint32_t> parent_;
  std::vector<std::int8_t> sign_;
};

/// For each node the place of the edge that weighs as much as all its others, or none; equal ones: the first.
std::vector<std::uint64_t> dominant_edges(const SignedGraph& graph, const Threads& threads) {
  constexpr std::uint64_t no_edge = ~std::uint64_t{0};
  std::vector<std::uint64_t> dominant(graph.node_count(), no_edge);
  for_each_index(threads, dominant.size(), [&](std::size_t i) {
    double total = 0, most = 0;
    for (const SignedGraph::Supernode& super : graph.supernodes)
      total += std::fabs(static_cast<double>(super.weight[i]));
    std::uint64_t best = no_edge;
    for (std::uint64_t e = graph.row_begin[i]; e < graph.row_begin[i + 1]; ++e) {
      const double weight = std::fabs(static_cast<double>(graph.weight[e]));
      total += weight;
      if (weight > most) {
        most = weight;
        best = e;
      }
    }
    if (2 * most >= total) dominant[i] = best;
  });
  return dominant;
}

/// The graph of the sets; edges within them are gone.
SignedGraph merged(const SignedGraph& graph, const std::vector<std::uint32_t>& node,
                   const std::vector<std::int8_t>& sign, std::uint32_t nodes, const Threads& threads) {
  const auto members = build_rows<std::uint32_t>(nodes, [&](auto&& visit) {
    for (std::uint32_t i = 0; i < node.size(); ++i) visit(node[i], i);
  });
  using Entry = std::pair<std::uint32_t, float>;
  auto rows = build_rows<Entry>(threads, nodes, block_with_table(nodes), [&] {
    return [&, sums = WeightTable(nodes)](std::size_t own, std::vector<Entry>& row) mutable {
      sums.clear();
      for (const std::uint32_t i : members[own])
        for (std::uint64_t e = graph.row_begin[i]; e < graph.row_begin[i + 1]; ++e)
          if (const std::uint32_t j = graph.column[e]; node[j] != own)
            sums.add(node[j], sign[i] * sign[j] * static_cast<double>(graph.weight[e]));
      const auto begin = static_cast<std::ptrdiff_t>(row.size());
      sums.for_each([&](std::uint32_t other, float w) { row.emplace_back(other, w); });
      std::sort(row.begin() + begin, row.end());
    };
  });
  SignedGraph result;
  split_rows(std::move(rows), result.row_begin, result.column, result.weight, threads);
  result.supernodes.assign(graph.supernodes.size(), {std::vector<float>(nodes, 0.0f)});
  for (std::size_t s = 0; s < graph.supernodes.size(); ++s)
    for (std::uint32_t i = 0; i < node.size(); ++i)
      result.supernodes[s].weight[node[i]] += static_cast<float>(sign[i]) * graph.supernodes[s].weight[i];
  result.supernode_weight = graph.supernode_weight;
  return result;
}

} // namespace

ReducedGraph merge_dominated_nodes(const SignedGraph& whole, const Threads& threads) {
  ReducedGraph reduced{
      {}, std::vector<std::uint32_t>(whole.node_count()), std::vector<std::int8_t>(whole.node_count(), 1)};
  std::iota(reduced.node.begin(), reduced.node.end(), 0u);
  for (const SignedGraph* graph = &whole;;) {
    const std::vector<std::uint64_t> dominant = dominant_edges(*graph, threads);
    SignedSets sets(graph->node_count());
    for (std::uint32_t i = 0; i < dominant.size(); ++i)
      if (dominant[i] < graph->weight.size())
        sets.unite(i, graph->column[dominant[i]], graph->weight[dominant[i]] > 0 ? 1 : -1);
    std::vector<std::uint32_t> node(dominant.size(), no_index);
    std::vector<std::int8_t> sign(dominant.size());
    std::uint32_t nodes = 0;
    for (std::uint32_t i = 0; i < node.size(); ++i) {
      const auto [root, side] = sets.find(i);
      node[i] = root == i ? nodes++ : node[root];
      sign[i] = side;
    }
    for (std::size_t i = 0; i < reduced.node.size(); ++i) {
      reduced.sign[i] = static_cast<std::int8_t>(reduced.sign[i] * sign[reduced.node[i]]);
      reduced.node[i] = node[reduced.node[i]];
    }
    const bool enough = nodes >= (1 - least_share) * graph->node_count();
    reduced.graph = merged(*graph, node, sign, nodes, threads);
    if (enough) return reduced;
    graph = &reduced.graph;
  }
}

} // namespace eigencrust
