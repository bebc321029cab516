// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Signed graphs made smaller without a loss: nodes that one edge decides.
#pragma once

#include <cstdint>
#include <vector>

#include <eigencrust/types.h>

#include "parallel/threads.h"

namespace eigencrust {

/// A node whose edge to another weighs at least as much as all its other edges together sits beside that other in some
/// signing of least frustration: on its side where the edge attracts, opposite where it repels (the single-edge
/// criterion for maximum cuts; Lange, Andres, Swoboda 2019). Merging such pairs, again and again, loses nothing, and
/// what hangs on the rest of the graph by weak edges alone is gone: an eigenvector could live there and say nothing of
/// the rest (docs/decisions/0025).
struct ReducedGraph {
  SignedGraph graph;
  std::vector<std::uint32_t> node; ///< of each node of the whole graph, numbered by their first ones
  std::vector<std::int8_t> sign;   ///< 1: on the side of its node, -1: opposite
};
ReducedGraph merge_dominated_nodes(const SignedGraph& graph, const Threads& threads);

} // namespace eigencrust
