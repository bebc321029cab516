// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/simplify.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include "geometry/float_places.h"
#include "simplify/collapse_again.h"
#include "simplify/collapse_in_parts.h"
#include "simplify/crossings.h"
#include "simplify/turned.h"

namespace eigencrust {
namespace {

// First, in parts on all threads, to so many times the triangles that are to stay, or to that share of the error.
constexpr std::size_t first_factor = 4;
constexpr double first_share = 0.5;
// What rounding of the coordinates takes, and points between those that are looked at, may be this much.
constexpr double share_of_error = 0.95;
// Where triangles cross or are too far off, edges may go half as far in the next round; after so many rounds they stay,
// and in each one more those around, too. What is bad after the last does not get better.
constexpr int rounds_of_halving = 4, rounds = 12;
// In the last step the rest of the mesh stays as it is then, but for so many edges around: room for another way.
constexpr int rings_apart = 2;

class Simplification {
 public:
  Simplification(const TriangleMesh& full, const FullSurface& surface, const SimplifyGoal& goal, double spacing,
                 const Threads& threads)
      : full_(full), surface_(surface), goal_(goal), spacing_(spacing), threads_(threads), sides_(full, threads) {
    Box3 box;
    for (const Vec3& p : full.vertices) box.add(p);
    centre_ = box.empty() ? Vec3{} : box.centre();
  }

  OtherTriangles run() {
    const State start = start_state();
    State state = start;
    if (full_.triangles.size() > 2 * first_factor * goal_.triangles)
      state = step(start, {first_factor * goal_.triangles, first_share * share_of_error * goal_.max_error}, false);
    state = step(state, {goal_.triangles, share_of_error * goal_.max_error}, true);
    if (limits_error() && !state.deviation) state.deviation = surface_.measure(placed(state), threads_);
    if (!fits(state)) state = start;
    OtherTriangles result;
    result.mesh = placed(state);
    result.deviation = state.deviation ? *state.deviation : surface_.measure(result.mesh, threads_);
    result.held = held_;
    result.crossing = state.crossing ? *state.crossing : crossing_vertices(result.mesh, threads_).count;
    return result;
  }

 private:
  static constexpr double unlimited = std::numeric_limits<double>::infinity();

  struct State {
    Collapsed collapsed; ///< `into` is of the vertices of the full mesh; relative to the centre
    std::optional<DeviationReport> deviation;
    std::optional<std::uint64_t> crossing;
  };

  [[nodiscard]] bool limits_error() const { return goal_.max_error < unlimited; }
  /// Is it as near as was asked for?
  [[nodiscard]] bool fits(const State& state) const {
    return !limits_error() || (state.deviation && state.deviation->max() <= goal_.max_error);
  }

  /// The full mesh relative to the centre.
  [[nodiscard]] TriangleMesh start_mesh() const {
    TriangleMesh mesh{full_.vertices, full_.triangles, {}, {}};
    for (Vec3& p : mesh.vertices) p = p - centre_;
    return mesh;
  }

  [[nodiscard]] State start_state() const {
    State state;
    TriangleMesh& mesh = state.collapsed.mesh;
    mesh = start_mesh();
    state.collapsed.quadrics = vertex_quadrics(mesh, threads_);
    state.collapsed.into.resize(mesh.vertices.size());
    std::iota(state.collapsed.into.begin(), state.collapsed.into.end(), 0u);
    return state;
  }

  /// In the coordinates of the full mesh; what did not move is where it was bit for bit.
  [[nodiscard]] TriangleMesh placed(const State& state) const {
    const TriangleMesh& mesh = state.collapsed.mesh;
    const std::vector<std::uint32_t>& into = state.collapsed.into;
    TriangleMesh result{std::vector<Vec3>(mesh.vertices.size()), mesh.triangles, {}, {}};
    for_each_index(threads_, mesh.vertices.size(),
                   [&](std::size_t v) { result.vertices[v] = as_floats(mesh.vertices[v] + centre_, spacing_); });
    for (std::size_t v = 0; v < into.size(); ++v)
      if (full_.vertices[v] - centre_ == mesh.vertices[into[v]]) result.vertices[into[v]] = full_.vertices[v];
    return result;
  }

  /// From `before` on towards the goal, until nothing crosses; in the last step also until nothing is too far off.
  /// \return `before` where that does not come to pass
  State step(const State& before, const CollapseGoal& goal, bool last) {
    const TriangleMesh& mesh = before.collapsed.mesh;
    std::vector<float> limits(mesh.vertices.size(), std::numeric_limits<float>::infinity());
    TriangleMesh full; // relative to the centre
    if (last && limits_error()) full = start_mesh();
    const std::vector<std::uint32_t> triangle = nearest_triangles(full.vertices, mesh);
    const StandFor stand_for{&surface_.tree(), centre_, full.vertices, triangle};
    std::optional<CollapseInParts> parts;
    if (!last) parts.emplace(mesh, before.collapsed.quadrics, stand_for, goal, threads_);
    Collapsed made;
    std::vector<std::uint8_t> bad;
    for (int round = 0; round < rounds; ++round) {
      std::optional<Collapsed> again;
      if (round > 0 && last && !limits_error()) {
        widen(made.mesh, rings_apart, bad);
        again = collapse_again(before.collapsed, made, limits, bad, goal, threads_);
      }
      made = again  ? std::move(*again)
             : last ? collapse_edges(mesh, before.collapsed.quadrics, limits, stand_for, goal)
                    : parts->run(limits);
      State after{made, {}, {}};
      after.collapsed.into = before.collapsed.into;
      for (std::uint32_t& v : after.collapsed.into) v = made.into[v];
      bad = bad_vertices(after, last);
      if (bad.empty()) {
        held_ += static_cast<std::uint64_t>(
            std::count_if(limits.begin(), limits.end(), [](float l) { return std::isfinite(l); }));
        return after;
      }
      hold(made, bad, round, mesh, limits);
    }
    return before;
  }

  [[nodiscard]] std::vector<std::uint32_t> nearest_triangles(std::span<const Vec3> points,
                                                             const TriangleMesh& mesh) const {
    std::vector<std::uint32_t> nearest(points.size());
    if (points.empty()) return nearest;
    const TriangleTree tree(mesh, threads_.size());
    for_each_index(
        threads_, nearest.size(), [&](std::size_t i) { nearest[i] = tree.nearest(points[i]).triangle; }, costly_block);
    return nearest;
  }

  /// Lowers the limits of the vertices that what is bad was made from.
  static void hold(const Collapsed& after, const std::vector<std::uint8_t>& bad, int round, const TriangleMesh& before,
                   std::vector<float>& limits) {
    std::vector<std::uint8_t> held(limits.size());
    for (std::size_t v = 0; v < held.size(); ++v) held[v] = bad[after.into[v]];
    if (round >= rounds_of_halving) {
      widen(before, round - rounds_of_halving, held);
      for (std::size_t v = 0; v < held.size(); ++v)
        if (held[v]) limits[v] = -1;
      return;
    }
    for (std::size_t v = 0; v < held.size(); ++v) {
      if (!held[v]) continue;
      const std::uint32_t now = after.into[v];
      const Quadric& q = after.quadrics[now];
      const double distance = q.weight() > 0 ? std::sqrt(q.at(after.mesh.vertices[now]) / q.weight()) : 0;
      limits[v] = 0.5f * std::min(limits[v], static_cast<float>(distance));
    }
  }

  /// Vertices of what must not be; empty: there is none. Writes down what it finds.
  std::vector<std::uint8_t> bad_vertices(State& state, bool last) const {
    const TriangleMesh mesh = placed(state);
    CrossingVertices crossing = crossing_vertices(mesh, threads_);
    state.crossing = crossing.count;
    std::vector<std::uint8_t> bad = std::move(crossing.at),
                              more = sides_.turned(mesh, vertices_before(state), threads_);
    for (std::size_t v = 0; v < more.size(); ++v) bad[v] |= more[v];
    if (last && limits_error()) {
      state.deviation = surface_.measure(mesh, goal_.max_error, state.collapsed.into, more, threads_);
      for (std::size_t v = 0; v < more.size(); ++v) bad[v] |= more[v];
    }
    if (std::find(bad.begin(), bad.end(), 1) == bad.end()) bad.clear();
    return bad;
  }

  /// For each vertex one of the full mesh that it was made from.
  [[nodiscard]] static std::vector<std::uint32_t> vertices_before(const State& state) {
    std::vector<std::uint32_t> before(state.collapsed.mesh.vertices.size(), 0);
    for (std::uint32_t v = 0; v < state.collapsed.into.size(); ++v) before[state.collapsed.into[v]] = v;
    return before;
  }

  const TriangleMesh& full_;
  const FullSurface& surface_;
  SimplifyGoal goal_;
  double spacing_;
  const Threads& threads_;
  PieceSides sides_;
  Vec3 centre_;
  std::uint64_t held_ = 0;
};

} // namespace

OtherTriangles simplify(const TriangleMesh& full, const FullSurface& surface, const SimplifyGoal& goal, double spacing,
                        const Threads& threads) {
  return Simplification(full, surface, goal, spacing, threads).run();
}

} // namespace eigencrust
