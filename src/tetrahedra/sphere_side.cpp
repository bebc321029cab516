// SPDX-License-Identifier: GPL-3.0-or-later
#include "tetrahedra/sphere_side.h"

namespace eigencrust {

bool is_inside_when_moved(const std::array<const Vec3*, 4>& tetrahedron, const Vec3& p) {
  std::array<const Vec3*, 5> by_place{tetrahedron[0], tetrahedron[1], tetrahedron[2], tetrahedron[3], &p};
  std::sort(by_place.begin(), by_place.end(), [](const Vec3* a, const Vec3* b) { return *b < *a; });
  // What lifts the farthest decides; lifted itself, p leaves the sphere. Its factor is the volume of the tetrahedron
  // that p makes in its stead; where that is 0, the next decides. Of three one is not 0: no four others are in a plane.
  for (const Vec3* farthest : by_place) {
    if (farthest == &p) return false;
    std::array<const Vec3*, 4> v = tetrahedron;
    *std::find(v.begin(), v.end(), farthest) = &p;
    if (const int sign = orientation(*v[0], *v[1], *v[2], *v[3]); sign != 0) return sign > 0;
  }
  return false;
}

} // namespace eigencrust
