// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Clouds with noise whose true surface is known, normals included.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <eigencrust/types.h>

#include "bodies.h"

namespace eigencrust::bench {

/// A wheel with 18 teeth and a bore, as an extruded profile: sharp edges, flat and round faces, genus 1.
Truth gear();
/// A cube of edge 10.
Truth cube();

/// What `shapes()` names: "gear" and "cube", else the closed mesh of that name in the data folder.
struct FitShape {
  std::string name;
  std::string file; ///< in the folder of the data; empty: by formula
};
const std::vector<FitShape>& fit_shapes();
/// \throws Error{input}
Truth truth_of(const FitShape& shape, const std::filesystem::path& data);

/// Samples spread at random over the area, each moved by a normal deviate in every coordinate.
struct FitScene {
  PointCloud cloud;          ///< with the attributes nx, ny, nz: the true normals
  double spacing = 0;        ///< side of the square that a sample stands for
  std::vector<Vec3> on_edge; ///< points along edges of the truth that are sharper than 40°, a fifth of a spacing apart
};
/// Points along the edges that are sharper than 40°, `step` apart.
std::vector<Vec3> points_on_sharp_edges(const TriangleMesh& mesh, double step);

/// \param sigma in spacings
FitScene fit_scene(const Truth& truth, std::size_t samples, double sigma, std::uint64_t seed);

} // namespace eigencrust::bench
