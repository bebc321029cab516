// SPDX-License-Identifier: GPL-3.0-or-later
// Which samples belong to the surface (not in the paper; docs/decisions/0014).
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include <eigencrust/stages.h>

#include "geometry/local_pca.h"
#include "geometry/nearest.h"
#include "geometry/nearest_on_triangle.h"
#include "numerics/quantile.h"
#include "parallel/threads.h"
#include "points/classify.h"
#include "surface/fans.h"

namespace eigencrust {
namespace {

// The tolerance, in local spacings and in standard deviations of the noise.
constexpr double tolerance_in_spacings = 1.25;
constexpr double tolerance_in_deviations = 3;
// The grid spacing is 1.2 deviations where it is measured (docs/decisions/0024).
constexpr double deviations_per_grid_spacing = 1 / 1.2;
// A vertex is isolated when its third shortest edge is longer than so many times the median of all.
constexpr double isolation = 3;
// Its neighbourhood is scattered when it is that thick beside its second width: outliers fill space.
constexpr double scattered_ratio = 0.45;
constexpr std::size_t neighbourhood = 20;
// How often vertices follow the majority of their neighbours out of the surface.
constexpr int majority_rounds = 3;
// Samples off the surface look for it at so many vertices.
constexpr std::size_t vertices_looked_at = 3;
// Of so many where up to this share of all may have to be passed over.
constexpr std::size_t vertices_searched = 12;
constexpr double few_implausible = 0.01;
// The nearest vertex may be that much farther than the surface: the middle of a hole's lid is no evidence.
constexpr double reach_of_a_vertex = 3;

/// What each vertex of the surface says of itself.
class Vertices {
 public:
  Vertices(const Surface& surface, std::span<const float> grid_spacing, const Threads& threads)
      : surface_(surface), fans_(surface.mesh), tree_(surface.mesh.vertices), threads_(threads) {
    const std::size_t n = surface.mesh.vertices.size();
    edge_.resize(n);
    spacing_.resize(n);
    height_.resize(n);
    for_each_index(threads, n, [&](std::size_t v) { edge_[v] = third_shortest_edge(v); });
    for_each_index(threads, n, [&](std::size_t v) { measure(v); });
    tolerance_.resize(n);
    for (std::size_t v = 0; v < n; ++v) tolerance_[v] = tolerance(spacing_[v], grid_spacing, surface.sample_of[v]);
  }

  static double tolerance(double spacing, std::span<const float> grid_spacing, SampleIndex s) {
    const double noise = grid_spacing.empty() ? 0 : deviations_per_grid_spacing * grid_spacing[s.value];
    return std::max(tolerance_in_spacings * spacing, tolerance_in_deviations * noise);
  }

  /// 0 for the vertices of spikes and of surface that is made of outliers.
  [[nodiscard]] std::vector<std::uint8_t> plausible() const {
    const std::size_t n = edge_.size();
    std::vector<std::uint8_t> fine(n);
    for (std::size_t v = 0; v < n; ++v) fine[v] = height_[v] <= tolerance_[v];
    drop_scattered(fine);
    // Their neighbours stand on nothing either.
    for (int round = 0; round < majority_rounds; ++round) {
      std::vector<std::uint8_t> next = fine;
      for_each_index(threads_, n, [&](std::size_t v) {
        std::size_t others = 0;
        for (const auto& wing : fans_[v]) others += !fine[wing.next];
        if (2 * others > fans_[v].size()) next[v] = 0;
      });
      if (next == fine) break;
      fine = std::move(next);
    }
    return fine;
  }

  [[nodiscard]] const SurfaceFans& fans() const { return fans_; }
  [[nodiscard]] const PointTree& tree() const { return tree_; }
  /// How far the vertex stands out of its neighbours.
  [[nodiscard]] double height(std::size_t v) const { return height_[v]; }
  [[nodiscard]] double tolerance(std::size_t v) const { return tolerance_[v]; }
  /// Of the surface around the vertex, itself left out.
  [[nodiscard]] double spacing(std::size_t v) const { return spacing_[v]; }

 private:
  [[nodiscard]] const Vec3& at(std::size_t v) const { return surface_.mesh.vertices[v]; }

  [[nodiscard]] double third_shortest_edge(std::size_t v) const {
    std::array<double, 3> shortest;
    shortest.fill(std::numeric_limits<double>::infinity());
    for (const auto& wing : fans_[v]) {
      double d = squared_norm(at(wing.next) - at(v));
      for (double& s : shortest)
        if (d < s) std::swap(d, s);
    }
    // Only at the rim of an open surface are there fewer.
    for (std::size_t k = 2; k > 0; --k)
      if (std::isfinite(shortest[k])) return std::sqrt(shortest[k]);
    return std::sqrt(shortest[0]);
  }

  void measure(std::size_t v) {
    std::vector<double> around;
    Vec3 centre;
    for (const auto& wing : fans_[v]) {
      around.push_back(edge_[wing.next]);
      centre = centre + at(wing.next);
    }
    spacing_[v] = quantile(around, 0.5);
    const double aside = distance(at(v), (1.0 / static_cast<double>(around.size())) * centre);
    const double excess = edge_[v] * edge_[v] - spacing_[v] * spacing_[v];
    // Where the spacing changes along the surface only one of the two is large, at a spike both.
    height_[v] = excess > 0 ? std::min(aside, std::sqrt(excess)) : 0;
  }

  void drop_scattered(std::vector<std::uint8_t>& fine) const {
    std::vector<double> edges = edge_;
    const double limit = isolation * quantile(edges, 0.5);
    std::vector<std::uint32_t> isolated;
    for (std::uint32_t v = 0; v < edge_.size(); ++v)
      if (edge_[v] > limit) isolated.push_back(v);
    for_each_index(
        threads_, isolated.size(), [&](std::size_t i) { fine[isolated[i]] &= !is_scattered(isolated[i]); },
        costly_block);
  }

  /// Do the vertices around it fill space, or does it stand off the plane that they make?
  [[nodiscard]] bool is_scattered(std::uint32_t v) const {
    std::array<std::uint32_t, neighbourhood + 1> index{};
    std::array<double, neighbourhood + 1> square{};
    const std::size_t found = tree_.nearest(at(v), index.size(), index.data(), square.data());
    const LocalPca pca = local_pca(surface_.mesh.vertices, std::span(index).first(found), at(v));
    const double off = dot(pca.mean, pca.normal);
    return pca.variance.x + off * off > scattered_ratio * scattered_ratio * pca.variance.y;
  }

  const Surface& surface_;
  SurfaceFans fans_;
  PointTree tree_;
  const Threads& threads_;
  std::vector<double> edge_, spacing_, height_, tolerance_;
};

/// The plausible part of the surface, for samples that are not on it.
class Target {
 public:
  Target(const Surface& surface, const Vertices& vertices, std::vector<std::uint8_t> plausible)
      : surface_(surface), vertices_(vertices), plausible_(std::move(plausible)) {
    const auto others = static_cast<std::size_t>(std::count(plausible_.begin(), plausible_.end(), 0));
    // A few are passed over in the search; the tree of all vertices is there already.
    if (static_cast<double>(others) <= few_implausible * static_cast<double>(plausible_.size())) return;
    for (std::uint32_t v = 0; v < plausible_.size(); ++v)
      if (plausible_[v]) {
        vertex_.push_back(v);
        place_.push_back(surface.mesh.vertices[v]);
      }
    tree_.emplace(place_);
  }

  struct Found {
    double distance = std::numeric_limits<double>::infinity();
    std::uint32_t vertex = 0; ///< nearest one
    std::array<std::uint32_t, 3> triangle{};
  };

  [[nodiscard]] Found nearest(const Vec3& p) const {
    std::array<std::uint32_t, vertices_searched> index{};
    std::array<double, vertices_searched> square{};
    const std::size_t wanted = tree_ ? vertices_looked_at : vertices_searched;
    const std::size_t found = (tree_ ? *tree_ : vertices_.tree()).nearest(p, wanted, index.data(), square.data());
    Found best;
    double to_vertex = 0;
    std::size_t looked_at = 0;
    for (std::size_t k = 0; k < found && looked_at < vertices_looked_at; ++k) {
      const std::uint32_t v = tree_ ? vertex_[index[k]] : index[k];
      if (!plausible_[v]) continue;
      if (looked_at++ == 0) {
        to_vertex = std::sqrt(square[k]);
        best = {to_vertex, v, {v, v, v}};
      }
      look_at(p, v, best);
    }
    best.distance = std::max(best.distance, to_vertex / reach_of_a_vertex);
    return best;
  }

  [[nodiscard]] bool is_plausible(std::uint32_t v) const { return plausible_[v] != 0; }

 private:
  [[nodiscard]] const Vec3& at(std::uint32_t v) const { return surface_.mesh.vertices[v]; }

  void look_at(const Vec3& p, std::uint32_t v, Found& best) const {
    for (const auto& [next, last] : vertices_.fans()[v]) {
      if (!plausible_[next] || !plausible_[last]) continue;
      const double d = distance(p, nearest_on_triangle({at(v), at(next), at(last)}, p));
      if (!(d < best.distance)) continue;
      best.distance = d;
      best.triangle = {v, next, last};
    }
  }

  const Surface& surface_;
  const Vertices& vertices_;
  std::vector<std::uint8_t> plausible_;
  std::vector<std::uint32_t> vertex_; ///< those in the tree
  std::vector<Vec3> place_;
  std::optional<PointTree> tree_; ///< of plausible vertices where many are not
};

} // namespace

Classification classify_samples(const Tetrahedralization& t, const Surface& surface,
                                std::span<const float> grid_spacing, const Threads& threads) {
  Classification result;
  result.inlier = IndexedArray<SampleIndex, std::uint8_t>(t.sample_count, 0);
  result.confidence = IndexedArray<SampleIndex, float>(t.sample_count, 0.0f);
  result.place = IndexedArray<SampleIndex, std::array<std::uint32_t, 3>>(t.sample_count);
  if (surface.mesh.triangles.empty()) return result;
  const Vertices vertices(surface, grid_spacing, threads);
  const Target target(surface, vertices, vertices.plausible());
  IndexedArray<SampleIndex, std::uint32_t> vertex_of(t.sample_count, SampleIndex::none);
  for (std::uint32_t v = 0; v < surface.sample_of.size(); ++v) vertex_of[surface.sample_of[v]] = v;
  for_each_index(
      threads, t.sample_count,
      [&](std::size_t i) {
        const SampleIndex s{static_cast<std::uint32_t>(i)};
        const std::uint32_t v = vertex_of[s];
        double deviation = 0, tolerance = 0;
        if (v != SampleIndex::none && target.is_plausible(v)) {
          deviation = vertices.height(v);
          tolerance = vertices.tolerance(v);
          result.place[s] = {v, v, v};
        } else {
          const Target::Found found = target.nearest(t.positions[s]);
          deviation = v == SampleIndex::none ? found.distance : std::max(found.distance, vertices.height(v));
          tolerance = Vertices::tolerance(vertices.spacing(found.vertex), grid_spacing, s);
          result.place[s] = found.triangle;
        }
        const double ratio = deviation / tolerance;
        result.confidence[s] = static_cast<float>(1 / (1 + ratio * ratio));
        result.inlier[s] = result.confidence[s] >= 0.5f;
      },
      costly_block);
  return result;
}

} // namespace eigencrust
