// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Vertices whose triangles are known to meet in what they share only: most of a smooth surface.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <eigencrust/types.h>

#include "parallel/threads.h"
#include "surface/fans.h"

namespace eigencrust {

/// For each vertex 1 where its triangles, seen along some direction, lie side by side around it and go around once: no
/// two of them have a point in common but their edge or the vertex, and none is degenerate. 0: it is not known, as at
/// rims; nothing is said.
std::vector<std::uint8_t> clear_stars(std::span<const Vec3> vertices, const SurfaceFans& fans, const Threads& threads);

} // namespace eigencrust
