// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Which triangles of a soup run through each other, decided exactly.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <eigencrust/types.h>

#include "geometry/mesh_topology.h"
#include "parallel/threads.h"

namespace eigencrust {

/// Do two vertices of the triangle coincide, or are all three collinear (exact)?
bool is_degenerate(std::span<const Vec3> vertices, const Triangle& triangle);
/// For each triangle 1 when it is degenerate, else 0.
std::vector<std::uint8_t> find_degenerate_triangles(std::span<const Vec3> vertices, std::span<const Triangle> triangles,
                                                    const Threads& threads);

/// Pairs of triangles that have a point in common other than a shared vertex or a point of a shared
/// edge. Exact predicates; works on any soup.
/// \param vertices  finite; equal coordinates must have the same number where triangles use them
/// \param degenerate triangles marked 1 are left out: they have no inside to speak of
std::uint64_t count_self_intersections(std::span<const Vec3> vertices, std::span<const Triangle> triangles,
                                       std::span<const std::uint8_t> degenerate, const Threads& threads);

/// Those pairs, for a mesh that has few of them; `asked` (may be empty: all) marks triangles, and pairs without any of
/// these are left out. The same order for any number of threads.
std::vector<std::array<std::uint32_t, 2>> find_self_intersections(std::span<const Vec3> vertices,
                                                                  std::span<const Triangle> triangles,
                                                                  std::span<const std::uint8_t> degenerate,
                                                                  std::span<const std::uint8_t> asked,
                                                                  const Threads& threads);

} // namespace eigencrust
