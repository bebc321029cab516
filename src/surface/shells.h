// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A cavity is the hole of a body: without the body's shell its wall is a surface turned inside out.
#pragma once

#include <span>
#include <vector>

#include <eigencrust/stages.h>

namespace eigencrust {

/// Marks beside each wall of a cavity that is kept the shell of its body, and unmarks walls whose body has none: it was
/// trimmed away. With `turn` a dropped shell stays dropped, for the samples do not bear it out: such a body is none,
/// what looked like its cavity is a body, and its wall is turned. Which piece is which is told by the tetrahedra alone,
/// so no rounding can mislead. Rooms are the other way round: a body in one that is kept keeps the room's walls, and
/// none is turned. \param piece of each triangle \param kept  1 or 0 for each piece
void settle_cavities(Surface& surface, std::span<const std::uint32_t> piece,
                     const Tetrahedralization& tetrahedralization, const Labels& labels, bool turn,
                     std::vector<std::uint8_t>& kept);

} // namespace eigencrust
