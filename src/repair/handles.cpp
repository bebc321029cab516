// SPDX-License-Identifier: GPL-3.0-or-later
// Handles as large as the noise are closed (not in the paper; docs/decisions/0016, 0027).
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <set>

#include "repair/generators.h"
#include "repair/handle_loops.h"
#include "tetrahedra/segment_walk.h"

namespace eigencrust {
namespace {

// Noise makes tunnels and bridges as wide as this at most, in deviations. Closing one turns faces over a disc of that
// radius, two for each sample, which cost about one each: g = 2π (16 σ / h)².
constexpr double noise_reach = 16;
// In spacings. Samples show a tunnel where they stand at half of its radius (Amenta and Bern's r = 1/2), 4π around it:
// a narrower one may be a gap between them. A wider one is meant.
constexpr double sampling_reach = 2;
// Longer loops go around what is there.
constexpr std::uint32_t longest_loop = 100;
// Tetrahedra of a disc for each unit of what closing the handle is worth: each costs a good part of one.
constexpr double tetrahedra_per_worth = 8;
class HandleClosing {
 public:
  explicit HandleClosing(Moves& moves)
      : moves_(moves), t_(moves.scene.t), stars_(moves.scene.stars), taken_(t_.tetrahedra.size(), 0) {}

  std::uint64_t run(const Checkpoint& checkpoint) {
    std::uint64_t closed = 0;
    for (std::uint64_t in_round = 1; in_round > 0; closed += in_round) in_round = close_short_loops(checkpoint);
    return closed;
  }

 private:
  using Loop = std::vector<std::uint32_t>;
  using Region = std::vector<TetrahedronIndex>;

  std::uint64_t close_short_loops(const Checkpoint& checkpoint) {
    const Surface surface = extract_surface(t_, moves_.labels().all(), moves_.scene.threads);
    const auto& triangles = surface.mesh.triangles;
    const std::size_t vertices = surface.mesh.vertices.size();
    std::optional<LoopsNearby> nearby; // most surfaces have no handle that asks for it
    changed_.assign(t_.positions.size(), 0);
    std::uint64_t closed = 0;
    for (const auto& far : handle_loops(triangles, vertices, longest_loop, moves_.scene.threads)) {
      if (checkpoint) checkpoint(0);
      const Loop loop = samples_of(surface, far);
      if (failed_.count(loop) > 0) continue;
      if (close(loop)) {
        ++closed;
        continue;
      }
      // A loop seen from afar may go through one handle and around another; those from its own vertices go around one.
      // All parts together are no larger than the surface: what is full of handles is no surface.
      if (!nearby) nearby.emplace(triangles, vertices);
      if (nearby->visited() > vertices) continue;
      const auto radius = static_cast<std::uint32_t>((far.size() + 1) / 2);
      for (const auto& near : nearby->at(far.front(), radius, moves_.scene.threads))
        if (close(samples_of(surface, near))) {
          ++closed;
          break;
        }
    }
    return closed;
  }

  static Loop samples_of(const Surface& surface, const std::vector<std::uint32_t>& vertices) {
    Loop loop;
    for (const std::uint32_t v : vertices) loop.push_back(surface.sample_of[v].value);
    return loop;
  }

  bool close(const Loop& loop) {
    // What was changed nearby may have closed this one; the next round knows.
    if (std::any_of(loop.begin(), loop.end(), [&](std::uint32_t s) { return changed_[s] != 0; })) return false;
    const double worth = worth_of(loop);
    if (!(worth > 0) || failed_.count(loop) > 0) return false;
    const Moves::Outcome best = best_move(loop, worth);
    if (best.turned.empty()) {
      failed_.insert(loop);
      return false;
    }
    moves_.make(best);
    for (const std::uint32_t s : moves_.samples_of(best.turned)) changed_[s] = 1;
    return true;
  }

  /// g: what closing a handle of this loop is worth; 0: it is wider than that.
  double worth_of(const Loop& loop) const {
    const SampleModel& model = moves_.scene.model;
    double noise = 0, spacing = 0;
    for (const std::uint32_t s : loop) {
      noise += static_cast<double>(model.noise[SampleIndex{s}]);
      spacing += static_cast<double>(model.spacing[SampleIndex{s}]);
    }
    const double reach = std::max(noise_reach * noise / spacing, sampling_reach);
    const bool is_meant = static_cast<double>(loop.size()) > 2 * std::numbers::pi * reach;
    return is_meant ? 0 : 2 * std::numbers::pi * reach * reach;
  }

  /// The better of filling and cutting, of the disc alone or with the stars of the loop.
  Moves::Outcome best_move(const Loop& loop, double worth) {
    Moves::Outcome best;
    for (const bool with_stars : {false, true}) {
      const Region disc = disc_of(loop, with_stars);
      if (static_cast<double>(disc.size()) > tetrahedra_per_worth * worth) break;
      for (const Label from : {Label::outside, Label::inside}) {
        Region turned;
        for (const TetrahedronIndex i : disc)
          if (moves_.labels()[i] == from) turned.push_back(i);
        if (turned.empty() || !std::all_of(turned.begin(), turned.end(), [&](auto i) { return moves_.is_open(i); }))
          continue;
        Moves::Outcome outcome = moves_.weigh(turned, worth);
        if (outcome.change < best.change) best = std::move(outcome);
      }
      if (best.change < 0) break;
    }
    return best;
  }

  /// What the disc from the loop to its middle crosses: the tetrahedra at its edges, or at its samples, and those on
  /// the ways inward.
  Region disc_of(const Loop& loop, bool with_stars) {
    Vec3 centre;
    for (const std::uint32_t s : loop)
      centre = centre + (1.0 / static_cast<double>(loop.size())) * t_.positions[VertexIndex{s}];
    Region region;
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const VertexIndex here{loop[k]}, next{loop[(k + 1) % loop.size()]};
      for (const TetrahedronIndex i : stars_[here])
        if (const auto& v = t_.tetrahedra[i]; with_stars || std::find(v.begin(), v.end(), next) != v.end())
          take(i, region);
      for (SegmentWalk walk(t_, stars_, here, centre); walk.next();) take(walk.tetrahedron(), region);
    }
    return release(region);
  }

  void take(TetrahedronIndex i, Region& region) {
    if (taken_[i.value]) return;
    taken_[i.value] = 1;
    region.push_back(i);
  }
  Region release(Region& region) {
    for (const TetrahedronIndex i : region) taken_[i.value] = 0;
    std::sort(region.begin(), region.end());
    return std::move(region);
  }

  Moves& moves_;
  const Tetrahedralization& t_;
  const VertexStars& stars_;
  std::set<Loop> failed_;             ///< loops that nothing closed
  std::vector<std::uint8_t> changed_; ///< samples in this round
  std::vector<std::uint8_t> taken_;   ///< tetrahedra, while a region is gathered
};

} // namespace

HandleCounts close_handles(Moves& moves, const Checkpoint& checkpoint) {
  return {HandleClosing(moves).run(checkpoint)};
}

} // namespace eigencrust
