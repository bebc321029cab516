// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The Delaunay tetrahedra, a tile on each rank.
#pragma once

#include <vector>

#include "messages.h"
#include "tetrahedra/tile.h"

namespace eigencrust::mpi {

/// Of all ranks together.
struct TileFigures {
  std::uint64_t rounds = 0;           ///< in which samples were asked for
  std::uint64_t samples_fetched = 0;  ///< from other ranks
  std::uint64_t bytes_sent = 0;       ///< from rank to rank, the tiles included
  std::uint64_t memory_of_others = 0; ///< largest resident set of a rank that is not the root; 0: there is none
};

/// Called by all ranks. Each gets a range of blocks of samples and of the others' what it asks for.
/// \param enclosed samples and cube on the root, see enclose(); null elsewhere
/// \param watch of this rank's tile
/// \param figures of this call
/// \return on the root the tiles of all; none where they were given up, and elsewhere
/// \throws Error of the first rank that failed, on all ranks
std::vector<Tile> make_tiles(const Messages& messages, const Tetrahedralization* enclosed, const WatchGrowth& watch,
                             TileFigures& figures);

} // namespace eigencrust::mpi
