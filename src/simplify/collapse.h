// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Edges of a mesh are collapsed, the cheapest first, as long as it stays the manifold that it is.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <eigencrust/metrics.h>
#include <eigencrust/types.h>

#include "parallel/threads.h"
#include "simplify/quadric.h"

namespace eigencrust {

/// Where to stop.
struct CollapseGoal {
  std::size_t triangles = 0; ///< no fewer than these
  double max_error = 0;      ///< neither surface is anywhere farther than this from the other, by points
};

/// The surface before.
struct StandFor {
  const TriangleTree* surface = nullptr;
  Vec3 origin; ///< of the mesh, in the coordinates of that surface
  /// Points of it relative to the origin, and the triangles of the mesh that stand for them.
  std::span<const Vec3> points;
  std::span<const std::uint32_t> triangle; ///< of each point
};

/// The quadrics of the vertices: the planes of their triangles by area, and across each open edge a plane that holds
/// it.
std::vector<Quadric> vertex_quadrics(const TriangleMesh& mesh, const Threads& threads);

/// What is left of a mesh.
struct Collapsed {
  TriangleMesh mesh;               ///< without attributes; vertices that are left keep their order
  std::vector<Quadric> quadrics;   ///< of its vertices
  std::vector<std::uint32_t> into; ///< of each vertex before: the vertex that it is now part of
  bool is_manifold = true;         ///< else nothing was done
};

/// Collapses edges by Garland and Heckbert's error, each to the place of the least one. The link condition (Dey,
/// Edelsbrunner, Guha, Nekhayev 1999) keeps the surface the manifold that it is, rims included; no triangle turns over.
/// \param mesh     oriented, no edge with more than two triangles; coordinates should be near zero
/// \param quadrics of its vertices
/// \param limits   for each vertex, and for what it becomes part of, of the root of the mean square of the distances to
///        its planes; negative: all its edges stay
/// \param before   looked at where the goal limits the error: each point has a triangle that is near enough at any
/// time,
///        and new corners and the middles of new triangles are near enough to the surface
/// \return the mesh as it is where it is no manifold
Collapsed collapse_edges(const TriangleMesh& mesh, std::span<const Quadric> quadrics, std::span<const float> limits,
                         const StandFor& before, const CollapseGoal& goal);

} // namespace eigencrust
