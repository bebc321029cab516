// SPDX-License-Identifier: GPL-3.0-or-later
// Which samples may be outliers, and how far their neighbourhood reaches (not in the paper;
// docs/decisions/0013).
#include <algorithm>
#include <array>
#include <cmath>

#include <eigencrust/stages.h>

#include "geometry/local_pca.h"
#include "geometry/nearest.h"
#include "numerics/quantile.h"
#include "parallel/threads.h"
#include "samples/neighbourhoods.h"

namespace eigencrust {
namespace {

// A sample is isolated when its third nearest neighbour is farther than so many times the typical one ...
constexpr double isolation = 2.5;
// ... and its neighbourhood is not flat: its smallest deviation is more than so much of the second.
constexpr double flat_ratio = 0.4;
constexpr std::size_t neighbourhood = 20;

/// Distances to the third nearest other sample; those to the nearest go to `nearest`.
std::vector<float> third_nearest(const PointTree& tree, std::span<const Vec3> positions, std::vector<double>& nearest,
                                 const Threads& threads) {
  std::vector<float> third(positions.size());
  nearest.resize(positions.size());
  for_each_index(
      threads, positions.size(),
      [&](std::size_t i) {
        std::array<std::uint32_t, 4> index{};
        std::array<double, 4> square{};
        const std::size_t found = tree.nearest(positions[i], 4, index.data(), square.data());
        third[i] = static_cast<float>(std::sqrt(square[found - 1]));
        nearest[i] = std::sqrt(square[1]);
      },
      2048);
  return third;
}

bool is_flat(std::span<const Vec3> positions, std::span<const std::uint32_t> neighbours, const Vec3& origin) {
  const Vec3 variance = local_pca(positions, neighbours, origin).variance;
  return variance.x < flat_ratio * flat_ratio * variance.y;
}

} // namespace

Neighbourhoods sample_neighbourhoods(std::span<const Vec3> positions, const Threads& threads) {
  const PointTree tree(positions);
  Neighbourhoods result;
  std::vector<double> nearest;
  result.spacing = third_nearest(tree, positions, nearest, threads);
  result.nearest = median(nearest);
  std::vector<float> sorted = result.spacing;
  result.typical = static_cast<double>(median(sorted));
  const double limit = isolation * result.typical;
  result.isolated.assign(positions.size(), 0.0f);
  for_each_index(
      threads, positions.size(),
      [&](std::size_t i) {
        if (!(static_cast<double>(result.spacing[i]) > limit)) return;
        std::array<std::uint32_t, neighbourhood + 1> index{};
        std::array<double, neighbourhood + 1> square{};
        const std::size_t found = tree.nearest(positions[i], neighbourhood + 1, index.data(), square.data());
        if (is_flat(positions, std::span(index).first(found), positions[i])) return;
        result.isolated[i] = static_cast<float>(std::sqrt(square[found - 1]));
      },
      512);
  return result;
}

} // namespace eigencrust
