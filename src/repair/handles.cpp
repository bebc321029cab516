// SPDX-License-Identifier: GPL-3.0-or-later
// Handles as large as the noise are closed (not in the paper; docs/decisions/0016, 0027).
#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "geometry/tetrahedron.h"
#include "repair/generators.h"
#include "repair/handle_loops.h"
#include "repair/loop_sides.h"
#include "repair/reach_of_noise.h"
#include "repair/surface_fronts.h"
#include "tetrahedra/segment_walk.h"

namespace eigencrust {
namespace {

// Longer loops go around what is there.
constexpr std::uint32_t longest_loop = 100;
// No loop that is worth something goes farther from any of its samples, in edges.
constexpr auto widest_radius = static_cast<std::uint32_t>(std::numbers::pi * widest_reach) + 1;

class HandleClosing {
 public:
  explicit HandleClosing(Moves& moves)
      : moves_(moves),
        t_(moves.scene.t),
        stars_(moves.scene.stars),
        sides_(t_, stars_, moves.labels()),
        taken_(t_.tetrahedra.size(), 0) {}

  /// The first round looks for loops all over the surface; later ones look again where something was closed.
  std::uint64_t run(const Checkpoint& checkpoint) {
    std::vector<Loop> places = loops_of_surface();
    if (places.empty()) return 0;
    changed_.assign(t_.positions.size(), 0);
    std::uint64_t closed = 0;
    for (std::uint64_t before = 1; closed != before && !places.empty();) {
      before = closed;
      LoopsNearby nearby(t_.positions.size(), [&](std::uint32_t s, auto& triangles) { triangles_at(s, triangles); });
      ++round_;
      std::vector<Loop> again;
      for (Loop& loop : places) {
        if (checkpoint) checkpoint(0);
        const bool done = close_at(loop, nearby);
        closed += done;
        if (done || is_changed(loop, round_)) again.push_back(std::move(loop));
      }
      places = std::move(again);
    }
    return closed;
  }

 private:
  using Loop = std::vector<std::uint32_t>;
  using Region = std::vector<TetrahedronIndex>;

  std::vector<Loop> loops_of_surface() {
    const Surface surface = extract_surface(t_, moves_.labels().all(), moves_.scene.threads);
    surface_size_ = surface.mesh.vertices.size();
    auto loops = handle_loops(surface.mesh.triangles, surface_size_, longest_loop, moves_.scene.threads);
    for (Loop& loop : loops)
      for (std::uint32_t& v : loop) v = surface.sample_of[v].value;
    return loops;
  }

  void triangles_at(std::uint32_t s, std::vector<LoopsNearby::NamedTriangle>& triangles) const {
    for_each_surface_face(t_, stars_, moves_.labels(), VertexIndex{s}, [&](TetrahedronIndex i, std::size_t k) {
      const auto& v = t_.tetrahedra[i];
      Triangle corners{};
      for (std::size_t j = 0; j < 3; ++j) {
        if (t_.is_corner(v[face_opposite[k][j]])) return;
        corners[j] = v[face_opposite[k][j]].value;
      }
      triangles.push_back({std::uint64_t{4} * i.value + k, corners});
    });
  }

  /// The handle that the loop was found at. From afar a loop may go through one handle and around another; those from
  /// its own vertices go around one.
  bool close_at(const Loop& loop, LoopsNearby& nearby) {
    if (!is_changed(loop, 1) && close(loop)) return true;
    // All parts together are no larger than the surface: what is full of handles is no surface.
    if (nearby.visited() > surface_size_) return false;
    const auto root = std::find_if(loop.begin(), loop.end(),
                                   [&](std::uint32_t s) { return moves_.labels().on_surface(VertexIndex{s}); });
    if (root == loop.end()) return false;
    // Half around the loop; later all around, for what was closed beside it may leave a handle with a longer loop.
    const std::size_t radius = round_ > 1 ? loop.size() + 1 : (loop.size() + 1) / 2;
    const auto loops =
        nearby.at(*root, std::min(widest_radius, static_cast<std::uint32_t>(radius)), moves_.scene.threads);
    return std::any_of(loops.begin(), loops.end(), [&](const Loop& near) { return close(near); });
  }

  /// Has something been closed at one of its samples, in this round or later?
  [[nodiscard]] bool is_changed(const Loop& loop, std::uint32_t since) const {
    return std::any_of(loop.begin(), loop.end(), [&](std::uint32_t s) { return changed_[s] >= since; });
  }

  bool close(const Loop& loop) {
    const double worth = worth_of(loop);
    if (!(worth > 0) || failed_.count(loop) > 0) return false;
    const Moves::Outcome best =
        sides_.fall_apart(loop, most_tetrahedra(worth)) ? Moves::Outcome{} : best_move(loop, worth);
    if (best.turned.empty()) {
      failed_.insert(loop);
      return false;
    }
    moves_.make(best);
    for (const std::uint32_t s : moves_.samples_of(best.turned)) changed_[s] = round_;
    return true;
  }

  /// g: what closing a handle of this loop is worth; 0: it is wider than noise makes one.
  double worth_of(const Loop& loop) const {
    const double reach = reach_of_noise(moves_.scene.model, loop);
    return static_cast<double>(loop.size()) > 2 * std::numbers::pi * reach ? 0 : worth_of_reach(reach);
  }

  /// The better of filling and cutting, of the disc alone or with the stars of the loop.
  Moves::Outcome best_move(const Loop& loop, double worth) {
    Moves::Outcome best;
    for (const bool with_stars : {false, true}) {
      const Region disc = disc_of(loop, with_stars);
      if (disc.size() > most_tetrahedra(worth)) break;
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
  LoopSides sides_;
  std::set<Loop> failed_;        ///< loops that nothing closed
  std::size_t surface_size_ = 0; ///< vertices
  std::uint32_t round_ = 0;
  std::vector<std::uint32_t> changed_; ///< of each sample: the last round in which something was closed there
  std::vector<std::uint8_t> taken_;    ///< tetrahedra, while a region is gathered
};

} // namespace

HandleCounts close_handles(Moves& moves, const Checkpoint& checkpoint) {
  return {HandleClosing(moves).run(checkpoint)};
}

} // namespace eigencrust
