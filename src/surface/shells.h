// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A cavity is the hole of a body: without the body's shell its wall is a surface turned inside out.
#pragma once

#include <span>
#include <vector>

#include <eigencrust/stages.h>

namespace eigencrust {

/// Marks beside each wall of a cavity that is kept the shell of its body, and unmarks walls whose body has none: it was
/// trimmed away. Which piece is which is told by the tetrahedra alone, so no rounding can mislead.
/// \param piece of each triangle
/// \param kept  1 or 0 for each piece
void keep_shells(const Surface& surface, std::span<const std::uint32_t> piece,
                 const Tetrahedralization& tetrahedralization, const Labels& labels, std::vector<std::uint8_t>& kept);

/// The other way where shells were dropped because the samples do not bear them out: such a body is none, and what
/// looked like its cavity is a body. Turns the pieces that face inward when only those that are kept divide the space.
void turn_cavities_without_shell(Surface& surface, std::span<const std::uint32_t> piece,
                                 const Tetrahedralization& tetrahedralization, const Labels& labels,
                                 std::span<const std::uint8_t> kept);

} // namespace eigencrust
