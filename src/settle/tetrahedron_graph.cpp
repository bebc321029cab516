// SPDX-License-Identifier: GPL-3.0-or-later
// §3.4: the second graph, on the tetrahedra that have no label yet.
#include <algorithm>
#include <cmath>

#include <eigencrust/stages.h>

#include "parallel/compressed_rows.h"

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
  graph.supernodes.assign(2, {std::vector<float>(nodes, 0.0f)});
  using Entry = std::pair<std::uint32_t, float>; // column and weight
  auto rows = build_rows<Entry>(threads, nodes, default_block, [&] {
    return [&](std::size_t i, std::vector<Entry>& row) {
      const auto begin = static_cast<std::ptrdiff_t>(row.size());
      const TetrahedronIndex tetrahedron = result.tetrahedron.raw()[i];
      for (std::size_t k = 0; k < 4; ++k) {
        const TetrahedronIndex n = t.neighbours[tetrahedron][k];
        if (!n.valid()) continue;
        const auto w = static_cast<float>(face_weight(t, t.tetrahedra[tetrahedron], k));
        if (node_of[n.value] == NodeIndex::none)
          graph.supernodes[labels[n] == Label::outside ? 0 : 1].weight[i] += w;
        else
          row.emplace_back(node_of[n.value], w);
      }
      std::sort(row.begin() + begin, row.end());
    };
  });
  split_rows(std::move(rows), graph.row_begin, graph.column, graph.weight, threads);
  // The one negative edge: as strong as all other edges of the supernodes together.
  double sum = 0;
  for (const SignedGraph::Supernode& super : graph.supernodes)
    for (const float w : super.weight) sum += static_cast<double>(w);
  graph.supernode_weight = {{0, -sum}, {-sum, 0}};
  return result;
}

} // namespace eigencrust
