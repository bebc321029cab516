// SPDX-License-Identifier: GPL-3.0-or-later
// Pieces as small as the noise are taken for noise (not in the paper; docs/decisions/0027).
#include <algorithm>
#include <vector>

#include "repair/generators.h"
#include "repair/reach_of_noise.h"

namespace eigencrust {
namespace {

using Region = std::vector<TetrahedronIndex>;

/// Tetrahedra with a face of the surface, increasing.
Region at_surface(const Moves& moves) {
  const auto& neighbours = moves.scene.t.neighbours;
  const std::size_t n = neighbours.size(), blocks = (n + default_block - 1) / default_block;
  std::vector<Region> found(blocks);
  moves.scene.threads.run(blocks, [&](std::size_t b) {
    for (std::size_t i = b * default_block; i < std::min(n, (b + 1) * default_block); ++i) {
      const TetrahedronIndex here{static_cast<std::uint32_t>(i)};
      const auto& around = neighbours[here];
      if (std::any_of(around.begin(), around.end(),
                      [&](TetrahedronIndex o) { return o.valid() && moves.labels()[o] != moves.labels()[here]; }))
        found[b].push_back(here);
    }
  });
  Region all;
  for (const Region& some : found) all.insert(all.end(), some.begin(), some.end());
  return all;
}

/// Bodies and hollows that noise may have made.
std::vector<Region> small_regions(Moves& moves) {
  const std::uint64_t most = most_tetrahedra(worth_of_reach(widest_reach));
  std::vector<Region> regions;
  Region seen;
  for (const TetrahedronIndex i : at_surface(moves))
    if (const auto speck = moves.speck_at(i, most, seen); !speck.empty())
      regions.emplace_back(speck.begin(), speck.end());
  moves.forget(seen);
  return regions;
}

} // namespace

PieceCounts drop_pieces(Moves& moves) {
  PieceCounts counts;
  for (const Region& region : small_regions(moves)) {
    const auto samples = moves.samples_of(region);
    const double worth = worth_of_reach(reach_of_noise(moves.scene.model, samples));
    if (region.size() > most_tetrahedra(worth)) continue;
    const Moves::Outcome outcome = moves.weigh(region, worth, Moves::Gain::pieces);
    if (!(outcome.change < 0)) continue;
    moves.make(outcome);
    ++counts.dropped;
  }
  return counts;
}

} // namespace eigencrust
