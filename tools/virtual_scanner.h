// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A range scanner that does not exist: it looks at a mesh and returns the cloud a real one would.
#pragma once

#include <cstdint>
#include <vector>

#include <eigencrust/types.h>

#include "sensors.h"

namespace eigencrust::tools {

enum class OutlierKind : std::uint8_t {
  box, ///< uniform in the object's bounding box grown by outlier_box about its centre
  ray  ///< uniform on the ray between sensor and surface
};

/// What the scanner gets wrong. Lengths are in the unit of the mesh.
struct ScanOptions {
  double range_noise = 0;       ///< standard deviation of the range, >= 0
  double isotropic_noise = 0;   ///< standard deviation of each coordinate, >= 0
  double range_quantum = 0;     ///< ranges are rounded to multiples of it; 0: not at all
  double max_incidence = 90;    ///< degrees between ray and surface normal beyond which nothing returns, (0, 90]
  double dropout = 0;           ///< share of the returns that get lost, [0, 1]
  bool drop_back_faces = false; ///< nothing returns where a ray first meets the back of a triangle
  double outlier_fraction = 0;  ///< share of the returns that are replaced by an outlier, [0, 1]
  OutlierKind outliers = OutlierKind::box;
  double outlier_box = 1.2; ///< > 0
  bool truth = false;       ///< add the attributes surface_distance and outlier
  std::uint64_t seed = 1;   ///< the same seed gives the same bytes for any number of threads
  unsigned threads = 0;     ///< 0: all cores
};

/// Scans the mesh from every sensor: one point per ray that meets the surface first seen and returns.
///
/// Points are in the order of sensors, then rays. scan_index is the number of the sensor. Attributes:
/// sx sy sz (float32, where the ray started), scan (uint8, or uint16 from 257 sensors on), range
/// (float32, distance sensor to point as measured); with `truth` also surface_distance (float32,
/// distance from the point to the mesh) and outlier (uint8, 1 for an outlier).
/// \throws Error{usage} for options or sensors out of range, no sensor or more than 65536;
///         Error{input} for a mesh without triangles, with a vertex that is not finite or an index out of range
PointCloud scan(const TriangleMesh& mesh, const std::vector<Sensor>& sensors, const ScanOptions& options = {});

} // namespace eigencrust::tools
