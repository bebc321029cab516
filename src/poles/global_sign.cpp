// SPDX-License-Identifier: GPL-3.0-or-later
#include "poles/global_sign.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "parallel/threads.h"
#include "poles/pole_weights.h"
#include "tetrahedra/star_search.h"

namespace eigencrust {
namespace {

constexpr std::size_t neighbourhood = 8;

/// Of isolated samples: least for cells no longer than 1.2 neighbourhoods, 1 from 3.2 (docs/decisions/0003). Never 0:
/// on a handful of points no cell is long, yet they outweigh the weak attraction across their surface.
double trust(double shorter_pole, double neighbourhood_radius) {
  return std::clamp((shorter_pole / neighbourhood_radius - 1.2) / 2, 0.05, 1.0);
}

struct Evidence {
  double balance = 0, total = 0;
  Evidence operator+(const Evidence& other) const { return {balance + other.balance, total + other.total}; }
};

} // namespace

double outside_evidence(const Tetrahedralization& t, const VertexStars& stars, const Poles& poles,
                        const PoleGraph& graph, const Partition& partition, const Labels& known,
                        std::span<const float> isolated, const Threads& threads) {
  std::vector<std::array<float, 2>> repulsive(t.sample_count, {0, 0}); // weight counted, weight claimed; per sample
  std::vector<std::uint32_t> target(t.sample_count, NodeIndex::none);
  for_blocks(
      threads, t.sample_count, block_with_table(t.sample_count), [&](std::size_t begin, std::size_t end, std::size_t) {
        StarSearch search(t, stars);
        for (std::size_t i = begin; i < end; ++i) {
          PolePair pair = poles.of_sample.raw()[i];
          if (!pair.first.valid() || !pair.second.valid()) continue;
          if (known[poles.tetrahedron[pair.second]] == Label::outside) std::swap(pair.first, pair.second);
          if (known[poles.tetrahedron[pair.first]] != Label::outside) continue;
          target[i] = graph.node[pair.second].value;
          if (target[i] == NodeIndex::none) continue;
          const SampleIndex s{static_cast<std::uint32_t>(i)};
          const Sphere &a = poles.sphere[pair.first], &b = poles.sphere[pair.second];
          const bool is_isolated = isolated.empty() || isolated[i] > 0;
          const double believed =
              is_isolated ? trust(std::min(a.radius, b.radius), search.distance_to_nearest(s, neighbourhood)) : 1;
          const double weight = -opposite_weight(t.positions[s], a, b);
          repulsive[i] = {static_cast<float>(believed * weight), static_cast<float>(weight)};
        }
      });

  std::vector<double> claimed(graph.graph.node_count(), 0);
  Evidence sum;
  for (std::uint32_t i = 0; i < t.sample_count; ++i) {
    if (target[i] == NodeIndex::none) continue;
    claimed[target[i]] += static_cast<double>(repulsive[i][1]);
    const double weight = static_cast<double>(repulsive[i][0]);
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
