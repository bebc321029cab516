// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A bounding volume hierarchy over boxes; what the boxes hold is the caller's affair.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <eigencrust/types.h>

#include "parallel/threads.h"

namespace eigencrust {

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

  /// visit(item) for every item whose box, as given to the constructor, may overlap `box` (touching
  /// counts): the items of all leaves that do.
  template <class Visit>
  void overlapping_leaves(const Box3& box, Visit&& visit) const {
    std::array<std::uint32_t, max_depth> stack;
    std::size_t top = 0;
    stack[top++] = 0;
    while (top > 0) {
      const std::uint32_t i = stack[--top];
      const Node& node = nodes_[i];
      if (!overlap(node.box, box)) continue;
      if (node.count == 0) {
        stack[top++] = node.first;
        stack[top++] = i + 1;
        continue;
      }
      for (std::uint32_t k = 0; k < node.count; ++k) visit(order_[node.first + k]);
    }
  }

  static bool overlap(const Box3& a, const Box3& b) {
    return a.min.x <= b.max.x && b.min.x <= a.max.x && a.min.y <= b.max.y && b.min.y <= a.max.y && a.min.z <= b.max.z &&
           b.min.z <= a.max.z;
  }

 private:
  class Builder;

  std::vector<Node> nodes_; ///< preorder; node 0 is the root
  std::vector<std::uint32_t> order_;
};

} // namespace eigencrust
