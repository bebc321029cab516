// SPDX-License-Identifier: GPL-3.0-or-later
// §3.2: labels from the signs of the first partition.
#include <cmath>
#include <cstdlib>
#include <cstdio>

#include <eigencrust/stages.h>

#include "evidence/global_sign.h"
#include "parallel/threads.h"

namespace eigencrust {
namespace {

/// Components without a supernode: their labelled face neighbours vote; two thirds decide.
std::uint64_t label_free_components(const Tetrahedralization& t, const Poles& poles, const PoleGraph& graph,
                                    const Partition& partition, std::span<const std::uint32_t> component,
                                    Labels& labels) {
  std::uint32_t count = 0;
  for (const std::uint32_t c : component) count = std::max(count, c + 1);
  if (count <= 1) return 0;
  // balance > 0: positive values of the component are outside.
  std::vector<double> balance(count, 0), total(count, 0);
  const auto tetrahedron_of = [&](std::uint32_t node) { return poles.tetrahedron[graph.pole.raw()[node]]; };
  for (std::uint32_t node = 0; node < graph.pole.size(); ++node) {
    if (component[node] == 0 || partition.value[node] == 0) continue;
    for (const TetrahedronIndex n : t.neighbours[tetrahedron_of(node)]) {
      if (!n.valid() || labels[n] == Label::unlabelled) continue;
      const bool agrees = (labels[n] == Label::outside) == (partition.value[node] > 0);
      balance[component[node]] += agrees ? 1 : -1;
      total[component[node]] += 1;
    }
  }
  std::uint64_t open = 0;
  std::vector<std::pair<TetrahedronIndex, Label>> decided;
  for (std::uint32_t node = 0; node < graph.pole.size(); ++node) {
    const std::uint32_t c = component[node];
    if (c == 0) continue;
    if (partition.value[node] == 0 || std::fabs(balance[c]) * 3 < total[c] || total[c] == 0) {
      ++open;
      continue;
    }
    const bool outside = (partition.value[node] > 0) == (balance[c] > 0);
    decided.emplace_back(tetrahedron_of(node), outside ? Label::outside : Label::inside);
  }
  for (const auto& [tetrahedron, label] : decided) labels[tetrahedron] = label;
  return open;
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
  const char* th = getenv("EC_TH"); const double theta = th ? atof(th) : 0; std::size_t skipped = 0;
  for (std::uint32_t node = 0; node < graph.pole.size(); ++node) {
    { double sum = 0, size = 0; for (auto e = graph.graph.row_begin[node]; e < graph.graph.row_begin[node + 1]; ++e) { double v = double(graph.graph.weight[e]) * double(partition.value[graph.graph.column[e]]); sum += v; size += std::fabs(v);} double v = double(graph.graph.supernodes[0].weight[node]) * partition.supernode_value[0]; sum += v; size += std::fabs(v); if (sum * (partition.value[node] > 0 ? 1 : -1) < theta * size) { ++skipped; continue; } }
    if ((!component.empty() && component[node] != 0) || partition.value[node] == 0) continue;
    const TetrahedronIndex tetrahedron = poles.tetrahedron[graph.pole.raw()[node]];
    result.labels[tetrahedron] =
        (static_cast<double>(partition.value[node]) * outside_sign > 0) ? Label::outside : Label::inside;
  }
  if (th) fprintf(stderr, "skipped %zu\n", skipped);
  result.left_to_stage_two = label_free_components(t, poles, graph, partition, component, result.labels);
  return result;
}

} // namespace eigencrust
