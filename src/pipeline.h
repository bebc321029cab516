// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The two halves of the method: what a Session keeps, and what it does again for other points.
#pragma once

#include <functional>

#include <eigencrust/eigencrust.h>
#include <eigencrust/stages.h>
#include <eigencrust/validate.h>

#include "run.h"

namespace eigencrust {

/// What is known beforehand of each tetrahedron: from the cube and the user, and with the lines of sight.
struct Known {
  Labels named, labels;
};

/// Up to the first partition (§3.1, §3.2).
struct FirstHalf {
  Neighbourhoods around;
  std::vector<float> grid, reach; ///< per sample: ℓ, and how far it looks for its poles; may be empty
  Tetrahedralization t;
  VertexStars stars;
  Poles poles;
  Known known;
  SightCrossings crossings;
  std::vector<std::uint8_t> questionable;
  PoleGraph graph;
  std::vector<std::uint32_t> component; ///< of each node
  Partition first;

  /// Neighbourhoods::isolated where it counts.
  [[nodiscard]] std::span<const float> isolated(const Options& options) const {
    return options.weights == Weights::evidence ? std::span<const float>(around.isolated) : std::span<const float>{};
  }
};
FirstHalf first_half(const PointCloud& cloud, const Options& options, Run& run, Report& report, const Threads& threads);

/// §3.4, or what stands for it.
using SecondSolve = std::function<Partition(const TetrahedronGraph&)>;

/// From the labels of the poles to the finished mesh; fills result.mesh, labels and report, and point results.
void second_half(const PointCloud& cloud, const FirstHalf& half, const Known& known, const Partition& first,
                 const SecondSolve& solve, const ValidateOptions& checks, Run& run, Result& result,
                 const Threads& threads);

} // namespace eigencrust
