// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What the lines of sight say of the scan, and of the result.
#pragma once

#include <eigencrust/stages.h>

namespace eigencrust {

/// What the lines say of the side they come from; none when they come from around, or there are none.
std::optional<OneSided> one_sided_scan(const Tetrahedralization& tetrahedralization, std::span<const SightLine> lines);

/// How many lines cross a tetrahedron that `labels` call inside.
std::uint64_t contradicting_lines(const SightCrossings& crossings, const Labels& labels, const Threads& threads);

} // namespace eigencrust
