// SPDX-License-Identifier: GPL-3.0-or-later
// §3: the Delaunay tetrahedralization, from parts that are made side by side.
#include <algorithm>
#include <optional>
#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <eigencrust/stages.h>

#include "parallel/threads.h"
#include "tetrahedra/assemble.h"
#include "tetrahedra/sample_blocks.h"
#include "tetrahedra/tile.h"

namespace eigencrust {
namespace {

// Of smaller tiles a large part lies at the border, where the others' samples have to be looked at.
constexpr std::uint32_t least_samples_of_a_tile = 20000;

/// One for each thread: more tiles have more borders.
std::vector<SampleRange> tiles_of(std::uint32_t samples, const Threads& threads) {
  const std::uint64_t count = std::clamp(samples / least_samples_of_a_tile, 1u, threads.size());
  const auto at = [&](std::uint64_t i) { return static_cast<std::uint32_t>(samples * i / count); };
  std::vector<SampleRange> tiles;
  for (std::uint64_t i = 0; i < count; ++i) tiles.push_back({at(i), at(i + 1)});
  return tiles;
}

/// \return none where they were given up
std::optional<std::vector<Tile>> try_tiles(const Tetrahedralization& t, const std::vector<SampleRange>& ranges,
                                           const Threads& threads, const WatchGrowth& watch) {
  const SampleBlocks blocks(samples_of(t), threads);
  std::vector<std::optional<Tile>> tiles(ranges.size());
  TileProgress progress(watch, t.sample_count);
  threads.run(ranges.size(), [&](std::size_t i) { tiles[i] = make_tile(corners_of(t), blocks, ranges[i], progress); });
  if (progress.given_up()) return {};
  std::vector<Tile> all;
  for (auto& tile : tiles) all.push_back(std::move(*tile));
  return all;
}

/// Each thread freed a triangulation. What it allocates from keeps that, and the others' stages cannot have it.
void give_back_freed_memory() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

} // namespace

std::vector<Tile> make_tiles(const Tetrahedralization& t, const Threads& threads, const WatchGrowth& watch) {
  auto tiles = try_tiles(t, tiles_of(t.sample_count, threads), threads, watch);
  if (!tiles) tiles = try_tiles(t, {{0, t.sample_count}}, threads, watch);
  return std::move(*tiles);
}

Tetrahedralization tetrahedralize(Samples samples, const Threads& threads) {
  return tetrahedralize(std::move(samples), threads, WatchGrowth{});
}

Tetrahedralization tetrahedralize(Samples samples, const Threads& threads, const WatchGrowth& watch) {
  Tetrahedralization result = enclose(std::move(samples));
  assemble(make_tiles(result, threads, watch), result, threads);
  give_back_freed_memory();
  return result;
}

} // namespace eigencrust
