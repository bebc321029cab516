// SPDX-License-Identifier: GPL-3.0-or-later
#include "surface_error.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <eigencrust/metrics.h>

#include "geometry/mesh_topology.h"
#include "parallel/threads.h"

namespace eigencrust::bench {
namespace {

constexpr std::size_t surface_samples = 100'000;

struct Sums {
  double distance = 0, angle = 0;
  Sums operator+(const Sums& o) const { return {distance + o.distance, angle + o.angle}; }
};

double angle_between(const Vec3& a, const Vec3& b) {
  return std::atan2(norm(cross(a, b)), dot(a, b)) * 180 / std::numbers::pi;
}

/// Means over points spread over `from`.
Sums one_way(const TriangleMesh& from, const TriangleMesh& to, std::uint64_t seed, unsigned threads) {
  std::vector<std::uint32_t> triangle_of;
  const std::vector<Vec3> points = sample_surface(from, surface_samples, seed, &triangle_of);
  const TriangleTree tree(to);
  const Sums sums = sum_blocks<Sums>(
      Threads(threads), points.size(),
      [&](std::size_t begin, std::size_t end) {
        Sums sum;
        for (std::size_t i = begin; i < end; ++i) {
          const TriangleTree::Nearest nearest = tree.nearest(points[i]);
          sum = sum + Sums{nearest.distance,
                           angle_between(area_vector(from, triangle_of[i]), area_vector(to, nearest.triangle))};
        }
        return sum;
      },
      1024);
  const auto count = static_cast<double>(points.size());
  return {sums.distance / count, sums.angle / count};
}

} // namespace

SurfaceError surface_error(const TriangleMesh& mesh, const TriangleMesh& truth, unsigned threads) {
  const Sums to = one_way(mesh, truth, 1, threads), from = one_way(truth, mesh, 2, threads);
  return {to.distance, from.distance, (to.angle + from.angle) / 2};
}

} // namespace eigencrust::bench
