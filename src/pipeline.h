// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The two halves of the method: what a Session keeps, and what it does again for other points.
#pragma once

#include <functional>

#include <eigencrust/eigencrust.h>
#include <eigencrust/stages.h>
#include <eigencrust/validate.h>

#include "report/run.h"
#include "samples/measures.h"

namespace eigencrust {

/// What is known beforehand of each tetrahedron: from the cube and the user, and with the lines of sight.
struct Known {
  Labels named, labels;
};

/// Up to the first partition (§3.1, §3.2).
struct FirstHalf {
  SampleMeasures measures;
  Tetrahedralization t;
  VertexStars stars;
  Poles poles;
  Known known;
  SightCrossings crossings;
  std::vector<std::uint8_t> questionable;
  PoleGraph graph;
  std::vector<std::uint32_t> component; ///< of each node
  Partition first;
};
FirstHalf first_half(const PointCloud& cloud, const Options& options, Run& run, Report& report, const Threads& threads);

/// §3.4, or what stands for it. May take the edges.
using SecondSolve = std::function<Partition(TetrahedronGraph&)>;

/// From the labels of the poles to the finished mesh; fills result.mesh, labels and report, and point results.
/// \param spendable the same first half where nobody needs it any more: what is over is freed; else null
void second_half(const PointCloud& cloud, const FirstHalf& half, FirstHalf* spendable, const Known& known,
                 const Partition& first, const SecondSolve& solve, const ValidateOptions& checks, Run& run,
                 Result& result, const Threads& threads);

} // namespace eigencrust
