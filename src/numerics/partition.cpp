// SPDX-License-Identifier: GPL-3.0-or-later
#include "numerics/partition.h"

#include <algorithm>
#include <cmath>

#include "parallel/threads.h"

namespace eigencrust {
namespace {

IterationResult solve(BorderedMatrix matrix, const SolverOptions& options, const Threads& threads,
                      const Checkpoint& checkpoint) {
  Vector mass = full_diagonal(matrix);
  IterationControl control = control_of(options, checkpoint);
  // Lanczos on a problem smaller than its Krylov space, and the dense case, are the multigrid's coarsest level.
  if (options.eigensolver == Eigensolver::lanczos && matrix.size() > SignedMultigrid::coarsest_size) {
    control.max_steps = std::max(control.max_steps, 10000u);
    return smallest_eigenvector_lanczos(matrix, mass, control, threads);
  }
  SignedMultigrid hierarchy(std::move(matrix), std::move(mass), threads);
  return smallest_eigenvector(hierarchy, control, threads);
}

/// Largest absolute component 1, so that values of different components can be compared.
void scale_to_one(Vector& x) {
  double largest = 0;
  for (const double v : x) largest = std::max(largest, std::fabs(v));
  if (largest > 0)
    for (double& v : x) v /= largest;
}

} // namespace

std::uint64_t edge_count(const SignedGraph& graph) {
  std::uint64_t edges = graph.column.size() / 2;
  for (const SignedGraph::Supernode& super : graph.supernodes)
    for (const float w : super.weight) edges += w != 0;
  return edges;
}

IterationControl control_of(const SolverOptions& options, const Checkpoint& checkpoint) {
  IterationControl control;
  control.stop_on_stable_signs = options.stop_on_stable_signs;
  control.stable_share = options.stable_share;
  control.tolerance = options.tolerance;
  control.max_steps = options.max_steps;
  control.checkpoint = checkpoint;
  return control;
}

void take_figures(const IterationResult& result, Partition& partition) {
  partition.eigenvalue = result.eigenvalue;
  partition.residual = result.residual;
  partition.iterations = result.steps;
  partition.sign_changes = result.sign_changes;
  partition.status = result.status;
}

Partition partition_components(SignedGraph graph, const Components& components, const SolverOptions& options,
                               const Threads& threads, const Checkpoint& checkpoint) {
  Partition partition;
  const std::uint32_t n = graph.node_count();
  partition.value.assign(n, 0.0f);
  partition.supernode_value.assign(graph.supernodes.size(), 0.0);
  partition.components = components.count;
  partition.free_components = components.count - 1;
  const std::size_t supernodes = graph.supernodes.size();
  std::vector<std::vector<std::uint32_t>> members(components.count);
  for (std::uint32_t i = 0; i < n; ++i) members[components.of_node[i]].push_back(i);
  std::vector<SignedGraph> parts;
  for (std::uint32_t c = 0; c < components.count && components.count > 1; ++c)
    parts.push_back(extract_component(graph, c, members[c]));
  if (parts.empty()) parts.push_back(std::move(graph));
  graph = {};
  for (std::uint32_t c = 0; c < components.count; ++c) {
    if (c > 0 && members[c].size() == 1) { // no edge at all: any sign will do
      partition.value[members[c].front()] = 1;
      continue;
    }
    if (members[c].empty()) continue;
    IterationResult result = solve(signed_laplacian(std::move(parts[c]), threads), options, threads, checkpoint);
    if (c == 0 || (c == 1 && members[0].empty())) take_figures(result, partition);
    if (result.x.empty()) continue; // not converged at all: no labels, and the status says so
    scale_to_one(result.x);
    // What may still change has no sign: the second stage decides (docs/decisions/0019).
    for (std::size_t k = 0; k < result.unsettled.size(); ++k)
      if (result.unsettled[k]) result.x[k] = 0;
    for (std::size_t k = 0; k < members[c].size(); ++k)
      partition.value[members[c][k]] = static_cast<float>(result.x[k]);
    if (c == 0)
      for (std::size_t s = 0; s < supernodes; ++s) partition.supernode_value[s] = result.x[members[0].size() + s];
  }
  for (const float v : partition.value) partition.undecided += v == 0;
  return partition;
}

} // namespace eigencrust
