// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The filter of Robust Cocone (Dey, Goswami 2004): of a noisy sample only the outer boundary of the noise is kept.
#pragma once

#include "tetrahedra/scene.h"

namespace eigencrust {

/// 1 for each sample on a ball that is big beside the distances of its samples and hangs together with the outside
/// through balls that intersect deeply.
std::vector<std::uint8_t> outer_samples(const Scene& scene, const Threads& threads);

} // namespace eigencrust
