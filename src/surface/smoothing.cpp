// SPDX-License-Identifier: GPL-3.0-or-later
// §3.6: Laplacian smoothing, and Taubin's variant that does not shrink.
#include <algorithm>
#include <numeric>

#include <eigencrust/stages.h>

#include "geometry/mesh_topology.h"
#include "parallel/compressed_rows.h"

namespace eigencrust {
namespace {

// Taubin, A signal processing approach to fair surface design (1995): pass band 1/λ + 1/μ = 0.1.
constexpr double taubin_lambda = 0.5;
constexpr double taubin_mu = -1 / (1 / taubin_lambda - 0.1);

using Rings = CompressedRows<std::uint32_t>;

/// Neighbours of every vertex, increasing; none for vertices of open edges, so that boundaries stay.
Rings rings_of(const TriangleMesh& mesh, const Threads& threads) {
  const std::vector<Side> sides = sorted_sides(mesh.triangles, mesh.vertices.size(), threads);
  std::vector<std::uint8_t> open(mesh.vertices.size(), 0);
  for_each_edge(sides, [&](std::span<const Side> edge) {
    if (edge.size() == 1) open[edge[0].low] = open[edge[0].high] = 1;
  });
  return build_rows<std::uint32_t>(mesh.vertices.size(), [&](auto&& visit) {
    for_each_edge(sides, [&](std::span<const Side> edge) {
      const auto [low, high, number, forward] = edge[0];
      if (!open[low]) visit(low, high);
      if (!open[high]) visit(high, low);
    });
  });
}

/// Vertices that a step moved onto one point (the tips of a bipyramid) go back to where they were: merged by
/// a reader they would be no manifold.
void part_equal_vertices(std::vector<Vec3>& vertices, const std::vector<Vec3>& before) {
  std::vector<std::uint32_t> order(vertices.size());
  std::iota(order.begin(), order.end(), 0u);
  for (int round = 0; round < 4; ++round) {
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
      return vertices[a] < vertices[b] || (vertices[a] == vertices[b] && a < b);
    });
    std::vector<std::uint32_t> equal;
    for (std::size_t i = 1; i < order.size(); ++i)
      if (vertices[order[i]] == vertices[order[i - 1]]) {
        equal.push_back(order[i - 1]);
        equal.push_back(order[i]);
      }
    if (equal.empty()) return;
    for (const std::uint32_t v : equal) vertices[v] = before[v];
  }
}

} // namespace

void smooth(TriangleMesh& mesh, Smoothing method, std::uint32_t steps, const Threads& threads) {
  if (steps == 0) return;
  const Rings rings = rings_of(mesh, threads);
  std::vector<Vec3> moved(mesh.vertices.size());
  const auto move_towards_centroids = [&](double factor) {
    for_each_index(threads, mesh.vertices.size(), [&](std::size_t v) {
      const std::size_t degree = rings[v].size();
      Vec3 sum;
      for (const std::uint32_t u : rings[v]) sum = sum + mesh.vertices[u];
      const Vec3& old = mesh.vertices[v];
      moved[v] = degree == 0 ? old : old + factor * ((1.0 / static_cast<double>(degree)) * sum - old);
    });
    mesh.vertices.swap(moved);
    part_equal_vertices(mesh.vertices, moved);
  };
  for (std::uint32_t step = 0; step < steps; ++step) {
    if (method == Smoothing::laplacian)
      move_towards_centroids(1);
    else {
      move_towards_centroids(taubin_lambda);
      move_towards_centroids(taubin_mu);
    }
  }
}

} // namespace eigencrust
