// SPDX-License-Identifier: GPL-3.0-or-later
#include "numerics/partition.h"

#include <algorithm>
#include <cmath>

#include "parallel/threads.h"

namespace eigencrust {
namespace {

/// \param matrix comes back with the entries within its rows in any order
IterationResult solve(BorderedMatrix& matrix, const SolverOptions& options, const Threads& threads,
                      const Checkpoint& checkpoint) {
  Vector mass = full_diagonal(matrix);
  IterationControl control = control_of(options, checkpoint);
  // Lanczos on a problem smaller than its Krylov space, and the dense case, are the multigrid's coarsest level.
  if (options.eigensolver == Eigensolver::lanczos && matrix.size() > SignedMultigrid::coarsest_size) {
    control.max_steps = std::max(control.max_steps, 10000u);
    return smallest_eigenvector_lanczos(matrix, mass, control, threads);
  }
  SignedMultigrid hierarchy(std::move(matrix), std::move(mass), threads);
  IterationResult result = smallest_eigenvector(hierarchy, control, threads);
  matrix = std::move(hierarchy).take_finest();
  return result;
}

/// Largest absolute component 1, so that values of different components can be compared.
void scale_to_one(Vector& x) {
  double largest = 0;
  for (const double v : x) largest = std::max(largest, std::fabs(v));
  if (largest > 0)
    for (double& v : x) v /= largest;
}

struct Entry {
  std::uint32_t column;
  float value;
};

/// Makes all nodes of other components nodes without edges and without mass.
/// \return their entries, in order
std::vector<Entry> mask(BorderedMatrix& matrix, const std::vector<std::uint32_t>& of_node, std::uint32_t component) {
  std::vector<Entry> masked;
  for (std::size_t i = 0; i < of_node.size(); ++i) {
    if (of_node[i] == component) continue;
    matrix.diagonal[i] = 0;
    for (std::uint64_t e = matrix.row_begin[i]; e < matrix.row_begin[i + 1]; ++e) {
      masked.push_back({matrix.column[e], matrix.value[e]});
      matrix.value[e] = 0;
    }
  }
  return masked;
}

/// The entries that mask() took; not the mass.
void unmask(const std::vector<Entry>& masked, const std::vector<std::uint32_t>& of_node, std::uint32_t component,
            BorderedMatrix& matrix) {
  auto entry = masked.begin();
  for (std::size_t i = 0; i < of_node.size(); ++i) {
    if (of_node[i] == component) continue;
    for (std::uint64_t e = matrix.row_begin[i]; e < matrix.row_begin[i + 1]; ++e, ++entry) {
      matrix.column[e] = entry->column;
      matrix.value[e] = entry->value;
    }
  }
}

/// Leaves the values of some of the n interior nodes, and the border's.
void pick(const std::vector<std::uint32_t>& nodes, std::uint32_t n, IterationResult& result) {
  if (result.x.empty()) return;
  for (std::size_t k = 0; k < nodes.size(); ++k) result.x[k] = result.x[nodes[k]];
  result.x.erase(result.x.begin() + static_cast<std::ptrdiff_t>(nodes.size()), result.x.begin() + n);
  if (result.unsettled.empty()) return;
  for (std::size_t k = 0; k < nodes.size(); ++k) result.unsettled[k] = result.unsettled[nodes[k]];
  result.unsettled.resize(nodes.size());
}

/// Of the component that most nodes belong to. It is not worth a copy: the graph lends its edges, the few other nodes
/// are masked out.
IterationResult solve_in_place(SignedGraph& graph, const Components& components,
                               const std::vector<std::uint32_t>& nodes, const SolverOptions& options,
                               const Threads& threads, const Checkpoint& checkpoint) {
  constexpr std::uint32_t main = 0;
  BorderedMatrix matrix = borrow_edges(graph, threads);
  const std::vector<Entry> masked = mask(matrix, components.of_node, main);
  IterationResult result = solve(matrix, options, threads, checkpoint);
  unmask(masked, components.of_node, main, matrix);
  const auto n = static_cast<std::uint32_t>(components.of_node.size());
  give_back_edges(std::move(matrix), graph, threads);
  if (components.count > 1) pick(nodes, n, result);
  return result;
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

Partition partition_components(SignedGraph& graph, const Components& components, const SolverOptions& options,
                               const Threads& threads, const Checkpoint& checkpoint) {
  Partition partition;
  const std::uint32_t n = graph.node_count();
  partition.value.assign(n, 0.0f);
  partition.supernode_value.assign(graph.supernodes.size(), 0.0);
  partition.components = components.count;
  partition.free_components = components.count - 1;
  std::vector<std::vector<std::uint32_t>> members(components.count);
  for (std::uint32_t i = 0; i < n; ++i) members[components.of_node[i]].push_back(i);
  const auto solve_component = [&](std::uint32_t c) {
    const auto& nodes = members[c];
    if (c == 0 && nodes.size() > n / 2) return solve_in_place(graph, components, nodes, options, threads, checkpoint);
    Subgraph part = extract_component(graph, c, nodes);
    BorderedMatrix matrix = signed_laplacian(std::move(part.graph), threads);
    return solve(matrix, options, threads, checkpoint);
  };
  for (std::uint32_t c = 0; c < components.count; ++c) {
    if (c > 0 && members[c].size() == 1) { // no edge at all: any sign will do
      partition.value[members[c].front()] = 1;
      continue;
    }
    if (members[c].empty()) continue;
    IterationResult result = solve_component(c);
    if (c == 0 || (c == 1 && members[0].empty())) take_figures(result, partition);
    if (result.x.empty()) continue; // not converged at all: no labels, and the status says so
    scale_to_one(result.x);
    // What may still change has no sign: the second stage decides (docs/decisions/0019).
    for (std::size_t k = 0; k < result.unsettled.size(); ++k)
      if (result.unsettled[k]) result.x[k] = 0;
    for (std::size_t k = 0; k < members[c].size(); ++k)
      partition.value[members[c][k]] = static_cast<float>(result.x[k]);
    if (c == 0)
      for (std::size_t s = 0; s < graph.supernodes.size(); ++s)
        partition.supernode_value[s] = result.x[members[0].size() + s];
  }
  for (const float v : partition.value) partition.undecided += v == 0;
  return partition;
}

} // namespace eigencrust
