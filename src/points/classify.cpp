// SPDX-License-Identifier: GPL-3.0-or-later
// Which samples belong to the surface (not in the paper; docs/decisions/0014).
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <eigencrust/metrics.h>

#include "numerics/quantile.h"
#include "parallel/threads.h"
#include "points/classify.h"
#include "surface/fans.h"

namespace eigencrust {
namespace {

/// What each vertex of the surface says of itself.
class Vertices {
 public:
  Vertices(const Surface& surface, const SampleModel& model, const Threads& threads)
      : surface_(surface), model_(model), fans_(surface.mesh) {
    const std::size_t n = surface.mesh.vertices.size();
    height_.resize(n);
    tolerance_.resize(n);
    for_each_index(threads, n, [&](std::size_t v) { measure(v); });
  }

  /// How far the vertex stands out of its neighbours.
  [[nodiscard]] double height(std::size_t v) const { return height_[v]; }
  /// Of the surface around the vertex, itself left out.
  [[nodiscard]] double tolerance(std::size_t v) const { return tolerance_[v]; }
  /// Is it no spike, and does it not stand alone, as surface made of outliers does?
  [[nodiscard]] bool is_plausible(std::size_t v) const {
    return height_[v] <= tolerance_[v] && !(model_.isolated[surface_.sample_of[v]] > 0);
  }

 private:
  [[nodiscard]] const Vec3& at(std::size_t v) const { return surface_.mesh.vertices[v]; }

  void measure(std::size_t v) {
    std::vector<double> around;
    Vec3 centre, area;
    for (const auto& [next, last] : fans_[v]) {
      around.push_back(model_.tolerance(surface_.sample_of[next]));
      centre = centre + at(next);
      area = area + cross(at(next) - at(v), at(last) - at(v));
    }
    tolerance_[v] = median(around);
    // Along the normal: where the spacing changes the middle of the neighbours lies aside, but within the surface.
    const Vec3 off = at(v) - (1.0 / static_cast<double>(around.size())) * centre;
    height_[v] = norm(area) > 0 ? std::fabs(dot(off, area)) / norm(area) : norm(off);
  }

  const Surface& surface_;
  const SampleModel& model_;
  SurfaceFans fans_;
  std::vector<double> height_, tolerance_;
};

/// The plausible part of the surface, for samples that are not on it.
class Target {
 public:
  template <class IsPlausible>
  Target(const Surface& surface, const IsPlausible& is_plausible) : surface_(surface) {
    TriangleMesh plausible;
    for (const auto& triangle : surface.mesh.triangles)
      if (std::all_of(triangle.begin(), triangle.end(), is_plausible)) plausible.triangles.push_back(triangle);
    if (plausible.triangles.empty()) return;
    triangles_ = plausible.triangles;
    plausible.vertices = surface.mesh.vertices;
    tree_.emplace(plausible);
  }

  struct Found {
    double distance = std::numeric_limits<double>::infinity();
    std::array<std::uint32_t, 3> triangle{};
    std::uint32_t vertex = 0; ///< the nearest corner
  };
  [[nodiscard]] Found nearest(const Vec3& p) const {
    if (!tree_) return {};
    const TriangleTree::Nearest found = tree_->nearest(p);
    const auto& triangle = triangles_[found.triangle];
    const auto farther = [&](std::uint32_t a, std::uint32_t b) {
      return distance(p, surface_.mesh.vertices[a]) < distance(p, surface_.mesh.vertices[b]);
    };
    return {found.distance, triangle, *std::min_element(triangle.begin(), triangle.end(), farther)};
  }

 private:
  const Surface& surface_;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
  std::optional<TriangleTree> tree_;
};

/// What is left of the samples beside the surface through their middle says better how noisy they are than what was
/// measured before there was one: so many times as noisy, at least once.
double noise_scale(std::span<const Target::Found> nearest, std::span<const float> noise) {
  constexpr double median_of_normal = 0.6745; // of the absolute value, in deviations
  std::vector<double> deviations;
  for (const Target::Found& found : nearest)
    if (found.distance < std::numeric_limits<double>::infinity() && noise[found.vertex] > 0)
      deviations.push_back(found.distance / static_cast<double>(noise[found.vertex]));
  return deviations.empty() ? 1 : std::max(1.0, median(deviations) / median_of_normal);
}

} // namespace

Classification classify_samples(const Tetrahedralization& t, const Surface& surface, const SampleModel& model,
                                const Threads& threads) {
  Classification result;
  result.inlier = IndexedArray<SampleIndex, std::uint8_t>(t.sample_count, 0);
  result.confidence = IndexedArray<SampleIndex, float>(t.sample_count, 0.0f);
  result.place = IndexedArray<SampleIndex, std::array<std::uint32_t, 3>>(t.sample_count);
  if (surface.mesh.triangles.empty()) return result;
  const Vertices vertices(surface, model, threads);
  const Target target(surface, [&](std::uint32_t v) { return vertices.is_plausible(v); });
  IndexedArray<SampleIndex, std::uint32_t> vertex_of(t.sample_count, no_index);
  for (std::uint32_t v = 0; v < surface.sample_of.size(); ++v) vertex_of[surface.sample_of[v]] = v;
  const auto classify = [&](std::size_t i) {
    const SampleIndex s{static_cast<std::uint32_t>(i)};
    const std::uint32_t v = vertex_of[s];
    double deviation = 0, tolerance = 0;
    if (v != no_index && vertices.is_plausible(v)) {
      deviation = vertices.height(v);
      tolerance = vertices.tolerance(v);
      result.place[s] = {v, v, v};
    } else {
      const Target::Found found = target.nearest(t.positions[s]);
      deviation = v == no_index ? found.distance : std::max(found.distance, vertices.height(v));
      tolerance = vertices.tolerance(found.vertex);
      result.place[s] = found.triangle;
    }
    const double ratio = deviation / tolerance;
    result.confidence[s] = static_cast<float>(1 / (1 + ratio * ratio));
    result.inlier[s] = 2 * result.confidence[s] >= 1;
  };
  for_each_index(threads, t.sample_count, classify, costly_block);
  return result;
}

void classify_by_distance(std::span<const Vec3> samples, const Surface& fitted, const SampleModel& model,
                          std::span<const float> noise, Classification& classes, const Threads& threads) {
  const std::size_t n = fitted.sample_of.size();
  std::vector<std::uint8_t> plausible(n);
  for (std::uint32_t v = 0; v < n; ++v) plausible[v] = classes.place[fitted.sample_of[v]] == std::array{v, v, v};
  const Target target(fitted, [&](std::uint32_t v) { return plausible[v] != 0; });
  std::vector<Target::Found> nearest(samples.size());
  for_each_index(
      threads, nearest.size(), [&](std::size_t i) { nearest[i] = target.nearest(samples[i]); }, costly_block);
  const double scale = noise_scale(nearest, noise);
  const auto classify = [&](std::size_t i) {
    const SampleIndex s{static_cast<std::uint32_t>(i)};
    const Target::Found& found = nearest[i];
    if (!(found.distance < std::numeric_limits<double>::infinity())) return;
    // Thin parts read as free of noise; `noise` knows better.
    const double tolerance = std::max(model.tolerance(fitted.sample_of[found.vertex]),
                                      scale * static_cast<double>(noise_bound * noise[found.vertex]));
    const double ratio = found.distance / tolerance;
    classes.confidence[s] = static_cast<float>(1 / (1 + ratio * ratio));
    classes.inlier[s] = 2 * classes.confidence[s] >= 1;
    const auto& place = classes.place[s];
    if (place[0] != place[1]) classes.place[s] = found.triangle;
  };
  for_each_index(threads, samples.size(), classify);
}

} // namespace eigencrust
