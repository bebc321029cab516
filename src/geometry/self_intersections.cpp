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

std::vector<Box3> boxes_of(std::span<const Vec3> vertices, std::span<const Triangle> triangles) {
  std::vector<Box3> boxes(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (const std::uint32_t v : triangles[t]) boxes[t].add(vertices[v]);
  return boxes;
}

/// Of each triangle with those of greater number. At first each looks at a few; then those that have more go on, in
/// rounds of a fixed size, until the limit of all is reached: which they are does not depend on threads.
class CrossingCounter {
 public:
  /// \param triangles none degenerate, at least one; outlive this
  CrossingCounter(std::span<const Vec3> vertices, std::span<const Triangle> triangles, const CrossingLimits& limits)
      : vertices_(vertices),
        triangles_(triangles),
        limits_(limits),
        boxes_(boxes_of(vertices, triangles)),
        tree_(boxes_) {}

  Crossings count(const Threads& threads) const {
    constexpr std::size_t block = 2048;
    std::vector<Few> few((triangles_.size() + block - 1) / block);
    for_blocks(threads, triangles_.size(), block,
               [&](std::size_t begin, std::size_t end, std::size_t b) { few[b] = look_at_few(begin, end); });
    Crossings sum;
    std::vector<Wide> wide;
    for (const Few& one : few) {
      add(one.done, sum);
      wide.insert(wide.end(), one.wide.begin(), one.wide.end());
    }
    std::uint64_t more = 0;
    for (std::size_t begin = 0, end = 0; begin < wide.size(); begin = end) {
      end = std::min(wide.size(), begin + round);
      const bool go_on = more < limits_.in_all;
      if (go_on)
        threads.run(end - begin, [&](std::size_t k) {
          Wide& one = wide[begin + k];
          one.so_far = look(one.triangle, limits_.in_all);
        });
      for (std::size_t k = begin; k < end; ++k) {
        if (go_on) more += wide[k].so_far.looked;
        add(wide[k].so_far, sum);
      }
    }
    return sum;
  }

 private:
  // So many triangles go on before it is asked again whether it was enough: at most so many times all triangles more.
  static constexpr std::size_t round = 64;

  struct Wide { ///< a triangle with more pairs than are always looked at
    std::uint32_t triangle;
    Crossings so_far;
  };
  struct Few {
    Crossings done;
    std::vector<Wide> wide;
  };

  static void add(const Crossings& one, Crossings& sum) {
    sum.pairs += one.pairs;
    sum.looked += one.looked;
    sum.all = sum.all && one.all;
  }

  /// In the order of the leaves, so that one query after the other walks through the same nodes.
  Few look_at_few(std::size_t begin, std::size_t end) const {
    Few few;
    for (std::size_t place = begin; place < end; ++place) {
      const std::uint32_t t = tree_.order()[place];
      const Crossings one = look(t, limits_.always);
      if (one.all)
        add(one, few.done);
      else
        few.wide.push_back({t, one});
    }
    return few;
  }

  Crossings look(std::uint32_t t, std::uint64_t most) const {
    Crossings found;
    found.all = tree_.overlapping_leaves(boxes_[t], [&](std::uint32_t other) {
      if (found.looked == most) return false;
      ++found.looked;
      found.pairs += other > t && BoxTree::overlap(boxes_[other], boxes_[t]) && meet(triangles_[t], triangles_[other]);
      return true;
    });
    return found;
  }

  [[nodiscard]] Corners corners(const Triangle& t) const {
    return {to_cgal(vertices_[t[0]]), to_cgal(vertices_[t[1]]), to_cgal(vertices_[t[2]])};
  }
  [[nodiscard]] bool meet(Triangle f, Triangle g) const {
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
  }

  std::span<const Vec3> vertices_;
  std::span<const Triangle> triangles_;
  CrossingLimits limits_;
  std::vector<Box3> boxes_;
  BoxTree tree_;
};

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

Crossings count_self_intersections(std::span<const Vec3> vertices, std::span<const Triangle> triangles,
                                   std::span<const std::uint8_t> degenerate, const Threads& threads,
                                   const CrossingLimits& limits) {
  std::vector<Triangle> sound;
  sound.reserve(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t)
    if (degenerate[t] == 0) sound.push_back(triangles[t]);
  return sound.empty() ? Crossings{} : CrossingCounter(vertices, sound, limits).count(threads);
}

} // namespace eigencrust
