// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A cloud with what is known of it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <eigencrust/types.h>

#include "bodies.h"

namespace eigencrust::bench {

struct Scene {
  /// Samples of the surface first, then outliers.
  PointCloud cloud;
  /// How many rows are samples of the surface; 0: not known (real scans with strays).
  std::size_t true_samples = 0;
  /// Median distance of a true sample to its nearest other one, before any noise.
  double spacing = 0;
  Truth truth;
  /// Rows that follow each other along a sharp edge of the body; empty: it has none, or they were not sampled.
  std::vector<std::array<std::uint32_t, 2>> sharp_edges{};
  /// Rows [begin, end) of bodies without noise beside others that have some.
  std::vector<std::array<std::size_t, 2>> clean_rows{};
};

/// One of which every row is a sample of the true surface.
Scene clean_scene(std::vector<Vec3> samples, Truth truth, unsigned threads);

} // namespace eigencrust::bench
