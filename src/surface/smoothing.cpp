// SPDX-License-Identifier: GPL-3.0-or-later
// §3.6: Laplacian smoothing, and Taubin's variant that does not shrink.
#include <algorithm>
#include <numeric>

#include <eigencrust/stages.h>

#include "parallel/compressed_rows.h"

namespace eigencrust {
namespace {

// Taubin, A signal processing approach to fair surface design (1995): pass band 1/λ + 1/μ = 0.1.
constexpr double taubin_lambda = 0.5;
constexpr double taubin_mu = -1 / (1 / taubin_lambda - 0.1);

using Rings = CompressedRows<std::uint32_t>;

/// Neighbours of every vertex, increasing; none for vertices of open edges, so that boundaries stay.
Rings rings_of(const TriangleMesh& mesh) {
  std::vector<std::array<std::uint32_t, 2>> directed;
  directed.reserve(6 * mesh.triangles.size());
  for (const auto& [a, b, c] : mesh.triangles)
    for (const auto& [u, v] : {std::pair{a, b}, std::pair{b, c}, std::pair{c, a}}) {
      directed.push_back({u, v});
      directed.push_back({v, u});
    }
  std::sort(directed.begin(), directed.end());
  std::vector<std::uint8_t> open(mesh.vertices.size(), 0);
  for (std::size_t i = 0; i < directed.size();) {
    std::size_t j = i;
    while (j < directed.size() && directed[j] == directed[i]) ++j;
    if (j - i == 1) open[directed[i][0]] = 1; // an edge of one triangle appears once each way
    i = j;
  }
  directed.erase(std::unique(directed.begin(), directed.end()), directed.end());
  return build_rows<std::uint32_t>(mesh.vertices.size(), [&](auto&& visit) {
    for (const auto& [u, v] : directed)
      if (!open[u]) visit(u, v);
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
  const Rings rings = rings_of(mesh);
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
