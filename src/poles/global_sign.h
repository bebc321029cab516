// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Which sign of the eigenvector is outside.
#pragma once

#include <eigencrust/stages.h>

namespace eigencrust {

/// Evidence that positive components are outside, in [-1, 1]: 1 unanimous, -1 unanimous against.
///
/// Two kinds of edges at the outside supernode speak. Attractive ones say that a pole is outside. The
/// repulsive ones, from a sample whose other pole is known to be outside, say that a pole is inside.
double outside_evidence(const Tetrahedralization& tetrahedralization, const Poles& poles, const PoleGraph& graph,
                        const Partition& partition, const Labels& known, const Threads& threads);

} // namespace eigencrust
