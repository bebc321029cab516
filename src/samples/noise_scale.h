// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// How noisy the samples are.
#pragma once

#include <eigencrust/stages.h>

namespace eigencrust {

/// Standard deviation of the noise at each sample, 0 where there is none to be told from curvature; smooth
/// in space, length unit of the input (not in the paper). Isolated samples (see Neighbourhoods; may be empty) set no
/// scale.
IndexedArray<SampleIndex, float> noise_scale(const Samples& samples, std::span<const float> isolated,
                                             const Threads& threads);

} // namespace eigencrust
