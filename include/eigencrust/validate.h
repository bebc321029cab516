// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What a mesh is: closed, manifold, oriented, and the numbers that go with it. Works on any mesh.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include <eigencrust/threads.h>
#include <eigencrust/types.h>

namespace eigencrust {

/// How a mesh is looked at.
struct ValidateOptions {
  bool self_intersections = true;   ///< the dearest of the checks
  bool merge_equal_vertices = true; ///< first make vertices with equal coordinates one, as readers do
  unsigned threads = 0;             ///< 0: all cores
};

/// A set of triangles joined along shared edges.
struct ComponentSummary {
  std::uint32_t vertices = 0, triangles = 0; ///< of this piece
  std::int64_t euler = 0;                    ///< vertices - edges + triangles
  /// (2 - euler - boundary loops)/2 for an orientable piece with manifold edges; of a piece with
  /// non-manifold vertices or edges the value after cutting those apart. -1 where not orientable.
  std::int64_t genus = 0;
};

/// Counts are of the mesh after merging (if asked for). An edge is "boundary" with one triangle,
/// "non-manifold" with more than two, "inconsistent" with two or more of which not as many run one way
/// as the other (two running the same way, or an odd number).
/// A vertex is non-manifold when its triangles do not form one fan (open or closed).
/// A triangle is degenerate when two of its vertices coincide or its three vertices are collinear
/// (exact predicate); duplicates of a triangle show as non-manifold or inconsistent edges. Triangles
/// that name one vertex twice are counted but take no part in edges, vertices and components.
struct MeshSummary {
  std::uint64_t vertices = 0, triangles = 0; ///< after equal vertices were made one, where that was asked for
  std::uint64_t unreferenced_vertices = 0;   ///< not counted in `vertices`
  /// Edges with one triangle, and the loops they make; edges with more than two; vertices with more than one fan; edges
  /// along which two triangles run the same way; triangles without area.
  std::uint64_t boundary_edges = 0, boundary_loops = 0, nonmanifold_edges = 0, nonmanifold_vertices = 0,
                inconsistent_edges = 0, degenerate_triangles = 0;
  /// Pairs of triangles that intersect in more than a shared vertex or edge (shared: of equal
  /// coordinates), degenerate ones left out; -1 if not computed.
  std::int64_t self_intersections = -1;
  /// false: there are at least so many. Triangles whose boxes overlap those of more than 256 others are looked at until
  /// there were a hundred million such pairs.
  bool all_self_intersections = true;
  std::uint64_t components = 0;      ///< sets of triangles joined along edges
  std::int64_t euler = 0, genus = 0; ///< genus: sum over the components, -1 if one is not orientable
  double volume = 0;                 ///< signed, by the divergence theorem from the box's centre; positive = outward
  double area = 0;                   ///< of all triangles
  Box3 bounds;                       ///< of the vertices in use
  std::vector<ComponentSummary> component_list; ///< largest first, all of them

  /// Every edge has two triangles or more, and there are triangles.
  [[nodiscard]] bool closed() const { return boundary_edges == 0 && components > 0; }
  /// No edge has more than two triangles, every vertex has one fan.
  [[nodiscard]] bool manifold() const { return nonmanifold_edges == 0 && nonmanifold_vertices == 0; }
  /// Neighbours run along their edge in opposite directions.
  [[nodiscard]] bool oriented() const { return inconsistent_edges == 0; }
};

/// \throws Error{input} when a triangle names a vertex that does not exist or a vertex is not finite.
MeshSummary validate(const TriangleMesh& mesh, const ValidateOptions& options = {});
/// The same on threads that are there, whatever options.threads is.
MeshSummary validate(const TriangleMesh& mesh, const ValidateOptions& options, const Threads& threads);

/// Vertices with equal coordinates made one (the first), order kept; triangles with two equal
/// corners then stay in place, so that triangle attributes still fit.
TriangleMesh merge_equal_vertices(const TriangleMesh& mesh);

/// Component number of every triangle (joined along edges), components numbered by first triangle.
std::vector<std::uint32_t> triangle_components(const TriangleMesh& mesh, unsigned threads = 1);

} // namespace eigencrust
