// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A solution adapted to a graph that changed here and there.
#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include <eigencrust/types.h>

namespace eigencrust {

/// Nodes take the mean of their neighbours, signed and weighted, as the eigenvector does (x = Σ w y / Σ |w| / (1 - λ))
/// and the harmonic solution (λ = 0): around those that are held, from those that are woken on, and as far as that
/// changes anything.
class Spreading {
 public:
  Spreading(const SignedGraph& graph, Partition& partition)
      : graph_(graph), partition_(partition), waiting_(graph.node_count(), 0), held_(graph.node_count(), 0) {}

  void hold(std::uint32_t node, float value);
  void wake(std::uint32_t node);
  void run();

 private:
  void wake_neighbours(std::uint32_t node);
  [[nodiscard]] double mean_at(std::uint32_t node) const;

  const SignedGraph& graph_;
  Partition& partition_;
  std::deque<std::uint32_t> queue_;
  std::vector<std::uint8_t> waiting_, held_;
};

} // namespace eigencrust
