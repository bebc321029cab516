// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What all later chapters look at: the samples, their tetrahedra, and what both say by themselves.
#pragma once

#include <eigencrust/stages.h>

#include "report/context.h"
#include "samples/measures.h"

namespace eigencrust {

struct Scene {
  Tetrahedralization tetrahedralization;
  std::vector<SampleIndex> sample_of_row; ///< of each row of the cloud, see Samples
  VertexStars stars;
  SampleMeasures measures;
  Poles poles;
};

/// §3. The stages samples, sample_model, delaunay, stars and poles.
/// \throws Error{input} where there are no tetrahedra
Scene make_scene(const PointCloud& cloud, const Context& context);

} // namespace eigencrust
