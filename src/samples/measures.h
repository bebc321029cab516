// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What the samples alone say.
#pragma once

#include <span>
#include <vector>

#include <eigencrust/stages.h>

#include "samples/sample_model.h"

namespace eigencrust {

struct SampleMeasures {
  SampleModel model;
  bool trusts_all = false;      ///< as the paper does: isolated samples are like all others
  double scan_grid_spacing = 0; ///< the one ℓ that was given, or that of merged scans; 0: none
  /// ℓ of §3.3 at every sample: with the paper's weights the one of the scans, else 1.2 deviations of the noise; empty
  /// where there is none.
  SampleLengths grid;

  /// Those of the model; empty where all are trusted.
  [[nodiscard]] SampleLengthsView isolated() const {
    return trusts_all ? SampleLengthsView() : SampleLengthsView(model.isolated);
  }
  /// Not 0 for samples with more noise than an eighth of their spacing; empty where all are trusted.
  [[nodiscard]] std::vector<std::uint8_t> noisy() const;
};

/// How far each sample looks for its poles; 0 where the noise is below the spacing; empty: nowhere.
SampleLengths reach_for_poles(const SampleMeasures& measures);

/// \param samples of `cloud`; where vertices of the mesh may move noisy ones are eased, see eased_positions()
SampleMeasures measure(const PointCloud& cloud, Samples& samples, const Options& options, const Threads& threads);

} // namespace eigencrust
