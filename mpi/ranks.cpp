// SPDX-License-Identifier: GPL-3.0-or-later
#include "ranks.h"

#include <eigencrust/memory_forecast.h>
#include <eigencrust/stages.h>

#include "parallel/threads.h"
#include "tetrahedra/assemble.h"
#include "tiles.h"

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
  messages_.from_root(Task{Work::tiles, max_memory});
  std::vector<Tile> tiles = make_tiles(messages_, &result, watch);
  if (tiles.empty()) tiles = make_tiles(result, threads, watch);
  assemble(std::move(tiles), result, threads);
  return result;
}

void OtherRanks::end() { messages_.from_root(Task{}); }

void serve(const Messages& messages) {
  for (Task task = messages.from_root(Task{}); task.work != Work::end; task = messages.from_root(Task{})) {
    try {
      make_tiles(messages, nullptr, watch_memory(task.max_memory));
    } catch (const std::exception&) { // the root has heard of it
    }
  }
}

} // namespace eigencrust::mpi
