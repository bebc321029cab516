// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A cloud with what is known of it.
#pragma once

#include <cstddef>

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
};

} // namespace eigencrust::bench
