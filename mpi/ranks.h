// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What one rank tells the others to do.
#pragma once

#include <eigencrust/ranks.h>

#include "messages.h"
#include "tiles.h"

namespace eigencrust::mpi {

/// The others, seen from the root, which runs the command.
class OtherRanks : public Ranks {
 public:
  explicit OtherRanks(const Messages& messages) : messages_(messages) {}
  Tetrahedralization tetrahedralize(Samples samples, const Threads& threads,
                                    const std::function<void(double, std::uint64_t)>& watch,
                                    std::uint64_t max_memory) override;
  [[nodiscard]] std::vector<std::pair<std::string, double>> counts() const override;
  /// The tiles of all ranks; none where they were given up. Parameters as above. \param enclosed see enclose()
  std::vector<Tile> make_tiles(const Tetrahedralization& enclosed, const WatchGrowth& watch, std::uint64_t max_memory,
                               TileFigures& figures) const;
  /// They go home.
  void end();

 private:
  const Messages& messages_;
  TileFigures figures_;
};

/// What all ranks but the root do: their part of what the root asks for, until it ends.
void serve(const Messages& messages);

} // namespace eigencrust::mpi
