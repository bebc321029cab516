// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Which triangles of a soup run through each other, decided exactly.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <eigencrust/types.h>

#include "geometry/box_tree.h"
#include "geometry/mesh_topology.h"
#include "parallel/threads.h"

namespace eigencrust {

/// Do two vertices of the triangle coincide, or are all three collinear (exact)?
bool is_degenerate(std::span<const Vec3> vertices, const Triangle& triangle);
/// For each triangle 1 when it is degenerate, else 0.
/// \param clear for each vertex 1 where none of its triangles is known to be; empty: nothing is known
std::vector<std::uint8_t> find_degenerate_triangles(std::span<const Vec3> vertices, std::span<const Triangle> triangles,
                                                    std::span<const std::uint8_t> clear, const Threads& threads);
inline std::vector<std::uint8_t> find_degenerate_triangles(std::span<const Vec3> vertices,
                                                           std::span<const Triangle> triangles,
                                                           const Threads& threads) {
  return find_degenerate_triangles(vertices, triangles, {}, threads);
}

/// How many pairs of triangles may be looked at. Those whose boxes overlap are: some 20 of each triangle of a surface,
/// and all there are where all triangles cross one another, which nobody waits for.
struct CrossingLimits {
  std::uint64_t always = 256;         ///< of every triangle
  std::uint64_t in_all = 100'000'000; ///< of triangles with more, together; half a minute on one core
};

/// What was counted, the same for any number of threads.
struct Crossings {
  std::uint64_t pairs = 0;
  bool all = true;          ///< false: there are at least so many
  std::uint64_t looked = 0; ///< pairs that were looked at: the work
};

/// Pairs of triangles that have a point in common other than a shared vertex or a point of a shared
/// edge. Exact predicates; works on any soup. The work is bounded by `limits`, for each triangle and in all.
/// \param vertices  finite; equal coordinates must have the same number where triangles use them
/// \param degenerate triangles marked 1 are left out: they have no inside to speak of
Crossings count_self_intersections(std::span<const Vec3> vertices, std::span<const Triangle> triangles,
                                   std::span<const std::uint8_t> degenerate, const Threads& threads,
                                   const CrossingLimits& limits = {});
/// Finds pairs of triangles that have a point in common other than a shared vertex or a point of a shared edge, by
/// exact predicates in any soup; and finds them again and again while a few vertices move: only what moved is looked at
/// then.
class CrossingSearch {
 public:
  using Pair = std::array<std::uint32_t, 2>;

  /// Of what is given views are kept.
  /// \param vertices finite; equal coordinates must have the same number where triangles use them
  /// \param degenerate triangles marked 1 are left out: they have no inside to speak of
  CrossingSearch(std::span<const Vec3> vertices, std::span<const Triangle> triangles,
                 std::span<const std::uint8_t> degenerate, const Threads& threads);

  /// \param clear for each vertex 1 where its triangles are known to meet in what they share only, until it or a
  ///        neighbour moves (see clear_stars()); kept as a view
  void set_clear(std::span<const std::uint8_t> clear) { clear_ = clear; }

  /// As long as nothing has moved. The same order for any number of threads.
  [[nodiscard]] std::uint64_t count(const Threads& threads) const;
  [[nodiscard]] std::vector<Pair> all(const Threads& threads) const;
  /// Those of which one is of these triangles. \param changed increasing; all triangles whose vertices have moved since
  ///        the search was made are among them or were given before
  std::vector<Pair> of_changed(std::span<const std::uint32_t> changed, const Threads& threads);

 private:
  enum class State : std::uint8_t { same, changed, asked };

  template <class Visit>
  void for_all(const Threads& threads, Visit&& visit) const;
  [[nodiscard]] bool shares_clear(const Triangle& f, const Triangle& g) const;
  [[nodiscard]] Box3 box_of(std::uint32_t t) const;

  struct Item { ///< a triangle
    Box3 box;
    Triangle corners;
    std::uint32_t number;
  };
  /// Triangles around one vertex: a few, as of a surface most of the pairs that are near one another are.
  struct Star {
    Box3 box;
    std::uint32_t hub, begin, end; ///< the vertex; places of its triangles
  };
  static constexpr std::size_t most_of_star = 8; ///< triangles: the box of more would be too large
  class Stars;
  struct Near {
    std::uint32_t count = 0;
    std::array<const Item*, most_of_star + 1> item; ///< and one that is not
  };
  [[nodiscard]] Near items_near(const Star& star, const Box3& box) const;

  template <class Look>
  void look_at_pairs(const BoxTree::Node& p, const BoxTree::Node& q, Look&& look) const;

  std::span<const Vec3> vertices_;
  std::span<const Triangle> triangles_;
  std::span<const std::uint8_t> degenerate_;
  std::span<const std::uint8_t> clear_; ///< of each vertex; empty: nothing is known
  std::vector<Star> stars_;             ///< in the order of the tree's leaves
  std::vector<Item> items_;             ///< star by star
  BoxTree tree_;
  std::vector<BoxTree::NodePair> parts_;
  std::vector<State> state_; ///< of each triangle; empty: nothing has moved
  std::vector<std::uint32_t> changed_;
};

} // namespace eigencrust
