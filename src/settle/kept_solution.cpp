// SPDX-License-Identifier: GPL-3.0-or-later
#include "numerics/partition.h"
#include "numerics/spreading.h"
#include "settle/settle.h"

namespace eigencrust {

KeptSolution::KeptSolution(const TetrahedronGraph& graph, const Partition& partition, std::size_t tetrahedra)
    : value_(tetrahedra, 0), outside_(tetrahedra, 0), inside_(tetrahedra, 0) {
  for (std::uint32_t node = 0; node < graph.tetrahedron.size(); ++node) {
    const std::uint32_t i = graph.tetrahedron.raw()[node].value;
    value_[i] = partition.value[node];
    outside_[i] = graph.graph.supernodes[0].weight[node];
    inside_[i] = graph.graph.supernodes[1].weight[node];
  }
}

Partition KeptSolution::adapted_to(const TetrahedronGraph& graph) const {
  Partition partition;
  partition.edges = edge_count(graph.graph);
  partition.components = 1;
  partition.status = SolverStatus::signs_stable;
  partition.supernode_value = {1, -1};
  partition.value.resize(graph.tetrahedron.size());
  Spreading spreading(graph.graph, partition);
  for (std::uint32_t node = 0; node < graph.tetrahedron.size(); ++node) {
    const std::uint32_t i = graph.tetrahedron.raw()[node].value;
    partition.value[node] = value_[i];
    if (outside_[i] != graph.graph.supernodes[0].weight[node] || inside_[i] != graph.graph.supernodes[1].weight[node])
      spreading.wake(node);
  }
  spreading.run();
  for (const float v : partition.value) partition.undecided += v == 0;
  return partition;
}

} // namespace eigencrust
