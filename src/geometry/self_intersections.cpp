// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/self_intersections.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/intersections.h>

#include <algorithm>
#include <numeric>
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

bool is_degenerate(std::span<const Vec3> vertices, const Triangle& triangle) {
  const auto& [a, b, c] = triangle;
  return CGAL::collinear(to_cgal(vertices[a]), to_cgal(vertices[b]), to_cgal(vertices[c]));
}

std::vector<std::uint8_t> find_degenerate_triangles(std::span<const Vec3> vertices, std::span<const Triangle> triangles,
                                                    const Threads& threads) {
  std::vector<std::uint8_t> degenerate(triangles.size());
  for_each_index(threads, triangles.size(),
                 [&](std::size_t t) { degenerate[t] = is_degenerate(vertices, triangles[t]) ? 1 : 0; });
  return degenerate;
}

namespace {

/// Finds the pairs one of which is asked for.
class CrossingSearch {
 public:
  CrossingSearch(std::span<const Vec3> vertices, std::span<const Triangle> triangles,
                 std::span<const std::uint8_t> degenerate, std::span<const std::uint8_t> asked, const Threads& threads)
      : vertices_(vertices), triangles_(triangles), degenerate_(degenerate), asked_(asked) {
    for (std::uint32_t t = 0; t < triangles.size(); ++t)
      if (degenerate[t] == 0 && is_asked(t)) number_.push_back(t);
    if (number_.empty()) return;
    boxes_.resize(number_.size());
    for_each_index(threads, boxes_.size(), [&](std::size_t i) { boxes_[i] = box_of(number_[i]); });
    tree_ = BoxTree(boxes_, threads);
    std::vector<std::uint32_t> number(number_.size());
    for_each_index(threads, number.size(), [&](std::size_t i) {
      number[i] = number_[tree_.order()[i]];
      boxes_[i] = box_of(number[i]);
    });
    number_.swap(number);
    if (asked.empty()) parts_ = tree_.parts_of_join();
  }

  /// visit(block, f, g) for each pair once, on the thread of the block.
  template <class Visit>
  void run(const Threads& threads, Visit&& visit) const {
    if (boxes_.empty()) return;
    if (asked_.empty()) {
      threads.run(parts_.size(), [&](std::size_t p) {
        tree_.join(parts_[p], [&](std::uint32_t i, std::uint32_t j) {
          if (!BoxTree::overlap(boxes_[i], boxes_[j])) return;
          const auto [f, g] = std::minmax(number_[i], number_[j]);
          if (intersect(triangles_[f], triangles_[g])) visit(p, f, g);
        });
      });
      return;
    }
    // The tree is small where few are asked for; all others walk through it.
    for_blocks(threads, triangles_.size(), block, [&](std::size_t begin, std::size_t end, std::size_t b) {
      for (std::size_t i = begin; i < end; ++i) {
        const auto f = static_cast<std::uint32_t>(i);
        if (degenerate_[f] != 0) continue;
        const Box3 box = box_of(f);
        const bool both = is_asked(f);
        tree_.overlapping_leaves(box, [&](std::uint32_t place) {
          const std::uint32_t g = number_[place];
          if ((both && g <= f) || !BoxTree::overlap(boxes_[place], box)) return;
          if (intersect(triangles_[f], triangles_[g])) visit(b, f, g);
        });
      }
    });
  }
  [[nodiscard]] std::size_t blocks() const {
    return asked_.empty() ? parts_.size() : (triangles_.size() + block - 1) / block;
  }

 private:
  static constexpr std::size_t block = 2048;

  [[nodiscard]] bool is_asked(std::uint32_t t) const { return asked_.empty() || asked_[t] != 0; }
  [[nodiscard]] Box3 box_of(std::uint32_t t) const {
    Box3 box;
    for (const std::uint32_t v : triangles_[t]) box.add(vertices_[v]);
    return box;
  }
  [[nodiscard]] Corners corners(const Triangle& t) const {
    return {to_cgal(vertices_[t[0]]), to_cgal(vertices_[t[1]]), to_cgal(vertices_[t[2]])};
  }
  [[nodiscard]] bool intersect(Triangle f, Triangle g) const {
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
  std::span<const std::uint8_t> degenerate_, asked_;
  std::vector<std::uint32_t> number_; ///< of those asked for, in the order of the tree's leaves
  std::vector<Box3> boxes_;           ///< of those
  BoxTree tree_;
  std::vector<BoxTree::NodePair> parts_; ///< where all are asked for
};

} // namespace

std::uint64_t count_self_intersections(std::span<const Vec3> vertices, std::span<const Triangle> triangles,
                                       std::span<const std::uint8_t> degenerate, const Threads& threads) {
  const CrossingSearch search(vertices, triangles, degenerate, {}, threads);
  std::vector<std::uint64_t> pairs(search.blocks(), 0);
  search.run(threads, [&](std::size_t block, std::uint32_t, std::uint32_t) { ++pairs[block]; });
  return std::accumulate(pairs.begin(), pairs.end(), std::uint64_t{0});
}

std::vector<std::array<std::uint32_t, 2>> find_self_intersections(std::span<const Vec3> vertices,
                                                                  std::span<const Triangle> triangles,
                                                                  std::span<const std::uint8_t> degenerate,
                                                                  std::span<const std::uint8_t> asked,
                                                                  const Threads& threads) {
  const CrossingSearch search(vertices, triangles, degenerate, asked, threads);
  std::vector<std::vector<std::array<std::uint32_t, 2>>> pairs(search.blocks());
  search.run(threads, [&](std::size_t block, std::uint32_t f, std::uint32_t g) { pairs[block].push_back({f, g}); });
  std::vector<std::array<std::uint32_t, 2>> all;
  for (const auto& part : pairs) all.insert(all.end(), part.begin(), part.end());
  return all;
}

} // namespace eigencrust
