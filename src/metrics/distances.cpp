// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

#include <eigencrust/error.h>
#include <eigencrust/metrics.h>

#include "geometry/nearest.h"
#include "parallel/threads.h"

namespace eigencrust {
namespace {

/// Value at q of sorted values, linear between neighbours.
double quantile(const std::vector<double>& sorted, double q) {
  const double place = q * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  if (below + 1 >= sorted.size()) return sorted.back();
  return sorted[below] + (place - static_cast<double>(below)) * (sorted[below + 1] - sorted[below]);
}

} // namespace

DistanceStatistics summarize(std::vector<double> distances) {
  std::erase_if(distances, [](double d) { return !std::isfinite(d); });
  DistanceStatistics s;
  s.count = distances.size();
  if (distances.empty()) return s;
  std::sort(distances.begin(), distances.end());
  const double n = static_cast<double>(distances.size());
  s.max = distances.back();
  s.mean = std::accumulate(distances.begin(), distances.end(), 0.0) / n;
  s.rms = std::sqrt(std::inner_product(distances.begin(), distances.end(), distances.begin(), 0.0) / n);
  s.median = quantile(distances, 0.5);
  s.q90 = quantile(distances, 0.9);
  s.q95 = quantile(distances, 0.95);
  s.q99 = quantile(distances, 0.99);
  return s;
}

std::vector<double> distances_to_surface(std::span<const Vec3> points, const TriangleMesh& mesh, unsigned threads) {
  const TriangleTree tree(mesh);
  std::vector<double> result(points.size());
  for_each_index(
      Threads(threads), points.size(), [&](std::size_t i) { result[i] = tree.nearest(points[i]).distance; },
      costly_block);
  return result;
}

std::vector<double> distances_to_points(std::span<const Vec3> points, std::span<const Vec3> targets, unsigned threads) {
  std::vector<Vec3> finite;
  finite.reserve(targets.size());
  std::copy_if(targets.begin(), targets.end(), std::back_inserter(finite), [](const Vec3& p) { return is_finite(p); });
  if (finite.empty())
    throw Error(ErrorKind::input, "distances to points", "there is no finite target point", "give some points");
  const PointTree tree(finite);
  std::vector<double> result(points.size());
  const auto query = [&](std::size_t i) {
    if (!is_finite(points[i])) {
      result[i] = std::numeric_limits<double>::quiet_NaN();
      return;
    }
    std::uint32_t nearest = 0;
    double squared = 0;
    tree.nearest(points[i], 1, &nearest, &squared);
    result[i] = std::sqrt(squared);
  };
  for_each_index(Threads(threads), points.size(), query, costly_block);
  return result;
}

} // namespace eigencrust
