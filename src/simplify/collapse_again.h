// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A simplified mesh is taken apart in some places, and only these are simplified once more.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "parallel/threads.h"
#include "simplify/collapse.h"

namespace eigencrust {

/// As collapse_edges(before, ..., limits, goal), but from `after` on: its vertices stay what they have become but for
/// those in `apart` (1), which are as before.
/// \param after made from `before` \param limits of the vertices before, see collapse_edges()
/// \return `into` is of the vertices before; none where the mesh of both is no manifold of the same kind
std::optional<Collapsed> collapse_again(const Collapsed& before, const Collapsed& after, std::span<const float> limits,
                                        std::span<const std::uint8_t> apart, const CollapseGoal& goal,
                                        const Threads& threads);

} // namespace eigencrust
