// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What a façade's samples hide (not in the paper; docs/decisions/0032).
#pragma once

#include <eigencrust/stages.h>

#include "tetrahedra/scene.h"

namespace eigencrust {

/// Of each tetrahedron. Above 0: how many more samples have it behind them than in front of them, along the axis of a
/// façade; what samples hide, and none was seen through, nobody saw to be free. Below 0: through so many lines from
/// samples to where the façade was seen from, which meet no sheet, more than samples hide it. From -255 to 255.
using HiddenCounts = IndexedArray<TetrahedronIndex, std::int16_t>;

/// \param front  unit, where the façade was seen from
/// \param depth  of each sample, as for lines of sight
/// \param named  labels that are known
HiddenCounts count_hidden(const Scene& scene, const Vec3& front, SampleLengthsView depth, const Labels& named,
                          const Threads& threads);

/// Labels for what they say clearly: inside where two samples more hide it, outside where a line goes through.
void label_hidden(const HiddenCounts& hidden, Labels& labels);

} // namespace eigencrust
