// SPDX-License-Identifier: GPL-3.0-or-later
// Samples that the surface passes by, taken in one tetrahedron at a time (not in the paper;
// docs/decisions/0027).
#include <algorithm>
#include <array>

#include "geometry/tetrahedron.h"
#include "repair/generators.h"
#include "samples/scales.h"

namespace eigencrust {
namespace {

// A stray is lonely: its nearest sample is farther away than the surface's samples are from each other, or, where two
// are together, its third nearest. In spacings.
constexpr double farthest_nearest = 1.5, farthest_third = 2;

/// Square of its longest edge.
double squared_length(const Tetrahedralization& t, TetrahedronIndex i) {
  const std::array<Vec3, 4> p = corners_of(t, i);
  double longest = 0;
  for (std::size_t a = 0; a < p.size(); ++a)
    for (std::size_t b = 0; b < a; ++b) longest = std::max(longest, squared_norm(p[a] - p[b]));
  return longest;
}

/// The tetrahedron of the star with a surface triangle opposite s that costs least; invalid if none makes it better.
/// Turning it puts s on the surface and neither opens nor joins anything.
TetrahedronIndex best_tetrahedron(const Moves& moves, SampleIndex s) {
  const MoveScene& scene = moves.scene;
  const auto around = nearest_samples(scene, s);
  double least = 0;
  TetrahedronIndex best;
  for (const TetrahedronIndex i : scene.stars[s]) {
    if (!moves.is_open(i)) continue;
    const auto& v = scene.t.tetrahedra[i];
    std::size_t k = 0;
    while (v[k] != s) ++k;
    const TetrahedronIndex across = scene.t.neighbours[i][k];
    if (!across.valid() || moves.labels()[across] == moves.labels()[i]) continue;
    double spacing = 0; // of the triangle's samples
    for (const std::size_t j : face_opposite[k])
      if (!scene.t.is_corner(v[j]))
        spacing += static_cast<double>(scene.model.spacing[scene.t.sample(v[j])]) /
                   static_cast<double>(face_opposite[k].size());
    if (around.front().distance > farthest_nearest * spacing || around.back().distance > farthest_third * spacing)
      continue;
    // What is longer than samples bear out leads to another part: tips beside each other were strung together.
    if (squared_length(scene.t, i) > longest_edge * longest_edge * spacing * spacing) continue;
    const double cost = moves.labels().cost_of(i);
    if (cost >= least) continue;
    least = cost;
    best = i;
  }
  return best;
}

} // namespace

RecoveryCounts recover_samples(Moves& moves) {
  std::vector<SampleIndex> passed;
  for (SampleIndex s{0}; s.value < moves.scene.t.sample_count; ++s.value)
    if (!moves.labels().on_surface(s) && moves.labels().price(s) > 0) passed.push_back(s);
  RecoveryCounts counts;
  // One that was taken in may bring the surface near to the next.
  for (std::size_t before = passed.size() + 1; passed.size() < before;) {
    before = passed.size();
    std::erase_if(passed, [&](SampleIndex s) {
      if (moves.labels().on_surface(s)) return true;
      const TetrahedronIndex best = best_tetrahedron(moves, s);
      if (best.valid()) moves.turn(best);
      return best.valid();
    });
    counts.samples += before - passed.size();
  }
  return counts;
}

} // namespace eigencrust
