// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A triangulation can be watched while it grows: most clouds have seven tetrahedra per sample, some have thousands.
#pragma once

#include <eigencrust/stages.h>

namespace eigencrust {

/// Called every few samples, from all threads, with the fraction done and the number of
/// tetrahedra so far. May throw to end the work.
using WatchGrowth = std::function<void(double, std::uint64_t)>;

/// As in stages.h.
Tetrahedralization tetrahedralize(Samples samples, const Threads& threads, const WatchGrowth& watch);

} // namespace eigencrust
