// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The sides of all tetrahedra, from those of the poles (§3.4).
#pragma once

#include "evidence/evidence.h"
#include "settle/minimum_energy.h"
#include "settle/overlaps.h"

namespace eigencrust {

/// Labels of all tetrahedra, and the energy that they are the minimum of (with the paper's second stages: that
/// repairs are measured by).
struct Settled {
  TetrahedronLabels labels;
  Energy energy;
  Overlaps overlaps = {}; ///< inside, though the poles were not
};

/// The stages energy, minimum_cut and overlaps; with the paper's second stages those of the second graph instead of the
/// latter two.
Settled settle(const Scene& scene, const Evidence& evidence, const PoleLabels& poles, const Context& context);

} // namespace eigencrust
