// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What the samples alone say.
#pragma once

#include <vector>

#include <eigencrust/stages.h>

#include "samples/neighbourhoods.h"
#include "samples/sample_model.h"

namespace eigencrust {

struct SampleMeasures {
  SampleModel model;
  Neighbourhoods around;
  std::vector<float> isolated;  ///< those of the model where the weights ask for them; else empty
  double scan_grid_spacing = 0; ///< the one ℓ that was given, or that of merged scans; 0: none
  /// ℓ of §3.3 at every sample: with the paper's weights the one of the scans, else 1.2 deviations of the noise; empty
  /// where there is none.
  std::vector<float> grid;
  /// How far each sample looks for its poles; 0 where the noise is below the spacing; empty: nowhere.
  std::vector<float> reach;
};

/// \param samples of `cloud`
SampleMeasures measure(const PointCloud& cloud, const Samples& samples, const Options& options, const Threads& threads);

} // namespace eigencrust
