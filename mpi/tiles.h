// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The Delaunay tetrahedra, a tile on each rank.
#pragma once

#include <vector>

#include "messages.h"
#include "tetrahedra/growth.h"
#include "tetrahedra/tile.h"

namespace eigencrust::mpi {

/// Called by all ranks. Each gets a range of blocks of samples and of the others' what it asks for.
/// \param enclosed samples and cube on the root, see enclose(); null elsewhere
/// \param watch of this rank's tile
/// \return on the root the tiles of all; none where they were given up, and elsewhere
/// \throws Error of the first rank that failed, on all ranks
std::vector<Tile> make_tiles(const Messages& messages, const Tetrahedralization* enclosed, const WatchGrowth& watch);

} // namespace eigencrust::mpi
