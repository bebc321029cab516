// SPDX-License-Identifier: GPL-3.0-or-later
#include "peers.h"

#include <utility>

#include <CGAL/Surface_mesh.h>
#include <CGAL/mst_orient_normals.h>
#include <CGAL/pca_estimate_normals.h>
#include <CGAL/poisson_surface_reconstruction.h>
#include <CGAL/property_map.h>

#include <eigencrust/error.h>

namespace eigencrust::bench {

TriangleMesh cgal_poisson(const Points& points) {
  using Oriented = std::pair<Kernel::Point_3, Kernel::Vector_3>;
  using PointMap = CGAL::First_of_pair_property_map<Oriented>;
  using NormalMap = CGAL::Second_of_pair_property_map<Oriented>;
  constexpr unsigned neighbours = 18; // of the manual's example
  std::vector<Oriented> cloud;
  for (const auto& p : points) cloud.emplace_back(p, CGAL::NULL_VECTOR);
  const auto parameters = CGAL::parameters::point_map(PointMap()).normal_map(NormalMap());
  CGAL::pca_estimate_normals<CGAL::Parallel_if_available_tag>(cloud, neighbours, parameters);
  // Points whose normal could not be oriented are moved to the end.
  cloud.erase(CGAL::mst_orient_normals(cloud, neighbours, parameters), cloud.end());
  CGAL::Surface_mesh<Kernel::Point_3> surface;
  if (!CGAL::poisson_surface_reconstruction_delaunay(cloud.begin(), cloud.end(), PointMap(), NormalMap(), surface,
                                                     average_spacing(points)))
    throw Error(ErrorKind::guarantee, "poisson", "CGAL found no surface", "look at the normals");
  return mesh_of(surface);
}

} // namespace eigencrust::bench
