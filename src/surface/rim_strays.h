// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Teeth: where a surface ends among strays, its rim runs out to them.
#pragma once

#include <cstdint>
#include <vector>

#include <eigencrust/stages.h>

#include "samples/sample_model.h"

namespace eigencrust {

/// The triangles (1) at vertices that stand apart from most of what lies around them, as isolated samples do from
/// others and lonely ones from closer ones (not in the paper; docs/decisions/0032). Only at the rim are these surely
/// strays, see marked_at_rim().
std::vector<std::uint8_t> triangles_at_strays(const SampleModel& model, const Surface& surface);

} // namespace eigencrust
