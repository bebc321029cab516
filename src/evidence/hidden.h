// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What a façade's samples hide (not in the paper; docs/decisions/0032).
#pragma once

#include <eigencrust/stages.h>

#include "tetrahedra/scene.h"

namespace eigencrust {

using HiddenCounts = IndexedArray<TetrahedronIndex, std::uint8_t>;

/// How many more samples have each tetrahedron behind them than in front of them, along the axis of a façade; 0: no
/// more; 255: or more. What samples hide, and none was seen through, nobody saw to be free.
/// \param front     unit, where the façade was seen from
/// \param depth     of each sample, as for lines of sight
/// \param named     labels that are known
HiddenCounts count_hidden(const Scene& scene, const Vec3& front, SampleLengthsView depth, const Labels& named,
                          const Threads& threads);

} // namespace eigencrust
