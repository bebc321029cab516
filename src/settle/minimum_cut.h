// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Exact minimum s-t cuts of graphs whose nodes have at most four neighbours, as tetrahedra that share faces have.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include <eigencrust/types.h>

#include "parallel/threads.h"

namespace eigencrust {

/// An s-t cut problem on nodes with at most four neighbours each. Capacities are whole numbers so that the cut is
/// exact. An edge stands with both its nodes; two nodes may share several edges; an edge from a node to itself does
/// not matter.
struct CutProblem {
  std::vector<std::array<std::uint32_t, 4>> neighbour; ///< of each node; CutProblem::none where there is none
  std::vector<std::array<std::uint16_t, 4>> capacity;  ///< of the edge to each neighbour; the same from both sides
  std::vector<std::int32_t> terminal; ///< > 0: capacity from the source (outside); < 0: to the sink (inside); net
  static constexpr std::uint16_t largest_capacity = std::numeric_limits<std::int16_t>::max();
  static constexpr std::uint32_t none = no_index;
};

enum class CutSide : std::uint8_t { source, sink, either };

/// The sides of a minimum cut. Nodes that every minimum cut puts on the source's side are `source`, on the sink's side
/// `sink`, those that minimum cuts disagree on are `either`. This is unique: it does not depend on the order of
/// augmentations nor on threads. Both `source` alone and `source` with `either` are the source's side of a minimum cut.
struct CutResult {
  std::vector<CutSide> side;
  std::int64_t flow = 0; ///< the value of the minimum cuts
};

/// Near linear in time where most nodes have a terminal of the right sign, and on all threads where neighbours have
/// numbers near each other. Needs 40 bytes per node beside the problem and the result. Where neighbour, capacity and
/// terminal disagree in length, a capacity is too large or an edge is not the same from both its nodes: \throws
/// std::invalid_argument
CutResult minimum_cut(const CutProblem& problem, const Threads& threads);

} // namespace eigencrust
