// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/self_intersections.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/intersections.h>

#include <algorithm>
#include <utility>

#include "geometry/box_tree.h"

namespace eigencrust {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Corners = std::array<Point, 3>;

Point to_cgal(const Vec3& p) { return {p.x, p.y, p.z}; }

/// Are all points strictly on one and the same side of the plane of `plane`?
template <class... Points>
bool strictly_beside(const Corners& plane, const Points&... points) {
  CGAL::Orientation sides[] = {CGAL::orientation(plane[0], plane[1], plane[2], points)...};
  return sides[0] != CGAL::COPLANAR &&
         std::all_of(std::begin(sides), std::end(sides), [&](CGAL::Orientation s) { return s == sides[0]; });
}

bool meet_anywhere(const Corners& f, const Corners& g) {
  if (strictly_beside(f, g[0], g[1], g[2]) || strictly_beside(g, f[0], f[1], f[2])) return false;
  return CGAL::do_intersect(Kernel::Triangle_3(f[0], f[1], f[2]), Kernel::Triangle_3(g[0], g[1], g[2]));
}

/// f[0] = g[0] is shared. A second common point p would lie on a ray from there that stays in both
/// triangles until it leaves one of them, and that is through the side opposite the shared vertex.
bool meet_beyond_vertex(const Corners& f, const Corners& g) {
  if (strictly_beside(f, g[1], g[2]) || strictly_beside(g, f[1], f[2])) return false;
  return CGAL::do_intersect(Kernel::Triangle_3(f[0], f[1], f[2]), Kernel::Segment_3(g[1], g[2])) ||
         CGAL::do_intersect(Kernel::Triangle_3(g[0], g[1], g[2]), Kernel::Segment_3(f[1], f[2]));
}

/// f[0] = g[0] and f[1] = g[1] are shared: only a fold by half a turn makes them overlap.
bool meet_beyond_edge(const Corners& f, const Corners& g) {
  return CGAL::orientation(f[0], f[1], f[2], g[2]) == CGAL::COPLANAR &&
         CGAL::coplanar_orientation(f[0], f[1], f[2], g[2]) == CGAL::POSITIVE;
}

/// The same triangles with their shared vertices first and in the same order; how many there are.
int shared_first(Triangle& f, Triangle& g) {
  int shared = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = shared; j < 3; ++j)
      if (f[i] == g[j]) {
        std::swap(f[i], f[shared]);
        std::swap(g[j], g[shared]);
        ++shared;
        break;
      }
  return shared;
}

} // namespace

std::vector<std::uint8_t> find_degenerate_triangles(std::span<const Vec3> vertices, std::span<const Triangle> triangles,
                                                    const Threads& threads) {
  std::vector<std::uint8_t> degenerate(triangles.size());
  for_each_index(threads, triangles.size(), [&](std::size_t t) {
    const auto& [a, b, c] = triangles[t];
    degenerate[t] = CGAL::collinear(to_cgal(vertices[a]), to_cgal(vertices[b]), to_cgal(vertices[c])) ? 1 : 0;
  });
  return degenerate;
}

std::uint64_t count_self_intersections(std::span<const Vec3> vertices, std::span<const Triangle> triangles,
                                       std::span<const std::uint8_t> degenerate, const Threads& threads) {
  std::vector<Triangle> sound;
  sound.reserve(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t)
    if (degenerate[t] == 0) sound.push_back(triangles[t]);
  if (sound.empty()) return 0;
  std::vector<Box3> boxes(sound.size());
  for (std::size_t t = 0; t < sound.size(); ++t)
    for (const std::uint32_t v : sound[t]) boxes[t].add(vertices[v]);
  const BoxTree tree(boxes);
  const auto corners = [&](const Triangle& t) {
    return Corners{to_cgal(vertices[t[0]]), to_cgal(vertices[t[1]]), to_cgal(vertices[t[2]])};
  };
  const auto intersect = [&](Triangle f, Triangle g) {
    switch (shared_first(f, g)) {
      case 0:
        return meet_anywhere(corners(f), corners(g));
      case 1:
        return meet_beyond_vertex(corners(f), corners(g));
      case 2:
        return meet_beyond_edge(corners(f), corners(g));
      default:
        return true; // one triangle twice
    }
  };
  // In the order of the leaves, so that one query after the other walks through the same nodes.
  const auto part = [&](std::size_t begin, std::size_t end) {
    std::uint64_t pairs = 0;
    for (std::size_t place = begin; place < end; ++place) {
      const std::uint32_t t = tree.order()[place];
      tree.overlapping_leaves(boxes[t], [&](std::uint32_t other) {
        if (other > t && BoxTree::overlap(boxes[other], boxes[t]) && intersect(sound[t], sound[other])) ++pairs;
      });
    }
    return pairs;
  };
  return sum_blocks<std::uint64_t>(threads, sound.size(), part, 2048);
}

} // namespace eigencrust
