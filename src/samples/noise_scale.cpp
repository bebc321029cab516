// SPDX-License-Identifier: GPL-3.0-or-later
// How noisy the samples are, from the samples alone (not in the paper; docs/decisions/0012).
#include <algorithm>
#include <cmath>

#include <eigencrust/stages.h>

#include "geometry/local_pca.h"
#include "geometry/nearest.h"
#include "numerics/quantile.h"
#include "parallel/threads.h"
#include "samples/noise_scale.h"

namespace eigencrust {
namespace {

// Neighbourhoods grow threefold in number, about 1.7-fold in radius on a surface.
constexpr std::array<std::size_t, 6> sizes{10, 30, 90, 270, 810, 2430};
// A neighbourhood is wider than the noise is thick when its second deviation is twice the smallest.
constexpr double flat_ratio = 0.5;
// Neighbourhoods that are not flat must fit so many times into the cloud.
constexpr std::size_t least_neighbourhoods = 20;
// One estimate stands for so many samples along the Hilbert curve.
constexpr std::uint32_t samples_per_estimate = 64;
constexpr std::uint32_t max_estimates = 4000;
constexpr std::size_t smoothing_neighbours = 48;
constexpr double smoothing_quantile = 0.75;

struct Spread {
  double thickness = 0;      ///< smallest standard deviation
  double second = 0;         ///< second smallest
  double squared_radius = 0; ///< sum of the two larger variances
};

Spread spread_of(std::span<const Vec3> positions, std::span<const std::uint32_t> neighbours, const Vec3& origin) {
  const Vec3 variance = local_pca(positions, neighbours, origin).variance;
  return {std::sqrt(variance.x), std::sqrt(variance.y), variance.y + variance.z};
}

/// Thickness that does not grow with the neighbourhood is noise. Two neighbourhoods, the first one flat,
/// are fitted by thickness² = σ² + c radius²: a crease has c > 0 and σ = 0, a smooth surface grows even
/// faster and gives σ = 0 too.
double noise_at(const PointTree& tree, std::span<const Vec3> positions, const Vec3& query) {
  std::vector<std::uint32_t> index;
  std::vector<double> square;
  std::size_t found = 0;
  const auto spread = [&](std::size_t level) {
    const std::size_t wanted = sizes[level];
    if (found < wanted && found == index.size()) {
      index.resize(wanted);
      square.resize(wanted);
      found = tree.nearest(query, wanted, index.data(), square.data());
    }
    return spread_of(positions, std::span(index).first(std::min(wanted, found)), query);
  };
  Spread inner = spread(0);
  for (std::size_t level = 0; level + 1 < sizes.size(); ++level) {
    const Spread outer = spread(level + 1);
    const bool is_flat = inner.thickness < flat_ratio * inner.second;
    // A neighbourhood that makes up much of the cloud is as thick as the object, not as its noise.
    if (!is_flat && sizes[level + 1] * least_neighbourhoods > positions.size()) return 0;
    if (is_flat || level + 2 == sizes.size()) {
      const double growth = outer.squared_radius - inner.squared_radius;
      const double slope =
          growth > 0 ? std::max(0.0, (outer.thickness * outer.thickness - inner.thickness * inner.thickness) / growth)
                     : 0.0;
      return std::sqrt(std::max(0.0, inner.thickness * inner.thickness - slope * inner.squared_radius));
    }
    inner = outer;
  }
  return 0;
}

} // namespace

IndexedArray<SampleIndex, float> noise_scale(const Samples& samples, std::span<const float> isolated,
                                             const Threads& threads) {
  // Outliers fill space: beside them no neighbourhood is flat, and every one reads as noise.
  std::vector<Vec3> positions;
  positions.reserve(samples.positions.size());
  std::vector<std::uint32_t> kept_before(samples.positions.size());
  for (std::uint32_t i = 0; i < samples.positions.size(); ++i) {
    kept_before[i] = static_cast<std::uint32_t>(positions.size());
    if (isolated.empty() || !(isolated[i] > 0)) positions.push_back(samples.positions.raw()[i]);
  }
  const auto n = static_cast<std::uint32_t>(positions.size());
  IndexedArray<SampleIndex, float> scale(samples.positions.size());
  if (n == 0) return scale;
  const std::uint32_t stride = std::max(samples_per_estimate, (n + max_estimates - 1) / max_estimates);
  const std::uint32_t estimates = (n + stride - 1) / stride;
  const auto representative = [&](std::size_t e) {
    return positions[std::min<std::size_t>(n - 1, e * stride + stride / 2)];
  };
  std::vector<Vec3> places(estimates);
  std::vector<double> raw(estimates), smooth(estimates);
  const PointTree tree(positions);
  for_each_index(
      threads, estimates,
      [&](std::size_t e) {
        places[e] = representative(e);
        raw[e] = noise_at(tree, positions, places[e]);
      },
      32);
  std::vector<double> sorted = raw;
  const double typical = quantile(sorted, 0.5);
  // The upper quartile over neighbouring places: curved spots, where nothing is told from curvature, must
  // not read as free of noise, and outliers must not set the scale.
  const PointTree coarse(places);
  for_each_index(
      threads, estimates,
      [&](std::size_t e) {
        std::array<std::uint32_t, smoothing_neighbours> index{};
        std::array<double, smoothing_neighbours> square{};
        const std::size_t found = coarse.nearest(places[e], smoothing_neighbours, index.data(), square.data());
        std::vector<double> around;
        for (std::size_t k = 0; k < found; ++k) around.push_back(raw[index[k]]);
        smooth[e] = std::max(typical, quantile(around, smoothing_quantile));
      },
      256);
  for_each_index(threads, scale.size(), [&](std::size_t i) {
    scale.raw()[i] = static_cast<float>(smooth[std::min(kept_before[i], n - 1) / stride]);
  });
  return scale;
}

} // namespace eigencrust
