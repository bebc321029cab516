// SPDX-License-Identifier: GPL-3.0-or-later
#include "reference_measures.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <eigencrust/error.h>
#include <eigencrust/metrics.h>

#include "registration.h"

namespace eigencrust::bench {
namespace {

constexpr std::size_t surface_samples = 100'000;

double share_within(const std::vector<double>& distances, double tolerance) {
  const auto within = std::count_if(distances.begin(), distances.end(), [&](double d) { return d <= tolerance; });
  return static_cast<double>(within) / static_cast<double>(distances.size());
}

/// Sets that grow together as the level sinks; each knows its highest vertex.
class Forest {
 public:
  explicit Forest(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0u); }
  std::uint32_t root(std::uint32_t v) {
    while (parent_[v] != v) v = parent_[v] = parent_[parent_[v]];
    return v;
  }
  void join(std::uint32_t root_below, std::uint32_t root_above) { parent_[root_below] = root_above; }

 private:
  std::vector<std::uint32_t> parent_;
};

} // namespace

void measure_patch(const Scene& scene, const TriangleMesh& mesh, unsigned threads, Figures& figures) {
  std::vector<Vec3> points = sample_surface(mesh, surface_samples, 3);
  const std::vector<double> gap =
      distances_to_points(points, std::span(scene.cloud.points).first(scene.true_samples), threads);
  std::vector<Vec3> patch;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (gap[i] > 3 * scene.spacing) patch.push_back(points[i]);
  Box3 box;
  for (const Vec3& p : scene.truth.mesh->vertices) box.add(p);
  const double q95 = patch.empty() ? 0 : summarize(distances_to_surface(patch, *scene.truth.mesh, threads)).q95;
  figures.set("patch_area", static_cast<double>(patch.size()) / static_cast<double>(points.size()));
  figures.set("patch_q95_of_diagonal", q95 / box.diagonal());
}

void measure_tolerance(const TriangleMesh& mesh, const TriangleMesh& reference, double tolerance, unsigned threads,
                       Figures& figures) {
  const auto share = [&](const TriangleMesh& from, const TriangleMesh& to, std::uint64_t seed) {
    return share_within(distances_to_surface(sample_surface(from, surface_samples, seed), to, threads), tolerance);
  };
  figures.set("within_tolerance_of_reference", share(mesh, reference, 4));
  figures.set("reference_within_tolerance", share(reference, mesh, 5));
}

std::vector<std::uint32_t> peaks(const TriangleMesh& mesh, const Vec3& up, std::size_t count) {
  const auto n = static_cast<std::uint32_t>(mesh.vertices.size());
  std::vector<double> height(n);
  for (std::uint32_t v = 0; v < n; ++v) height[v] = dot(mesh.vertices[v], up);
  std::vector<std::uint32_t> order(n), rank(n);
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return height[a] > height[b]; });
  for (std::uint32_t i = 0; i < n; ++i) rank[order[i]] = i;
  // Edges by their lower end: as the level sinks to it, the two sides meet.
  std::vector<std::array<std::uint32_t, 2>> edges; // rank of the lower end, upper end
  for (const auto& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k], b = t[(k + 1) % 3];
      edges.push_back({std::max(rank[a], rank[b]), rank[a] < rank[b] ? a : b});
    }
  std::sort(edges.begin(), edges.end());

  std::vector<std::pair<double, std::uint32_t>> found; // -prominence, vertex
  Forest forest(n);                                    // the root of a set is its highest vertex
  for (const auto& [lower_rank, upper] : edges) {
    const std::uint32_t lower = order[lower_rank];
    std::uint32_t a = forest.root(lower), b = forest.root(upper);
    if (a == b) continue;
    if (rank[a] < rank[b]) std::swap(a, b); // b is the higher one
    if (height[a] > height[lower]) found.emplace_back(height[lower] - height[a], a);
    forest.join(a, b);
  }
  if (n > 0) found.emplace_back(-std::numeric_limits<double>::infinity(), order[0]);
  std::sort(found.begin(), found.end());
  found.resize(std::min(found.size(), count));
  std::vector<std::uint32_t> tops;
  for (const auto& peak : found) tops.push_back(peak.second);
  std::sort(tops.begin(), tops.end(), [&](auto a, auto b) { return rank[a] < rank[b]; });
  return tops;
}

void measure_tips(const TriangleMesh& mesh, const TriangleMesh& reference, double radius, double unit, unsigned threads,
                  Figures& figures) {
  int number = 0;
  for (const std::uint32_t top : peaks(reference, {0, 1, 0}, 2)) {
    std::vector<Vec3> tip;
    for (const Vec3& p : reference.vertices)
      if (distance(p, reference.vertices[top]) <= radius) tip.push_back(p);
    figures.set("tip_" + std::to_string(++number), unit * summarize(distances_to_surface(tip, mesh, threads)).max);
  }
}

void measure_against_model(const TriangleMesh& mesh, const TriangleMesh& model, double unit, unsigned threads,
                           Figures& figures) {
  const Similarity fit = lay_onto(model, mesh, threads);
  TriangleMesh laid = model;
  for (Vec3& p : laid.vertices) p = fit.apply(p);
  const DistanceStatistics to =
      summarize(distances_to_surface(sample_surface(mesh, surface_samples, 6), laid, threads));
  const DistanceStatistics of_vertices = summarize(distances_to_surface(mesh.vertices, laid, threads));
  const DistanceStatistics from =
      summarize(distances_to_surface(sample_surface(laid, surface_samples, 7), mesh, threads));
  figures.set("fitted_scale", fit.scale);
  figures.set("model_mean", unit * to.mean);
  figures.set("model_q99", unit * to.q99);
  figures.set("model_max", unit * std::max(to.max, of_vertices.max));
  figures.set("model_from_q99", unit * from.q99);
  figures.set("model_from_max", unit * from.max);
}

} // namespace eigencrust::bench
