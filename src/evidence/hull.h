// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The triangles of the samples' convex hull.
#pragma once

#include <algorithm>
#include <array>

#include <eigencrust/stages.h>

namespace eigencrust {

struct HullTriangle {
  std::array<SampleIndex, 3> corner;
  TetrahedronIndex beyond; ///< with these and one corner of the cube
  Vec3 outward;            ///< normal, as long as twice the area
};

/// meet(hull triangle), in the order of the tetrahedra beyond them.
template <class Meet>
void for_each_hull_triangle(const Tetrahedralization& t, Meet&& meet) {
  for (TetrahedronIndex i{0}; i.value < t.tetrahedra.size(); ++i.value) {
    std::array<VertexIndex, 4> v = t.tetrahedra[i];
    std::stable_partition(v.begin(), v.end(), [&](VertexIndex a) { return !t.is_corner(a); });
    if (t.is_corner(v[2]) || !t.is_corner(v[3])) continue;
    const Vec3& p = t.positions[v[0]];
    const Vec3 normal = cross(t.positions[v[1]] - p, t.positions[v[2]] - p);
    const double sign = dot(normal, t.positions[v[3]] - p) > 0 ? 1 : -1;
    meet(HullTriangle{{t.sample(v[0]), t.sample(v[1]), t.sample(v[2])}, i, sign * normal});
  }
}

} // namespace eigencrust
