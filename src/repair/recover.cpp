// SPDX-License-Identifier: GPL-3.0-or-later
// Samples that the surface passes by, taken in one tetrahedron at a time (not in the paper;
// docs/decisions/0027).
#include <algorithm>
#include <array>
#include <span>
#include <utility>
#include <vector>

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

/// May the surface reach over the tetrahedron to its sample s, which it passes by? \param around those nearest to s
bool may_reach(const Moves& moves, TetrahedronIndex i, SampleIndex s, std::span<const NearSample> around) {
  const MoveScene& scene = moves.scene;
  if (!moves.is_open(i)) return false;
  double spacing = 0; // of the three others
  for (const VertexIndex v : scene.t.tetrahedra[i])
    if (v != s && !scene.t.is_corner(v)) spacing += static_cast<double>(scene.model.spacing[scene.t.sample(v)]) / 3;
  if (around.front().distance > farthest_nearest * spacing || around.back().distance > farthest_third * spacing)
    return false;
  // What is longer than samples bear out leads to another part: tips beside each other were strung together.
  return squared_length(scene.t, i) <= longest_edge * longest_edge * spacing * spacing;
}

/// Has it a triangle of the surface opposite s? Turning it then puts s on the surface and neither opens nor joins
/// anything.
bool is_on_surface_triangle(const Moves& moves, TetrahedronIndex i, SampleIndex s) {
  const auto& v = moves.scene.t.tetrahedra[i];
  std::size_t k = 0;
  while (v[k] != s) ++k;
  const TetrahedronIndex across = moves.scene.t.neighbours[i][k];
  return across.valid() && moves.labels()[across] != moves.labels()[i];
}

/// Those of the star that make the surface better, the best first.
std::vector<TetrahedronIndex> better_tetrahedra(const Moves& moves, SampleIndex s) {
  const auto around = nearest_samples(moves.scene, s);
  std::vector<std::pair<double, TetrahedronIndex>> better;
  for (const TetrahedronIndex i : moves.scene.stars[s]) {
    if (!may_reach(moves, i, s, around)) continue;
    if (const double cost = moves.labels().cost_of(i); cost < 0) better.emplace_back(cost, i);
  }
  std::sort(better.begin(), better.end());
  std::vector<TetrahedronIndex> result;
  for (const auto& [cost, i] : better) result.push_back(i);
  return result;
}

/// Takes s in by one tetrahedron that lies on the surface.
bool take_in_by_one(Moves& moves, SampleIndex s) {
  for (const TetrahedronIndex i : better_tetrahedra(moves, s))
    if (is_on_surface_triangle(moves, i, s)) {
      moves.turn(i);
      return true;
    }
  return false;
}

/// Takes s in by one that touches the surface with less than a triangle, and what the surface needs then.
bool take_in_by_several(Moves& moves, SampleIndex s) {
  for (const TetrahedronIndex i : better_tetrahedra(moves, s)) {
    const TetrahedronIndex one[] = {i};
    const Moves::Outcome outcome = moves.weigh(one, 0);
    if (!(outcome.change < 0) || outcome.pieces != 0 || outcome.handles != 0) continue;
    moves.make(outcome);
    if (moves.labels().on_surface(s)) return true;
  }
  return false;
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
      return take_in_by_one(moves, s);
    });
    counts.samples += before - passed.size();
  }
  // Strays near a flat face are in company, too, and far more of these moves reach them.
  if (moves.among_strays) return counts;
  for (const SampleIndex s : passed)
    if (!moves.labels().on_surface(s)) counts.samples += take_in_by_several(moves, s);
  return counts;
}

} // namespace eigencrust
