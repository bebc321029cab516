// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Smoothing pulls small pieces through themselves; what comes out is flat or inside out.
#pragma once

#include <vector>

#include <eigencrust/types.h>

#include "parallel/threads.h"
#include "surface/fans.h"

namespace eigencrust {

/// Pieces that could not be smoothed.
struct TurnedOver {
  std::uint64_t pieces = 0;
};

/// Closed pieces whose volume has changed its sign, or vanished beside rounding, and pieces with vertices that came to
/// lie on one another get their old places back.
/// \param before places of the vertices when the pieces were right
/// \param fans of `mesh`
TurnedOver take_back_turned(const std::vector<Vec3>& before, const SurfaceFans& fans, TriangleMesh& mesh,
                            const Threads& threads);

} // namespace eigencrust
