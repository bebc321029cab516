// SPDX-License-Identifier: GPL-3.0-or-later
// §3.2: labels from the signs of the first partition.
#include <algorithm>
#include <cmath>

#include <eigencrust/stages.h>

#include "parallel/threads.h"
#include "poles/global_sign.h"
#include "poles/pole_weights.h"

namespace eigencrust {
namespace {

/// How far a node's neighbours agree on its side, in [-1, 1]: Σ w x / Σ |w| |x|, times the node's sign.
/// It does not depend on how large the vector is hereabouts, so a localized vector does no harm.
double agreement(const SignedGraph& graph, const Partition& partition, std::uint32_t node) {
  double sum = 0, size = 0;
  const auto add = [&](double w, double x) {
    sum += w * x;
    size += std::fabs(w * x);
  };
  for (std::uint64_t e = graph.row_begin[node]; e < graph.row_begin[node + 1]; ++e)
    add(static_cast<double>(graph.weight[e]), static_cast<double>(partition.value[graph.column[e]]));
  for (std::size_t s = 0; s < graph.supernodes.size(); ++s)
    add(static_cast<double>(graph.supernodes[s].weight[node]), partition.supernode_value[s]);
  if (size == 0) return 1; // a node without edges contradicts nobody
  return (partition.value[node] > 0 ? sum : -sum) / size;
}

} // namespace

PoleLabels label_poles(const Tetrahedralization& t, const Poles& poles, const PoleGraph& graph,
                       const Partition& partition, std::span<const std::uint32_t> component, const Labels& known,
                       GlobalSign global_sign, const Threads& threads) {
  PoleLabels result;
  result.labels = known;
  // The supernode's own component may be 0 when the vector is localized elsewhere; positive then stands.
  const double own = partition.supernode_value.empty() || partition.supernode_value[0] >= 0 ? 1 : -1;
  double outside_sign = own;
  // An inside supernode settles the matter: both supernodes then have known labels.
  const bool both_known = graph.graph.supernodes.size() > 1;
  if (global_sign == GlobalSign::vote && !both_known) {
    result.vote = outside_evidence(t, poles, graph, partition, known, threads);
    if (result.vote != 0) outside_sign = result.vote > 0 ? 1 : -1;
    result.vote = std::fabs(result.vote);
  }
  result.reversed = outside_sign != own;
  std::vector<double> agreed(graph.graph.node_count(), 1);
  for_each_index(threads, agreed.size(), [&](std::size_t node) {
    agreed[node] = agreement(graph.graph, partition, static_cast<std::uint32_t>(node));
  });
  // A node that holds a pole named after the graph was made is what it is named, whatever its neighbours say.
  for (PoleIndex p{0}; p.value < graph.node.size(); ++p.value)
    if (graph.node[p].valid() && known[poles.tetrahedron[p]] != Label::unlabelled) agreed[graph.node[p].value] = 1;
  result.trust = IndexedArray<TetrahedronIndex, std::uint8_t>(t.tetrahedra.size(), full_trust);
  for (PoleIndex p{0}; p.value < graph.node.size(); ++p.value) {
    const std::uint32_t node = graph.node[p].value;
    if (!graph.node[p].valid()) continue;
    // Nothing tells the sign of a component without a supernode: the energy decides.
    if ((!component.empty() && component[node] != 0) || partition.value[node] == 0) {
      ++result.left_to_stage_two;
      continue;
    }
    result.trust[poles.tetrahedron[p]] =
        static_cast<std::uint8_t>(std::lround(full_trust * std::clamp(agreed[node], 0.0, 1.0)));
    result.contradicted += agreed[node] < 0;
    const TetrahedronIndex tetrahedron = poles.tetrahedron[p];
    if (known[tetrahedron] != Label::unlabelled) continue; // named after the graph was made, see Session
    const bool outside = static_cast<double>(partition.value[node]) * outside_sign > 0;
    result.labels[tetrahedron] = outside ? Label::outside : Label::inside;
  }
  return result;
}

} // namespace eigencrust
