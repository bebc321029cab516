// SPDX-License-Identifier: GPL-3.0-or-later
// §3.4: the second graph, on the tetrahedra that have no label yet.
#include <algorithm>
#include <cmath>

#include <eigencrust/stages.h>

#include "parallel/threads.h"

namespace eigencrust {
namespace {

/// Longest over shortest edge of the face opposite vertex k: skinny faces resist being cut.
double face_weight(const Tetrahedralization& t, const std::array<SampleIndex, 4>& v, std::size_t k) {
  const Vec3 &a = t.positions[v[(k + 1) % 4]], &b = t.positions[v[(k + 2) % 4]], &c = t.positions[v[(k + 3) % 4]];
  const double ab = squared_norm(a - b), bc = squared_norm(b - c), ca = squared_norm(c - a);
  // Sums of weights stay numbers, in 32 bits, where one edge is 1e40 times as long as another.
  constexpr double most = 1e15;
  return std::min(most, std::sqrt(std::max({ab, bc, ca}) / std::min({ab, bc, ca})));
}

} // namespace

TetrahedronGraph tetrahedron_graph(const Tetrahedralization& t, const Labels& labels, const Threads& threads) {
  TetrahedronGraph result;
  std::vector<std::uint32_t> node_of(t.tetrahedra.size(), NodeIndex::none);
  for (std::uint32_t i = 0; i < t.tetrahedra.size(); ++i) {
    if (labels.raw()[i] != Label::unlabelled) continue;
    node_of[i] = result.tetrahedron.size();
    result.tetrahedron.raw().push_back(TetrahedronIndex{i});
  }
  const std::uint32_t nodes = result.tetrahedron.size();
  SignedGraph& graph = result.graph;
  graph.row_begin.assign(nodes + 1, 0);
  for_each_index(threads, nodes, [&](std::size_t i) {
    for (const TetrahedronIndex n : t.neighbours[result.tetrahedron.raw()[i]])
      if (n.valid() && node_of[n.value] != NodeIndex::none) ++graph.row_begin[i + 1];
  });
  for (std::uint32_t i = 0; i < nodes; ++i) graph.row_begin[i + 1] += graph.row_begin[i];
  graph.column.resize(graph.row_begin[nodes]);
  graph.weight.resize(graph.row_begin[nodes]);
  graph.supernodes.assign(2, {std::vector<float>(nodes, 0.0f)});
  for_each_index(threads, nodes, [&](std::size_t i) {
    const TetrahedronIndex tetrahedron = result.tetrahedron.raw()[i];
    // Insertion keeps the row sorted; it has at most four entries.
    std::uint64_t end = graph.row_begin[i];
    for (std::size_t k = 0; k < 4; ++k) {
      const TetrahedronIndex n = t.neighbours[tetrahedron][k];
      if (!n.valid()) continue;
      const auto w = static_cast<float>(face_weight(t, t.tetrahedra[tetrahedron], k));
      const std::uint32_t node = node_of[n.value];
      if (node == NodeIndex::none) {
        graph.supernodes[labels[n] == Label::outside ? 0 : 1].weight[i] += w;
        continue;
      }
      std::uint64_t at = end++;
      for (; at > graph.row_begin[i] && graph.column[at - 1] > node; --at) {
        graph.column[at] = graph.column[at - 1];
        graph.weight[at] = graph.weight[at - 1];
      }
      graph.column[at] = node;
      graph.weight[at] = w;
    }
  });
  // The one negative edge: as strong as all other edges of the supernodes together.
  double sum = 0;
  for (const SignedGraph::Supernode& super : graph.supernodes)
    for (const float w : super.weight) sum += static_cast<double>(w);
  graph.supernode_weight = {{0, -sum}, {-sum, 0}};
  return result;
}

} // namespace eigencrust
