// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Chambers that parts enclose where they overlap.
#pragma once

#include <cstdint>
#include <vector>

#include "evidence/evidence.h"

namespace eigencrust {

/// What overlapping parts have in common. The samples around it say that it is neither what one part is nor what the
/// other is, so it is found to be outside.
struct Overlaps {
  std::uint32_t chambers = 0;
  std::vector<TetrahedronIndex> tetrahedra; ///< of all of them, in order
};

/// The chambers are told by where they touch the rest of the outside: along a curve at which four sectors meet, two
/// outside and two inside, which no solid has; and nowhere else. None where something is known beforehand to be
/// outside (not in the paper; docs/decisions/0045).
/// \param labels of the least energy
Overlaps find_overlaps(const Scene& scene, const Evidence& evidence, const Labels& labels, const Threads& threads);

} // namespace eigencrust
