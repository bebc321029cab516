// SPDX-License-Identifier: GPL-3.0-or-later
// Normals that look outward, from the labels (not in the paper; docs/decisions/0014).
#include <algorithm>
#include <cmath>
#include <limits>

#include <eigencrust/stages.h>

#include "geometry/nearest_on_triangle.h"
#include "parallel/threads.h"
#include "points/orient.h"
#include "surface/fans.h"

namespace eigencrust {
namespace {

// Steps of smoothing per grid spacing of noise in units of the surface's edges, of which two count at most.
constexpr double steps_per_ratio = 32;

Vec3 unit_or(const Vec3& v, const Vec3& otherwise) {
  const double length = norm(v);
  return length > 0 ? (1 / length) * v : otherwise;
}

/// Triangles out to implausible vertices count only where there are no others.
class VertexNormals {
 public:
  VertexNormals(const Surface& surface, const std::vector<std::uint8_t>& plausible)
      : surface_(surface), fans_(surface.mesh), plausible_(plausible) {}

  struct Pair {
    Vec3 by_angle; ///< unit; triangles weighted by their angle at the vertex (Thürmer and Wüthrich 1998)
    Vec3 by_area;  ///< sum of area vectors
  };
  [[nodiscard]] Pair of_triangles(std::size_t v) const {
    Pair all, fine;
    Vec3 any{0, 0, 1};
    for (const auto& [next, last] : fans_[v]) {
      const Vec3 a = at(next) - at(v), b = at(last) - at(v);
      const Vec3 area = cross(a, b);
      any = unit_or(area, any);
      const Vec3 weighted = std::atan2(norm(area), dot(a, b)) * unit_or(area, {});
      all = {all.by_angle + weighted, all.by_area + area};
      if (plausible_[next] && plausible_[last]) fine = {fine.by_angle + weighted, fine.by_area + area};
    }
    const Pair& best = squared_norm(fine.by_angle) > 0 ? fine : all;
    return {unit_or(best.by_angle, any), best.by_area};
  }

  /// How often the normal at v is to be averaged with those of its neighbours.
  [[nodiscard]] int steps(std::size_t v, std::span<const float> grid_spacing) const {
    if (grid_spacing.empty() || !(grid_spacing[surface_.sample_of[v].value] > 0)) return 0;
    double edges = 0;
    for (const auto& wing : fans_[v]) edges += distance(at(v), at(wing.next));
    const double mean = edges / static_cast<double>(fans_[v].size());
    const double ratio = static_cast<double>(grid_spacing[surface_.sample_of[v].value]) / mean;
    return static_cast<int>(std::lround(steps_per_ratio * std::min(2.0, ratio)));
  }

  [[nodiscard]] Vec3 sum_around(std::size_t v, const std::vector<Vec3>& normals) const {
    Vec3 sum = normals[v];
    for (const auto& wing : fans_[v])
      if (plausible_[wing.next]) sum = sum + normals[wing.next];
    return sum;
  }

 private:
  [[nodiscard]] const Vec3& at(std::size_t v) const { return surface_.mesh.vertices[v]; }

  const Surface& surface_;
  SurfaceFans fans_;
  const std::vector<std::uint8_t>& plausible_;
};

std::vector<Vec3> vertex_normals(const Surface& surface, const std::vector<std::uint8_t>& plausible,
                                 std::span<const float> grid_spacing, const Threads& threads) {
  const std::size_t n = surface.mesh.vertices.size();
  const VertexNormals rule(surface, plausible);
  std::vector<Vec3> by_angle(n), by_area(n);
  std::vector<int> steps(n);
  for_each_index(threads, n, [&](std::size_t v) {
    const VertexNormals::Pair pair = rule.of_triangles(v);
    by_angle[v] = pair.by_angle;
    by_area[v] = pair.by_area;
    steps[v] = rule.steps(v, grid_spacing);
  });
  const int rounds = n == 0 ? 0 : *std::max_element(steps.begin(), steps.end());
  if (rounds == 0) return by_angle;
  std::vector<Vec3> next(n);
  for (int round = 0; round < rounds; ++round) {
    // The sum over all triangles around, which noise within does not touch: it hangs on their outline alone.
    for_each_index(threads, n,
                   [&](std::size_t v) { next[v] = steps[v] > round ? rule.sum_around(v, by_area) : by_area[v]; });
    by_area.swap(next);
  }
  for_each_index(threads, n, [&](std::size_t v) {
    const Vec3 nearby = unit_or(rule.sum_around(v, by_angle), by_angle[v]);
    // Beyond a sharp rim lie the large triangles of the other side: they must not turn the normal round.
    const Vec3 wide = unit_or(by_area[v], nearby);
    next[v] = steps[v] == 0 ? by_angle[v] : dot(wide, nearby) > 0 ? wide : nearby;
  });
  return next;
}

/// Between the corners of a triangle, by the areas that its nearest point to p cuts it into.
Vec3 normal_near(const Vec3& p, const Corners& c, const std::array<Vec3, 3>& normal) {
  const Vec3 q = nearest_on_triangle(c, p);
  Vec3 sum;
  for (std::size_t k = 0; k < 3; ++k) sum = sum + norm(cross(c[(k + 1) % 3] - q, c[(k + 2) % 3] - q)) * normal[k];
  return unit_or(sum, normal[0]);
}

} // namespace

IndexedArray<SampleIndex, Vec3> orient_samples(const Tetrahedralization& t, const Surface& surface,
                                               const Classification& samples, std::span<const float> grid_spacing,
                                               const Threads& threads) {
  std::vector<std::uint8_t> plausible(surface.mesh.vertices.size());
  for (std::uint32_t v = 0; v < plausible.size(); ++v)
    plausible[v] = samples.place[surface.sample_of[v]] == std::array{v, v, v};
  const std::vector<Vec3> of_vertex = vertex_normals(surface, plausible, grid_spacing, threads);
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  IndexedArray<SampleIndex, Vec3> normals(t.sample_count, {nan, nan, nan});
  for_each_index(threads, t.sample_count, [&](std::size_t i) {
    const SampleIndex s{static_cast<std::uint32_t>(i)};
    if (!samples.inlier[s]) return;
    const auto& [a, b, c] = samples.place[s];
    const auto& at = surface.mesh.vertices;
    normals[s] = a == b
                     ? of_vertex[a]
                     : normal_near(t.positions[s], {at[a], at[b], at[c]}, {of_vertex[a], of_vertex[b], of_vertex[c]});
  });
  return normals;
}

} // namespace eigencrust
