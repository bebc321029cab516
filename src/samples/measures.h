// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What the samples alone say, measured while they are triangulated.
#pragma once

#include <vector>

#include <eigencrust/stages.h>

#include "report/run.h"

namespace eigencrust {

struct SampleMeasures {
  Neighbourhoods around;
  std::vector<float> isolated; ///< those of `around` where the weights ask for them; else empty
  /// ℓ of §3.3 at every sample: the one given, else from the noise measured at each sample or, without
  /// local_noise, the one of merged scans; empty where there is none.
  std::vector<float> grid;
  std::vector<float>
      reach; ///< how far each sample looks for its poles; 0 where the noise is below the spacing; empty: nowhere
};

/// The stages delaunay, neighbourhoods and noise. The first keeps one thread busy; the others run beside it
/// where there are more. Sets spacing and grid_spacing of the report.
Tetrahedralization triangulate_and_measure(const PointCloud& cloud, Samples samples, Run& run, Report& report,
                                           const Threads& threads, SampleMeasures& measures);

} // namespace eigencrust
