// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// From signed graphs to one number per node whose sign is the side (§3.2, §3.4).
#pragma once

#include <eigencrust/stages.h>

#include "numerics/components.h"
#include "numerics/eigenvector.h"

namespace eigencrust {

/// Those to the supernodes included.
std::uint64_t edge_count(const SignedGraph& graph);

IterationControl control_of(const SolverOptions& options, const Checkpoint& checkpoint);
/// All but the values.
void take_figures(const IterationResult& result, Partition& partition);

/// Eigenvectors of all components; supernodes belong to component 0.
Partition partition_components(SignedGraph graph, const Components& components, const SolverOptions& options,
                               const Threads& threads, const Checkpoint& checkpoint);

} // namespace eigencrust
