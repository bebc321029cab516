// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// How many samples, and lengths in spacings, tell something of a place: the same in all chapters.
#pragma once

#include <cstddef>

namespace eigencrust {

/// So many surround a place. Close pairs, as merged scans have them, do not fool the farthest of them.
constexpr std::size_t neighbours_around = 12;
/// So many samples say where the middle of their noise is, so many places how noisy they are.
constexpr std::size_t enough_around = 40;
/// A sample is lonely where it stands so many times as far from others as the samples around it.
constexpr double isolation = 2.5;
/// In spacings: triangles with longer edges are not borne out by the samples.
constexpr double longest_edge = 5;

} // namespace eigencrust
