// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Lines from a sample up to where they meet other samples' surface.
#pragma once

#include <algorithm>

#include <eigencrust/stages.h>

#include "tetrahedra/scene.h"
#include "tetrahedra/segment_walk.h"

namespace eigencrust {

/// Is what two tetrahedra have in common a face among neighbouring samples, as those of a sheet are?
bool is_in_sheet(const Scene& scene, TetrahedronIndex one, TetrahedronIndex other);

/// visit(tetrahedron, length of the way through it) for those that the line crosses, up to the next sheet of samples;
/// not for those near samples, as with lines of sight. \return whether there was no sheet
template <class Visit>
bool cross_to_next_sheet(const Scene& scene, const SightLine& line, const Visit& visit) {
  const Tetrahedralization& t = scene.tetrahedralization;
  const auto depth = static_cast<double>(line.depth);
  const Vec3 start = t.positions[line.sample], way = line.target - start, direction = (1 / norm(way)) * way;
  SegmentWalk walk(t, scene.stars, line.sample, line.target);
  bool has_left = false; // its own sheet
  for (TetrahedronIndex last; walk.next(); last = walk.tetrahedron()) {
    const TetrahedronIndex at = walk.tetrahedron();
    if (has_left && is_in_sheet(scene, last, at)) return false;
    const Vec3 middle = start + (walk.depth() + walk.exit_depth()) / 2 * direction;
    if (std::any_of(t.tetrahedra[at].begin(), t.tetrahedra[at].end(),
                    [&](VertexIndex v) { return squared_norm(t.positions[v] - middle) <= depth * depth; }))
      continue;
    has_left = true;
    visit(at, walk.exit_depth() - walk.depth());
  }
  return true;
}

} // namespace eigencrust
