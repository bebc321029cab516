// SPDX-License-Identifier: GPL-3.0-or-later
#include "peers.h"

#include <CGAL/Surface_mesh.h>
#include <CGAL/alpha_wrap_3.h>

namespace eigencrust::bench {

TriangleMesh cgal_alpha_wrap(const Points& points) {
  // A smaller alpha falls through between samples, a smaller offset takes longer.
  constexpr double alpha_per_spacing = 3, offset_per_alpha = 0.1;
  const double alpha = alpha_per_spacing * average_spacing(points);
  CGAL::Surface_mesh<Kernel::Point_3> wrap;
  CGAL::alpha_wrap_3(points, alpha, offset_per_alpha * alpha, wrap);
  return mesh_of(wrap);
}

} // namespace eigencrust::bench
