// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Reconstructions of CGAL 5.5, each with the parameters that its manual begins with.
#pragma once

#include <vector>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/compute_average_spacing.h>

#include <eigencrust/types.h>

namespace eigencrust::bench {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Points = std::vector<Kernel::Point_3>;

/// Mean distance to the 6 nearest points, the manual's measure of a cloud.
inline double average_spacing(const Points& points) {
  constexpr unsigned neighbours = 6;
  return CGAL::compute_average_spacing<CGAL::Parallel_if_available_tag>(points, neighbours);
}

/// Delaunay-refined level set of Poisson's equation; normals by PCA, oriented along a minimum spanning tree.
TriangleMesh cgal_poisson(const Points& points);
/// Cohen-Steiner and Da 2004.
TriangleMesh cgal_advancing_front(const Points& points);
/// Digne et al. 2011, four scales.
TriangleMesh cgal_scale_space(const Points& points);
/// Portaneri et al. 2022. It closes what a ball of radius alpha does not pass, and stays `offset` away from the points.
TriangleMesh cgal_alpha_wrap(const Points& points);

/// Triangles of a CGAL mesh.
template <class Mesh>
TriangleMesh mesh_of(const Mesh& from) {
  TriangleMesh mesh;
  for (const auto v : from.vertices()) {
    const auto& p = from.point(v);
    mesh.vertices.push_back({p.x(), p.y(), p.z()});
  }
  for (const auto f : from.faces()) {
    std::array<std::uint32_t, 3> corners{};
    std::size_t k = 0;
    for (const auto v : from.vertices_around_face(from.halfedge(f)))
      if (k < corners.size()) corners[k++] = static_cast<std::uint32_t>(v.idx());
    mesh.triangles.push_back(corners);
  }
  return mesh;
}

} // namespace eigencrust::bench
