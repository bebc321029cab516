// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What goes wrong with clouds: outliers, noise, missing parts, scans that do not fit together. Random numbers
/// depend on the seed and the row alone.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <eigencrust/types.h>

#include "scene.h"

namespace eigencrust::bench {

enum class OutlierPlace : std::uint8_t {
  box,      ///< uniform in the samples' bounding box grown by `factor` about its centre
  clusters, ///< 20 Gaussian clusters, sigma 2 % of the diagonal, centres uniform in the box grown by `factor`
  shell     ///< uniform between 1.1 and 1.3 times the sphere around the box's centre that holds all samples
};
struct Outliers {
  double share = 0; ///< of the number of samples
  OutlierPlace place = OutlierPlace::box;
  double factor = 1.2;
};

/// `count` outliers for these samples.
std::vector<Vec3> outliers(std::span<const Vec3> samples, std::size_t count, const Outliers& options,
                           std::uint64_t seed);
/// Appends round(share · samples) of them to the cloud.
void add_outliers(Scene& scene, const Outliers& options, std::uint64_t seed);

/// Every coordinate moved by a normal deviate of that standard deviation.
void add_noise(std::vector<Vec3>& points, double sigma, std::uint64_t seed);

/// Rows that stay when a plane across `direction` cuts off the far end that holds `share` of the weight;
/// increasing. Weights are areas of vertices; empty: all alike.
std::vector<std::uint32_t> rows_before_cut(std::span<const Vec3> points, std::span<const double> weights,
                                           const Vec3& direction, double share);

/// Every scan moved by `length` in a random direction.
/// \param scan_index number of the scan of each point
void displace_scans(std::vector<Vec3>& points, std::span<const std::uint32_t> scan_index, double length,
                    std::uint64_t seed);

} // namespace eigencrust::bench
