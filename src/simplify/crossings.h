// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What must not be in a mesh with other triangles.
#pragma once

#include <cstdint>
#include <vector>

#include <eigencrust/types.h>

#include "parallel/threads.h"

namespace eigencrust {

/// Places where triangles cross or have no area.
struct CrossingVertices {
  std::uint64_t count = 0;      ///< pairs of triangles that cross, and degenerate triangles
  std::vector<std::uint8_t> at; ///< of each vertex whether it is one of theirs
};
CrossingVertices crossing_vertices(const TriangleMesh& mesh, const Threads& threads);

/// Also marks what `rings` edges lead to.
void widen(const TriangleMesh& mesh, int rings, std::vector<std::uint8_t>& marked);

} // namespace eigencrust
