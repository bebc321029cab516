// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Connected components of signed graphs, and matrices of graphs.
#pragma once

#include <eigencrust/types.h>
#include <cstdint>
#include <vector>

#include "numerics/bordered_matrix.h"

namespace eigencrust {

struct Components {
  std::uint32_t count = 0; ///< component 0 is the supernodes' (it may hold no node)
  std::vector<std::uint32_t> of_node;
};
/// Supernodes all belong to component 0; the others are numbered by their first node.
Components connected_components(const SignedGraph& graph);

/// The (increasing) nodes of one component with the edges among them; supernodes only for component 0.
SignedGraph extract_component(const SignedGraph& graph, std::uint32_t component,
                              const std::vector<std::uint32_t>& nodes);

/// L of §3.2: L_ij = -w_ij, L_ii = Σ |L_ij|; supernodes form the border.
BorderedMatrix signed_laplacian(SignedGraph graph, const Threads& threads);

} // namespace eigencrust
