// SPDX-License-Identifier: GPL-3.0-or-later
// Tips: isolated samples and small groups far from all others that only long triangles join to the surface
// (not in the paper; docs/decisions/0027).
#include <algorithm>
#include <set>

#include "repair/generators.h"

namespace eigencrust {
namespace {

// A group is lonely that has so few samples ...
constexpr std::size_t most_in_group = 64;
// ... and is so many spacings from all others.
constexpr double gap_in_spacings = 20;

/// Samples that stand together, increasing.
using Group = std::vector<SampleIndex>;

double gap_at(const MoveScene& scene, SampleIndex s) {
  return gap_in_spacings * std::max(scene.model.typical_spacing, static_cast<double>(scene.model.spacing[s.value]));
}

/// Corners of surface triangles with an edge that is longer than the gap at both of its ends.
std::vector<SampleIndex> at_long_triangles(const Moves& moves) {
  const MoveScene& scene = moves.scene;
  std::vector<std::vector<SampleIndex>> found((scene.t.tetrahedra.size() + default_block - 1) / default_block);
  for_blocks(scene.threads, scene.t.tetrahedra.size(), default_block,
             [&](std::size_t begin, std::size_t end, std::size_t block) {
               for (TetrahedronIndex i{static_cast<std::uint32_t>(begin)}; i.value < end; ++i.value) {
                 if (moves.labels()[i] != Label::inside) continue;
                 const auto& v = scene.t.tetrahedra[i];
                 const auto is_long = [&](SampleIndex a, SampleIndex b) {
                   return !scene.t.is_corner(a) && !scene.t.is_corner(b) &&
                          distance(scene.t.positions[a], scene.t.positions[b]) >
                              std::min(gap_at(scene, a), gap_at(scene, b));
                 };
                 for (std::size_t k = 0; k < 4; ++k) {
                   const TetrahedronIndex n = scene.t.neighbours[i][k];
                   if (!n.valid() || moves.labels()[n] == Label::inside) continue;
                   const std::array<SampleIndex, 3> face{v[(k + 1) % 4], v[(k + 2) % 4], v[(k + 3) % 4]};
                   if (is_long(face[0], face[1]) || is_long(face[1], face[2]) || is_long(face[2], face[0]))
                     found[block].insert(found[block].end(), face.begin(), face.end());
                 }
               }
             });
  std::vector<SampleIndex> samples;
  for (const auto& part : found) samples.insert(samples.end(), part.begin(), part.end());
  std::sort(samples.begin(), samples.end());
  samples.erase(std::unique(samples.begin(), samples.end()), samples.end());
  std::erase_if(samples, [&](SampleIndex s) { return scene.t.is_corner(s); });
  return samples;
}

/// The samples that short edges join with one; empty if they are too many to be lonely.
Group group_of(const MoveScene& scene, SampleIndex first) {
  Group group{first};
  for (std::size_t k = 0; k < group.size(); ++k)
    for (const TetrahedronIndex i : scene.stars[group[k]])
      for (const SampleIndex s : scene.t.tetrahedra[i]) {
        if (scene.t.is_corner(s) || distance(scene.t.positions[s], scene.t.positions[group[k]]) > gap_at(scene, first))
          continue;
        if (std::find(group.begin(), group.end(), s) != group.end()) continue;
        if (group.size() == most_in_group) return {};
        group.push_back(s);
      }
  std::sort(group.begin(), group.end());
  return group;
}

/// Isolated samples, each for itself, and lonely groups; only those that long triangles lead to.
std::vector<Group> possible_tips(const Moves& moves) {
  std::set<Group> tips;
  for (SampleIndex s{0}; s.value < moves.scene.t.sample_count; ++s.value)
    if (moves.scene.model.isolated[s.value] > 0) tips.insert({s});
  for (const SampleIndex s : at_long_triangles(moves))
    if (Group group = group_of(moves.scene, s); group.size() > 1) tips.insert(std::move(group));
  return {tips.begin(), tips.end()};
}

/// The tetrahedra of one side around the samples.
std::vector<TetrahedronIndex> side_of_stars(const Moves& moves, const Group& group, Label side) {
  std::vector<TetrahedronIndex> tetrahedra;
  for (const SampleIndex s : group)
    for (const TetrahedronIndex i : moves.scene.stars[s])
      if (moves.labels()[i] == side) tetrahedra.push_back(i);
  std::sort(tetrahedra.begin(), tetrahedra.end());
  tetrahedra.erase(std::unique(tetrahedra.begin(), tetrahedra.end()), tetrahedra.end());
  return tetrahedra;
}

/// Is the group on the surface, and does no triangle join it to others that is not long?
bool is_tip(const Moves& moves, const Group& group) {
  const MoveScene& scene = moves.scene;
  const auto holds = [&](SampleIndex s) { return std::binary_search(group.begin(), group.end(), s); };
  for (const SampleIndex s : group)
    for (const TetrahedronIndex i : scene.stars[s]) {
      if (moves.labels()[i] != Label::inside) continue;
      const auto& v = scene.t.tetrahedra[i];
      for (std::size_t k = 0; k < 4; ++k) {
        const TetrahedronIndex n = scene.t.neighbours[i][k];
        if (v[k] == s || !n.valid() || moves.labels()[n] == Label::inside) continue;
        double longest = 0;
        bool leads_away = false;
        for (std::size_t j = 1; j < 4; ++j) {
          leads_away |= !holds(v[(k + j) % 4]);
          longest =
              std::max(longest, distance(scene.t.positions[v[(k + j) % 4]], scene.t.positions[v[(k + j % 3 + 1) % 4]]));
        }
        if (leads_away && longest < gap_at(scene, s)) return false;
      }
    }
  return std::any_of(group.begin(), group.end(), [&](SampleIndex s) { return moves.labels().on_surface(s); });
}

/// The cheaper of turning one side or the other; no one misses outliers.
bool cut(Moves& moves, const Group& tip) {
  if (!is_tip(moves, tip)) return false;
  for (const SampleIndex s : tip) moves.forgive(s);
  Moves::Outcome best;
  for (const Label side : {Label::inside, Label::outside}) {
    const auto turned = side_of_stars(moves, tip, side);
    if (std::any_of(turned.begin(), turned.end(), [&](TetrahedronIndex i) { return !moves.is_open(i); })) continue;
    Moves::Outcome outcome = moves.weigh(turned, 0);
    if (outcome.change < best.change) best = std::move(outcome);
  }
  moves.make(best);
  return !best.turned.empty();
}

} // namespace

SpikeCounts cut_spikes(Moves& moves) {
  std::vector<Group> left = possible_tips(moves);
  // A tip on a tip stands free only after the outer one is gone.
  SpikeCounts counts;
  for (std::size_t before = left.size() + 1; left.size() < before;) {
    before = left.size();
    std::erase_if(left, [&](const Group& tip) { return cut(moves, tip); });
    counts.cut += before - left.size();
  }
  return counts;
}

} // namespace eigencrust
