// SPDX-License-Identifier: GPL-3.0-or-later
#include "peers.h"

#include <array>
#include <iterator>

#include <CGAL/Advancing_front_surface_reconstruction.h>

namespace eigencrust::bench {

TriangleMesh cgal_advancing_front(const Points& points) {
  std::vector<std::array<std::size_t, 3>> facets;
  CGAL::advancing_front_surface_reconstruction(points.begin(), points.end(), std::back_inserter(facets));
  TriangleMesh mesh;
  for (const auto& p : points) mesh.vertices.push_back({p.x(), p.y(), p.z()});
  for (const auto& [a, b, c] : facets)
    mesh.triangles.push_back(
        {static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b), static_cast<std::uint32_t>(c)});
  return mesh;
}

} // namespace eigencrust::bench
