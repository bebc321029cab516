// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What the sample model says, in the form that the repairs ask for.
#pragma once

#include "parallel/threads.h"
#include "samples/neighbourhoods.h"
#include "samples/sample_model.h"

namespace eigencrust {

/// As measures.cpp makes them.
inline Neighbourhoods sample_neighbourhoods(std::span<const Vec3> positions, const Threads& threads) {
  const SampleModel model = sample_model(positions, std::nullopt, threads);
  return {model.spacing, model.typical_spacing, model.typical_spacing, model.isolated};
}

} // namespace eigencrust
