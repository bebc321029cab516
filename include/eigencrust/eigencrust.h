// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The one call: points in, closed manifold mesh out.
#pragma once

#include <vector>

#include <eigencrust/error.h>
#include <eigencrust/observer.h>
#include <eigencrust/options.h>
#include <eigencrust/ranks.h>
#include <eigencrust/report.h>
#include <eigencrust/types.h>

namespace eigencrust {

/// MAJOR.MINOR.PATCH; typed once, in CMakeLists.txt.
const char* version();

/// What a reconstruction gives.
struct Result {
  /// Vertices are input points bit for bit (unless moved, Options::surface and smooth), with all their attributes and
  /// `source_index`, the row in the input.
  TriangleMesh mesh;
  Report report;                         ///< what was done and found
  Tetrahedralization tetrahedralization; ///< the Delaunay tetrahedra; empty where a Session has them
  Labels labels;                         ///< of every tetrahedron, as the surface was taken from them
  // With options.point_results one entry per input row (duplicates have that of their first row), else empty:
  std::vector<std::uint8_t> inlier; ///< 1: the row is a sample of the surface; 0 for rows that are not finite
  std::vector<float> confidence;    ///< in [0, 1], at least 0.5 for inliers; 0 for rows that are not finite
  std::vector<Vec3> normals;        ///< unit, outward (before smoothing); NaN for rows that are no inliers
};

/// Reconstructs the surface that `cloud` was sampled from.
///
/// Guarantees: the mesh is closed, and with options.manifold every edge belongs to exactly two triangles
/// and every vertex to one fan (manifold); otherwise an edge may belong to any even number of triangles; triangles are
/// counter-clockwise seen from outside; vertices are distinct points. The mesh is checked; what does not hold (a fault
/// of the program) is named in report.broken_guarantees. Exceptions: options.facade leaves the mesh open. The result
/// depends on the set of points and the options alone, not on the order of the rows (but for source_index of
/// duplicates: the smallest row) nor on the number of threads.
///
/// \param ranks processes that take over parts of the work; none: this one does all
/// \throws Error{usage}      options out of range
///         Error{input}      fewer than 5 distinct finite points, all coplanar or collinear, mismatched arrays
///         Error{no_surface} the labels leave no surface
///         Error{cancelled}  the observer asked for it
///         Error{memory}     the forecast of memory exceeds options.max_memory
///         std::bad_alloc    memory exhausted
Result reconstruct(const PointCloud& cloud, const Options& options = {}, Observer& observer = *default_observer(),
                   Ranks* ranks = nullptr);

} // namespace eigencrust
