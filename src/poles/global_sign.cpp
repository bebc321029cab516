// SPDX-License-Identifier: GPL-3.0-or-later
#include "poles/global_sign.h"

#include <algorithm>

#include "parallel/threads.h"
#include "poles/pole_weights.h"

namespace eigencrust {
namespace {

struct Votes {
  double balance = 0, total = 0;
  Votes operator+(const Votes& other) const { return {balance + other.balance, total + other.total}; }
};

} // namespace

double outside_evidence(const Tetrahedralization& t, const Poles& poles, const PoleGraph& graph,
                        const Partition& partition, const Labels& known, const Threads& threads) {
  std::vector<float> repulsive(t.sample_count, 0);
  std::vector<std::uint32_t> target(t.sample_count, NodeIndex::none);
  for_each_index(threads, t.sample_count, [&](std::size_t i) {
    PolePair pair = poles.of_sample.raw()[i];
    if (!pair.first.valid() || !pair.second.valid()) return;
    if (known[poles.tetrahedron[pair.second]] == Label::outside) std::swap(pair.first, pair.second);
    if (known[poles.tetrahedron[pair.first]] != Label::outside) return;
    target[i] = graph.node[pair.second].value;
    if (target[i] != NodeIndex::none)
      repulsive[i] = static_cast<float>(
          -opposite_weight(t.positions.raw()[i], poles.sphere[pair.first], poles.sphere[pair.second]));
  });
  std::vector<double> claimed(graph.graph.node_count(), 0);
  Votes sum;
  for (std::uint32_t i = 0; i < t.sample_count; ++i) {
    if (target[i] == NodeIndex::none) continue;
    const double weight = static_cast<double>(repulsive[i]);
    claimed[target[i]] += weight;
    const float value = partition.value[target[i]];
    sum.balance -= value > 0 ? weight : value < 0 ? -weight : 0;
    sum.total += weight;
  }
  for (std::uint32_t node = 0; node < graph.graph.node_count(); ++node) {
    // What is left of the supernode's edge when the repulsive part is taken out is attraction.
    const double weight = std::max(0.0, static_cast<double>(graph.graph.supernodes[0].weight[node]) + claimed[node]);
    const float value = partition.value[node];
    sum.balance += value > 0 ? weight : value < 0 ? -weight : 0;
    sum.total += weight;
  }
  return sum.total > 0 ? sum.balance / sum.total : 0;
}

} // namespace eigencrust
