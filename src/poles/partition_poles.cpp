// SPDX-License-Identifier: GPL-3.0-or-later
// §3.2: the eigenvector on the poles.
#include <eigencrust/stages.h>

#include "numerics/dominant_edges.h"
#include "numerics/partition.h"

namespace eigencrust {

Partition partition_poles(const PoleGraph& graph, const SolverOptions& options, bool reduce, const Threads& threads,
                          std::vector<std::uint32_t>* component, const Checkpoint& checkpoint) {
  ReducedGraph reduced;
  if (reduce) reduced = merge_dominated_nodes(graph.graph, threads);
  Components components = connected_components(reduce ? reduced.graph : graph.graph);
  Partition partition =
      partition_components(reduce ? std::move(reduced.graph) : graph.graph, components, options, threads, checkpoint);
  partition.edges = edge_count(graph.graph);
  if (component) *component = std::move(components.of_node);
  if (!reduce) return partition;
  // Nodes that were merged have their node's value, and component.
  const std::vector<float> value = std::move(partition.value);
  partition.value.resize(reduced.node.size());
  for_each_index(threads, reduced.node.size(), [&](std::size_t i) {
    partition.value[i] = static_cast<float>(reduced.sign[i]) * value[reduced.node[i]];
  });
  partition.undecided = static_cast<std::uint32_t>(std::count(partition.value.begin(), partition.value.end(), 0.0f));
  if (!component) return partition;
  std::vector<std::uint32_t> of_node(reduced.node.size());
  for (std::size_t i = 0; i < of_node.size(); ++i) of_node[i] = (*component)[reduced.node[i]];
  *component = std::move(of_node);
  return partition;
}

} // namespace eigencrust
