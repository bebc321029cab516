// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Which triangles of a soup run through each other, decided exactly.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <eigencrust/types.h>

#include "geometry/mesh_topology.h"
#include "parallel/threads.h"

namespace eigencrust {

/// For each triangle 1 when two of its vertices coincide or all three are collinear (exact), else 0.
std::vector<std::uint8_t> find_degenerate_triangles(std::span<const Vec3> vertices, std::span<const Triangle> triangles,
                                                    const Threads& threads);

/// How many pairs of triangles may be looked at. Those whose boxes overlap are: some 20 of each triangle of a surface,
/// and all there are where all triangles cross one another, which nobody waits for.
struct CrossingLimits {
  std::uint64_t always = 256;         ///< of every triangle
  std::uint64_t in_all = 100'000'000; ///< of triangles with more, together; half a minute on one core
};

/// What was counted, the same for any number of threads.
struct Crossings {
  std::uint64_t pairs = 0;
  bool all = true;          ///< false: there are at least so many
  std::uint64_t looked = 0; ///< pairs that were looked at: the work
};

/// Pairs of triangles that have a point in common other than a shared vertex or a point of a shared
/// edge. Exact predicates; works on any soup. The work is bounded by `limits`, for each triangle and in all.
/// \param vertices  finite; equal coordinates must have the same number where triangles use them
/// \param degenerate triangles marked 1 are left out: they have no inside to speak of
Crossings count_self_intersections(std::span<const Vec3> vertices, std::span<const Triangle> triangles,
                                   std::span<const std::uint8_t> degenerate, const Threads& threads,
                                   const CrossingLimits& limits = {});

} // namespace eigencrust
