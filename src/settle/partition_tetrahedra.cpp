// SPDX-License-Identifier: GPL-3.0-or-later
// §3.4: the sides of the tetrahedra that the poles leave open.
#include <algorithm>

#include <eigencrust/stages.h>

#include "numerics/partition.h"
#include "parallel/threads.h"

namespace eigencrust {
namespace {

// So many times more signs may change in the second stage: its last steps move single tetrahedra (docs/decisions/0019).
constexpr double harmonic_slack = 2;

/// Both supernodes given, the rest solved for: the limit λ -> 0 of §3.4 with supernodes of equal size.
Partition partition_harmonic(SignedGraph graph, const SolverOptions& options, const Threads& threads,
                             const Checkpoint& checkpoint) {
  const std::uint32_t n = graph.node_count();
  Vector rhs(n);
  for (std::uint32_t i = 0; i < n; ++i)
    rhs[i] = static_cast<double>(graph.supernodes[0].weight[i]) - static_cast<double>(graph.supernodes[1].weight[i]);
  BorderedMatrix matrix = signed_laplacian(std::move(graph), threads);
  matrix.border.clear();
  matrix.corner.clear();
  const SignedMultigrid hierarchy(std::move(matrix), {}, threads);
  IterationControl control = control_of(options, checkpoint);
  control.stable_residual = 1e-4; // docs/decisions/0009
  control.stable_share = std::min(1.0, harmonic_slack * options.stable_share);
  const IterationResult result = conjugate_gradients(hierarchy, std::move(rhs), control, threads);
  Partition partition;
  take_figures(result, partition);
  partition.components = 1;
  partition.supernode_value = {1, -1};
  partition.value.assign(result.x.begin(), result.x.end());
  for (const float v : partition.value) partition.undecided += v == 0;
  return partition;
}

} // namespace

Partition partition_tetrahedra(SignedGraph graph, SecondStage method, const SolverOptions& options,
                               const Threads& threads, const Checkpoint& checkpoint) {
  if (graph.node_count() == 0) {
    Partition nothing;
    nothing.supernode_value = {1, -1};
    return nothing;
  }
  const std::uint64_t edges = edge_count(graph);
  const Components components = connected_components(graph);
  Partition partition = method == SecondStage::harmonic
                            ? partition_harmonic(std::move(graph), options, threads, checkpoint)
                            : partition_components(std::move(graph), components, options, threads, checkpoint);
  partition.edges = edges;
  return partition;
}

} // namespace eigencrust
