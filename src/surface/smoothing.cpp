// SPDX-License-Identifier: GPL-3.0-or-later
// §3.6: Laplacian smoothing, and Taubin's variant that does not shrink.
#include <algorithm>
#include <numeric>

#include <eigencrust/stages.h>

#include "parallel/threads.h"

namespace eigencrust {
namespace {

// Taubin, A signal processing approach to fair surface design (1995): pass band 1/λ + 1/μ = 0.1.
constexpr double taubin_lambda = 0.5;
constexpr double taubin_mu = -1 / (1 / taubin_lambda - 0.1);

/// Neighbours of every vertex (compressed rows, increasing); none for vertices of open edges, so that
/// boundaries stay.
struct Rings {
  std::vector<std::uint64_t> begin;
  std::vector<std::uint32_t> vertex;
};

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
  Rings rings;
  rings.begin.assign(mesh.vertices.size() + 1, 0);
  for (const auto& [u, v] : directed)
    if (!open[u]) {
      ++rings.begin[u + 1];
      rings.vertex.push_back(v);
    }
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) rings.begin[v + 1] += rings.begin[v];
  return rings;
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
      const std::uint64_t degree = rings.begin[v + 1] - rings.begin[v];
      Vec3 sum;
      for (std::uint64_t e = rings.begin[v]; e < rings.begin[v + 1]; ++e) sum = sum + mesh.vertices[rings.vertex[e]];
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
