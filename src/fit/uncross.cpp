// SPDX-License-Identifier: GPL-3.0-or-later
#include "fit/uncross.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "geometry/float_places.h"
#include "geometry/self_intersections.h"
#include "surface/clear_stars.h"

namespace eigencrust {
namespace {

// Folds come out where the surface is fine but its triangles are tangled: the middle of the neighbours is near it.
constexpr std::uint8_t easing_steps = 4;
// Then half way, a quarter of the way, and all the way back.
constexpr std::uint8_t steps_back = 3;

class Uncrossing {
 public:
  Uncrossing(std::span<const Vec3> before, std::span<const Vec3> rows, double spacing, const SurfaceFans& fans,
             TriangleMesh& mesh, const Threads& threads)
      : before_(before),
        fitted_(mesh.vertices),
        spacing_(spacing),
        fans_(fans),
        mesh_(mesh),
        threads_(threads),
        steps_(mesh.vertices.size(), 0),
        movable_(mesh.vertices.size(), 0) {
    for_each_index(threads, movable_.size(), [&](std::size_t v) {
      if (mesh_.vertices[v] == before_[v]) return;
      movable_[v] = 1;
      if (rows.empty() || mesh_.vertices[v] != rows[v]) mesh_.vertices[v] = rounded(mesh_.vertices[v]);
    });
  }

  UncrossCounts run() {
    UncrossCounts counts;
    const std::vector<std::uint8_t> clear = clear_stars(mesh_.vertices, fans_, threads_);
    degenerate_ = find_degenerate_triangles(mesh_.vertices, mesh_.triangles, clear, threads_);
    CrossingSearch search(mesh_.vertices, mesh_.triangles, degenerate_, threads_);
    search.set_clear(clear);
    std::vector<CrossingSearch::Pair> pairs = search.all(threads_);
    counts.crossings = pairs.size();
    while (ease(bad_triangles(pairs))) {
      const std::vector<std::uint32_t> changed = changed_triangles();
      for (const std::uint32_t t : changed) degenerate_[t] = is_degenerate(mesh_.vertices, mesh_.triangles[t]);
      pairs = search.of_changed(changed, threads_);
    }
    counts.left = pairs.size();
    counts.eased =
        static_cast<std::uint64_t>(std::count_if(steps_.begin(), steps_.end(), [](std::uint8_t s) { return s > 0; }));
    return counts;
  }

 private:
  /// Triangles that cross one another or have no area, increasing.
  [[nodiscard]] std::vector<std::uint32_t> bad_triangles(const std::vector<CrossingSearch::Pair>& pairs) const {
    std::vector<std::uint32_t> bad;
    for (const auto& [f, g] : pairs) {
      bad.push_back(f);
      bad.push_back(g);
    }
    for (std::uint32_t t = 0; t < degenerate_.size(); ++t)
      if (degenerate_[t] != 0) bad.push_back(t);
    std::sort(bad.begin(), bad.end());
    bad.erase(std::unique(bad.begin(), bad.end()), bad.end());
    return bad;
  }

  /// One step for each vertex of these triangles that has one left. \return whether there was any
  bool ease(const std::vector<std::uint32_t>& bad) {
    moved_.clear();
    for (const std::uint32_t t : bad)
      for (const std::uint32_t v : mesh_.triangles[t])
        if (movable_[v] && steps_[v] < easing_steps + steps_back) moved_.push_back(v);
    std::sort(moved_.begin(), moved_.end());
    moved_.erase(std::unique(moved_.begin(), moved_.end()), moved_.end());
    std::vector<Vec3> places;
    places.reserve(moved_.size());
    for (const std::uint32_t v : moved_) places.push_back(next_place(v));
    for (std::size_t i = 0; i < moved_.size(); ++i) mesh_.vertices[moved_[i]] = places[i];
    return !moved_.empty();
  }

  Vec3 next_place(std::uint32_t v) {
    const std::uint8_t step = ++steps_[v];
    // The middle of its neighbours is no place for a vertex at a rim.
    if (step <= easing_steps && !fans_.at_rim(v)) {
      Vec3 sum;
      for (const auto& wing : fans_[v]) sum = sum + (mesh_.vertices[wing.next] - before_[v]);
      const Vec3 way = (1.0 / static_cast<double>(fans_[v].size())) * sum;
      const double length = norm(way), most = std::max(distance(fitted_[v], before_[v]), spacing_);
      return rounded(before_[v] + std::min(1.0, most / length) * way);
    }
    if (step >= easing_steps + steps_back) return before_[v];
    const double share = std::ldexp(1.0, -std::max(1, step - easing_steps));
    return rounded(before_[v] + share * (fitted_[v] - before_[v]));
  }

  /// Those at vertices that moved in the last step, increasing.
  [[nodiscard]] std::vector<std::uint32_t> changed_triangles() const {
    std::vector<std::uint8_t> of_vertex(mesh_.vertices.size(), 0);
    for (const std::uint32_t v : moved_) of_vertex[v] = 1;
    std::vector<std::uint32_t> changed;
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
      const auto& [a, b, c] = mesh_.triangles[t];
      if (of_vertex[a] | of_vertex[b] | of_vertex[c]) changed.push_back(t);
    }
    return changed;
  }

  [[nodiscard]] Vec3 rounded(const Vec3& p) const { return as_floats(p, spacing_); }

  std::span<const Vec3> before_;
  std::vector<Vec3> fitted_;
  double spacing_;
  const SurfaceFans& fans_;
  TriangleMesh& mesh_;
  const Threads& threads_;
  std::vector<std::uint8_t> steps_, movable_; ///< of each vertex
  std::vector<std::uint8_t> degenerate_;      ///< of each triangle
  std::vector<std::uint32_t> moved_;          ///< in the last step
};

} // namespace

UncrossCounts uncross(std::span<const Vec3> before, double spacing, const SurfaceFans& fans, TriangleMesh& mesh,
                      const Threads& threads, std::span<const Vec3> rows) {
  return Uncrossing(before, rows, spacing, fans, mesh, threads).run();
}

} // namespace eigencrust
