// SPDX-License-Identifier: GPL-3.0-or-later
// §3.2: the eigenvector on the poles.
#include <eigencrust/stages.h>

#include "numerics/partition.h"

namespace eigencrust {

Partition partition_poles(PoleGraph& graph, const SolverOptions& options, const Threads& threads,
                          std::vector<std::uint32_t>* component, const Checkpoint& checkpoint) {
  Components components = connected_components(graph.graph);
  Partition partition = partition_components(graph.graph, components, options, threads, checkpoint);
  partition.edges = edge_count(graph.graph);
  if (component) *component = std::move(components.of_node);
  return partition;
}

} // namespace eigencrust
