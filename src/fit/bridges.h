// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Surface over places without samples, freed of the strays that it hangs on (not in the paper; docs/decisions/0044).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <eigencrust/stages.h>

#include "parallel/threads.h"
#include "samples/sample_model.h"
#include "surface/fans.h"

namespace eigencrust {

/// Vertices that are strays: where samples are missing the surface has to go through something. They are isolated
/// samples in no triangle that samples bear out (Surface::unsupported); or, where of the isolated samples most are
/// passed by, in patches of vertices that stand as far from others as those, and that are rougher than a coarse part
/// would be. None at a rim, and none of pieces of nothing else. Increasing. \param fans of the surface
std::vector<std::uint32_t> strays_on_bridges(const Surface& surface, const SurfaceFans& fans, const SampleModel& model,
                                             const Threads& threads);

/// Moves all of them to the mean of their neighbours at once, so that the bridge is a membrane between samples that are
/// not isolated. \param strays increasing; each joined by others to a vertex that is none
void flatten_bridges(std::span<const std::uint32_t> strays, const SurfaceFans& fans, std::vector<Vec3>& vertices);

} // namespace eigencrust
