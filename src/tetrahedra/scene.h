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

/// Where the samples came from, relative to the origin: some may be triangulated elsewhere, see eased_positions().
class SamplePlaces {
 public:
  /// \param scene of `cloud`; outlives this
  SamplePlaces(const Scene& scene, const PointCloud& cloud, const Threads& threads);
  /// One for each sample.
  [[nodiscard]] std::span<const Vec3> all() const { return all_; }

 private:
  std::vector<Vec3> own_; ///< where they differ from those that are triangulated
  std::span<const Vec3> all_;
};

} // namespace eigencrust
