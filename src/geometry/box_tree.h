// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A bounding volume hierarchy over boxes; what the boxes hold is the caller's affair.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <eigencrust/types.h>

#include "parallel/threads.h"

namespace eigencrust {

/// Of a triangle with finite corners.
inline Box3 box_around(const Vec3& p, const Vec3& q, const Vec3& r) {
  Box3 box;
  box.min = {std::min({p.x, q.x, r.x}), std::min({p.y, q.y, r.y}), std::min({p.z, q.z, r.z})};
  box.max = {std::max({p.x, q.x, r.x}), std::max({p.y, q.y, r.y}), std::max({p.z, q.z, r.z})};
  return box;
}

/// Binary tree of boxes, split at the median along the longest axis. Queries only read.
class BoxTree {
 public:
  struct Node {
    Box3 box;
    std::uint32_t first = 0; ///< leaf: first place in order(); inner node: its right child (left: the next node)
    std::uint32_t count = 0; ///< number of items of a leaf, 0 for an inner node
  };
  static constexpr std::uint32_t leaf_size = 4;
  /// Halving 2^32 items down to leaves takes fewer levels than this.
  static constexpr std::size_t max_depth = 40;

  BoxTree() = default;
  /// \param boxes finite, at least one
  BoxTree(std::span<const Box3> boxes, const Threads& threads);

  [[nodiscard]] const std::vector<Node>& nodes() const { return nodes_; }
  /// Item numbers in the order of the leaves.
  [[nodiscard]] const std::vector<std::uint32_t>& order() const { return order_; }

  /// visit(place) for every place in order() of items whose box, as given, may overlap `box` (touching
  /// counts): the items of all leaves that do. It ends early where visit says false. \return did it not?
  template <class Visit>
  bool overlapping_leaves(const Box3& box, Visit&& visit) const {
    std::array<std::uint32_t, max_depth> stack;
    std::size_t top = 0;
    if (!nodes_.empty()) stack[top++] = 0;
    while (top > 0) {
      const std::uint32_t i = stack[--top];
      const Node& node = nodes_[i];
      if (!overlap(node.box, box)) continue;
      if (node.count == 0) {
        stack[top++] = node.first;
        stack[top++] = i + 1;
        continue;
      }
      for (std::uint32_t k = 0; k < node.count; ++k)
        if (!visit(node.first + k)) return false;
    }
    return true;
  }

  /// Two nodes of one level, or a node and itself.
  using NodePair = std::array<std::uint32_t, 2>;
  /// Parts of the work of finding all pairs of items that may overlap; as many for any number of threads.
  [[nodiscard]] std::vector<NodePair> parts_of_join() const;
  /// visit(a, b) for every two leaves that overlap and are below these nodes, and for each leaf and itself; over all
  /// parts each pair is met once. One walk for all items of a leaf is much shorter than one for each.
  template <class Visit>
  void join(const NodePair& part, Visit&& visit) const {
    const auto [a, b] = part;
    const Node &p = nodes_[a], &q = nodes_[b];
    if (a != b && !overlap(p.box, q.box)) return;
    if (p.count > 0 && q.count > 0)
      visit(p, q);
    else
      for_each_child_pair(part, [&](const NodePair& child) { join(child, visit); });
  }

  static bool overlap(const Box3& a, const Box3& b) {
    // Without branches: which of them fails first is anybody's guess.
    const int x = (a.min.x <= b.max.x) & (b.min.x <= a.max.x), y = (a.min.y <= b.max.y) & (b.min.y <= a.max.y),
              z = (a.min.z <= b.max.z) & (b.min.z <= a.max.z);
    return (x & y & z) != 0;
  }

 private:
  class Builder;

  template <class Visit>
  void for_each_child_pair(const NodePair& pair, Visit&& visit) const {
    const auto [a, b] = pair;
    const Node &p = nodes_[a], &q = nodes_[b];
    if (a == b) {
      visit(NodePair{a + 1, a + 1});
      visit(NodePair{a + 1, p.first});
      visit(NodePair{p.first, p.first});
    } else if (p.count > 0) {
      visit(NodePair{a, b + 1});
      visit(NodePair{a, q.first});
    } else if (q.count > 0) {
      visit(NodePair{a + 1, b});
      visit(NodePair{p.first, b});
    } else {
      for (const std::uint32_t left : {a + 1, p.first})
        for (const std::uint32_t right : {b + 1, q.first}) visit(NodePair{left, right});
    }
  }

  std::vector<Node> nodes_; ///< preorder; node 0 is the root
  std::vector<std::uint32_t> order_;
};

} // namespace eigencrust
