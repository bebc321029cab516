// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Tight Cocone (Dey, Goswami 2003): what lies outside the cocone is peeled off, and where the samples are too few for
/// a cocone, the surface is the smallest faces.
#pragma once

#include "tetrahedra/scene.h"

namespace eigencrust {

/// Every tetrahedron inside or outside; those at the cube are outside. The surface is closed, not always a manifold.
Labels tight_cocone(const Scene& scene, const Threads& threads);

} // namespace eigencrust
