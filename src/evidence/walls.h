// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Walls at the rim of what was scanned from one side (not in the paper; docs/decisions/0032).
#pragma once

#include <vector>

#include <eigencrust/stages.h>

#include "evidence/hidden.h"
#include "tetrahedra/scene.h"

namespace eigencrust {

/// Tetrahedra at the cube beyond walls that stand at the rim of a façade and look into it, as those of a street: such a
/// wall is seen from within, and what lies behind it is solid.
/// \param front   unit, where the façade was seen from
/// \param hidden  see count_hidden: what is free and what is not, along the axis
/// \param named   labels of the tetrahedra at the cube, as known_labels gives them
std::vector<TetrahedronIndex> beyond_walls(const Scene& scene, const Vec3& front, const HiddenCounts& hidden,
                                           const Labels& named);

} // namespace eigencrust
