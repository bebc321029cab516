// SPDX-License-Identifier: GPL-3.0-or-later
#include "degradations.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "counter_random.h"

namespace eigencrust::bench {
namespace {

using tools::CounterRandom;

/// Which random numbers serve what: one trouble more does not change the numbers of the others.
enum Stream : std::uint64_t { stream_outlier = 1, stream_cluster, stream_noise, stream_scan };

Vec3 uniform_in(const Box3& box, double factor, const CounterRandom& random) {
  const Vec3 half = 0.5 * factor * (box.max - box.min);
  const Vec3 t{2 * random.uniform(0) - 1, 2 * random.uniform(1) - 1, 2 * random.uniform(2) - 1};
  return box.centre() + Vec3{half.x * t.x, half.y * t.y, half.z * t.z};
}

Vec3 normal_vector(const CounterRandom& random, std::uint64_t draw) {
  return {random.normal(draw), random.normal(draw + 2), random.normal(draw + 4)};
}

/// Uniform on the unit sphere (Archimedes: heights are uniform).
Vec3 unit_vector(const CounterRandom& random, std::uint64_t draw) {
  const double z = 2 * random.uniform(draw) - 1, u = 2 * std::numbers::pi * random.uniform(draw + 1);
  const double ring = std::sqrt(std::max(0.0, 1 - z * z));
  return {ring * std::cos(u), ring * std::sin(u), z};
}

} // namespace

std::vector<Vec3> outliers(std::span<const Vec3> samples, std::size_t count, const Outliers& options,
                           std::uint64_t seed) {
  constexpr std::size_t clusters = 20;
  constexpr double cluster_sigma = 0.02, shell_inner = 1.1, shell_outer = 1.3;
  Box3 box;
  for (const Vec3& p : samples) box.add(p);
  double radius = 0;
  for (const Vec3& p : samples) radius = std::max(radius, distance(p, box.centre()));

  std::vector<Vec3> points;
  points.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const CounterRandom random(seed, stream_outlier, i);
    switch (options.place) {
      case OutlierPlace::box:
        points.push_back(uniform_in(box, options.factor, random));
        break;
      case OutlierPlace::clusters:
        points.push_back(uniform_in(box, options.factor, CounterRandom(seed, stream_cluster, i % clusters)) +
                         cluster_sigma * box.diagonal() * normal_vector(random, 0));
        break;
      case OutlierPlace::shell: { // the cube of the radius is uniform
        const double low = std::pow(shell_inner, 3), high = std::pow(shell_outer, 3);
        const double r = radius * std::cbrt(low + (high - low) * random.uniform(2));
        points.push_back(box.centre() + r * unit_vector(random, 0));
        break;
      }
    }
  }
  return points;
}

void add_outliers(Scene& scene, const Outliers& options, std::uint64_t seed) {
  std::vector<Vec3>& points = scene.cloud.points;
  const auto count = static_cast<std::size_t>(std::llround(options.share * static_cast<double>(scene.true_samples)));
  const std::vector<Vec3> added = outliers(std::span(points).first(scene.true_samples), count, options, seed);
  points.insert(points.end(), added.begin(), added.end());
}

void add_noise(std::vector<Vec3>& points, double sigma, std::uint64_t seed) {
  for (std::size_t i = 0; i < points.size(); ++i)
    points[i] = points[i] + sigma * normal_vector(CounterRandom(seed, stream_noise, i), 0);
}

std::vector<std::uint32_t> rows_before_cut(std::span<const Vec3> points, std::span<const double> weights,
                                           const Vec3& direction, double share) {
  const auto weight = [&](std::uint32_t row) { return weights.empty() ? 1.0 : weights[row]; };
  std::vector<std::uint32_t> rows(points.size());
  std::iota(rows.begin(), rows.end(), 0u);
  std::stable_sort(rows.begin(), rows.end(), [&](std::uint32_t a, std::uint32_t b) {
    return dot(points[a], direction) < dot(points[b], direction);
  });
  double total = 0;
  for (const std::uint32_t row : rows) total += weight(row);
  for (double gone = 0; !rows.empty() && gone < share * total; rows.pop_back()) gone += weight(rows.back());
  std::sort(rows.begin(), rows.end());
  return rows;
}

void displace_scans(std::vector<Vec3>& points, std::span<const std::uint32_t> scan_index, double length,
                    std::uint64_t seed) {
  for (std::size_t i = 0; i < points.size(); ++i)
    points[i] = points[i] + length * unit_vector(CounterRandom(seed, stream_scan, scan_index[i]), 0);
}

} // namespace eigencrust::bench
