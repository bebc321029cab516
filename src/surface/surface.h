// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// From labels to the mesh.
#pragma once

#include <eigencrust/stages.h>
#include <eigencrust/validate.h>

#include "evidence/evidence.h"
#include "settle/overlaps.h"

namespace eigencrust {

/// A scrap is no success: of so many samples some must lie on the surface, or as near as noise and spacing explain.
constexpr double least_share_on_surface = 0.05;

/// Samples that the surface leaves alone though neither noise nor loneliness nor overlapping parts explain it.
struct SamplesApart {
  /// Neither lonely nor noisy nor at an overlap, and neither on the surface nor beside a neighbour that is.
  std::uint64_t apart = 0;
  std::uint64_t in_company = 0; ///< of these: most of their neighbours are too, as in a part that was left out
  std::uint64_t all = 0;
};

/// §3. The stages surface, support, components and trim.
/// \throws Error{no_surface}
Surface make_surface(const PointCloud& cloud, const Scene& scene, const Evidence& evidence,
                     const TetrahedronLabels& labels, const Overlaps& overlaps, const Context& context);

/// The vertices where the options want them (§3.6). The stages fit, smoothing, attributes and crossings.
TriangleMesh finish(Surface surface, const PointCloud& cloud, const Scene& scene, const Context& context);

/// The stage validate: what the mesh is, and whether it is what the options promise.
void check(const TriangleMesh& mesh, const PointCloud& cloud, const Scene& scene, const ValidateOptions& checks,
           const Context& context);

} // namespace eigencrust
