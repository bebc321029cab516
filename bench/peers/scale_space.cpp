// SPDX-License-Identifier: GPL-3.0-or-later
#include "peers.h"

#include <CGAL/Scale_space_reconstruction_3/Advancing_front_mesher.h>
#include <CGAL/Scale_space_surface_reconstruction_3.h>

namespace eigencrust::bench {

TriangleMesh cgal_scale_space(const Points& points) {
  constexpr unsigned scales = 4; // of the manual's example
  CGAL::Scale_space_surface_reconstruction_3<Kernel> reconstruction(points.begin(), points.end());
  reconstruction.increase_scale(scales);
  // The other mesher, alpha shapes, gives both sides of each sheet.
  reconstruction.reconstruct_surface(CGAL::Scale_space_reconstruction_3::Advancing_front_mesher<Kernel>());
  TriangleMesh mesh;
  for (const auto& p : points) mesh.vertices.push_back({p.x(), p.y(), p.z()});
  for (auto f = reconstruction.facets_begin(); f != reconstruction.facets_end(); ++f)
    mesh.triangles.push_back({static_cast<std::uint32_t>((*f)[0]), static_cast<std::uint32_t>((*f)[1]),
                              static_cast<std::uint32_t>((*f)[2])});
  return mesh;
}

} // namespace eigencrust::bench
