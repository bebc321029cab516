// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Which poles are inside, which outside (§3.1 to §3.3).
#pragma once

#include <vector>

#include <eigencrust/stages.h>

#include "evidence/evidence.h"

namespace eigencrust {

/// The pole graph and its eigenvector.
struct PoleSolution {
  std::vector<std::uint8_t> questionable; ///< tetrahedra, 1; may be empty
  PoleGraph graph;
  std::vector<std::uint32_t> component; ///< of each node
  Partition partition;
};

/// The stages questionable, pole_graph and partition_poles.
PoleSolution solve_poles(const Scene& scene, const Evidence& evidence, const Context& context);
/// The stage label_poles. \param partition that of `solved`, or one adapted to more evidence
PoleLabels label_poles(const Scene& scene, const Evidence& evidence, const PoleSolution& solved,
                       const Partition& partition, const Context& context);
/// Both; the graph is gone afterwards.
PoleLabels label_poles(const Scene& scene, const Evidence& evidence, const Context& context);

} // namespace eigencrust
