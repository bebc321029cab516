// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Cocone: the Delaunay faces whose dual edges all their samples see near their tangent planes (Amenta, Choi, Dey,
/// Leekha 2000), and which samples are flat, that is inside a well sampled patch (Dey, Giesen 2001).
#pragma once

#include <array>
#include <vector>

#include "tetrahedra/scene.h"

namespace eigencrust {

struct Cocone {
  std::vector<Vec3> normal;       ///< of each sample: unit vector to the first pole; 0 where there is none
  std::vector<std::uint8_t> flat; ///< of each sample
  /// Which faces of a tetrahedron are in the cocone: the one opposite corner k, if all its flat samples see it so and
  /// one of them is.
  IndexedArray<TetrahedronIndex, std::array<bool, 4>> face;
};

Cocone cocone(const Scene& scene, const Threads& threads);

} // namespace eigencrust
