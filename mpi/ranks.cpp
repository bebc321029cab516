// SPDX-License-Identifier: GPL-3.0-or-later
#include "ranks.h"

#include <eigencrust/memory_forecast.h>
#include <eigencrust/stages.h>

#include "parallel/threads.h"
#include "tetrahedra/assemble.h"

namespace eigencrust::mpi {
namespace {

enum class Work : std::uint32_t { end, tiles };

struct Task {
  Work work = Work::end;
  std::uint64_t max_memory = 0; ///< as in Ranks
};

/// Of a tile whose samples are of another rank's cloud.
WatchGrowth watch_memory(std::uint64_t limit) {
  return [limit](double, std::uint64_t tetrahedra) { check_memory_of_tetrahedra(tetrahedra, 0, limit); };
}

} // namespace

Tetrahedralization OtherRanks::tetrahedralize(Samples samples, const Threads& threads,
                                              const std::function<void(double, std::uint64_t)>& watch,
                                              std::uint64_t max_memory) {
  Tetrahedralization result = enclose(std::move(samples));
  std::vector<Tile> tiles = make_tiles(result, watch, max_memory, figures_);
  if (tiles.empty()) tiles = eigencrust::make_tiles(result, threads, watch);
  assemble(std::move(tiles), result, threads);
  return result;
}

std::vector<Tile> OtherRanks::make_tiles(const Tetrahedralization& enclosed, const WatchGrowth& watch,
                                         std::uint64_t max_memory, TileFigures& figures) const {
  messages_.from_root(Task{Work::tiles, max_memory});
  return mpi::make_tiles(messages_, &enclosed, watch, figures);
}

std::vector<std::pair<std::string, double>> OtherRanks::counts() const {
  return {{"ranks", messages_.size()},
          {"rounds", static_cast<double>(figures_.rounds)},
          {"samples_fetched", static_cast<double>(figures_.samples_fetched)},
          {"bytes_sent", static_cast<double>(figures_.bytes_sent)},
          {"memory_of_others", static_cast<double>(figures_.memory_of_others)}};
}

void OtherRanks::end() { messages_.from_root(Task{}); }

void serve(const Messages& messages) {
  for (Task task = messages.from_root(Task{}); task.work != Work::end; task = messages.from_root(Task{})) {
    try {
      TileFigures figures;
      make_tiles(messages, nullptr, watch_memory(task.max_memory), figures);
    } catch (const std::exception&) { // the root has heard of it
    }
  }
}

} // namespace eigencrust::mpi
