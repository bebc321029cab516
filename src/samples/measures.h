// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What the samples alone say.
#pragma once

#include <vector>

#include <eigencrust/stages.h>

#include "samples/neighbourhoods.h"

namespace eigencrust {

struct SampleMeasures {
  Neighbourhoods around;
  std::vector<float> isolated;  ///< those of `around` where the weights ask for them; else empty
  double scan_grid_spacing = 0; ///< the one ℓ that was given, or that of merged scans; 0: none
  /// ℓ of §3.3 at every sample: the one given, else from the noise measured at each sample or, without
  /// local_noise, the one of merged scans; empty where there is none.
  std::vector<float> grid;
  std::vector<float>
      reach; ///< how far each sample looks for its poles; 0 where the noise is below the spacing; empty: nowhere
};

/// Sets around and isolated.
void measure_neighbourhoods(const Samples& samples, const Options& options, const Threads& threads,
                            SampleMeasures& measures);
/// Sets the others; expects those two.
void measure_noise(const PointCloud& cloud, const Samples& samples, const Options& options, const Threads& threads,
                   SampleMeasures& measures);

} // namespace eigencrust
