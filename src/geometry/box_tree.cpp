// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/box_tree.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace eigencrust {
namespace {

// Parts of the tree with fewer items are built by one thread each.
constexpr std::uint32_t items_of_a_part = 16384;

void add(Box3& box, const Vec3& p) {
  box.min = {std::min(box.min.x, p.x), std::min(box.min.y, p.y), std::min(box.min.z, p.z)};
  box.max = {std::max(box.max.x, p.x), std::max(box.max.y, p.y), std::max(box.max.z, p.z)};
}

void add(Box3& box, const Box3& other) {
  add(box, other.min);
  add(box, other.max);
}

/// Of trees of n and of n + 1 items: halves of both have n / 2 or n / 2 + 1.
std::pair<std::uint32_t, std::uint32_t> node_counts(std::uint32_t n) {
  if (n + 1 <= BoxTree::leaf_size) return {1, 1};
  const auto [half, half_and_one] = node_counts(n / 2);
  const std::uint32_t even = 1 + 2 * half, odd = 1 + half + half_and_one, next = 1 + 2 * half_and_one;
  const auto count = [](std::uint32_t items, std::uint32_t nodes) { return items <= BoxTree::leaf_size ? 1 : nodes; };
  return n % 2 == 0 ? std::pair(count(n, even), count(n + 1, odd)) : std::pair(count(n, odd), count(n + 1, next));
}

} // namespace

/// Where nodes stand follows from the numbers of items alone, so parts can be built side by side.
class BoxTree::Builder {
 public:
  Builder(BoxTree& tree, std::span<const Box3> boxes, const Threads& threads)
      : tree_(tree), boxes_(boxes), items_(boxes.size()) {
    const Box3 whole = bounds_of(boxes, threads);
    const Vec3 middle = whole.centre();
    const Vec3 half = 0.5 * whole.max - 0.5 * whole.min;
    const double largest = std::max({half.x, half.y, half.z});
    const double scale = largest > 0 && std::isfinite(1 / largest) ? 1 / largest : 0;
    for_each_index(threads, items_.size(), [&](std::size_t i) {
      const Vec3 at = scale * (boxes[i].centre() - middle);
      items_[i] = {{static_cast<float>(at.x), static_cast<float>(at.y), static_cast<float>(at.z)},
                   static_cast<std::uint32_t>(i)};
    });
  }

  void run(const Threads& threads) {
    std::vector<Part> open{{0, 0, static_cast<std::uint32_t>(boxes_.size())}};
    std::vector<std::uint32_t> above;
    for (bool wide = open[0].end > items_of_a_part; wide; wide = open[0].end - open[0].begin > items_of_a_part) {
      std::vector<Part> halves(2 * open.size()); // all parts have the same number of items, or one more
      threads.run(open.size(), [&](std::size_t p) { std::tie(halves[2 * p], halves[2 * p + 1]) = split(open[p]); });
      for (const Part& part : open) above.push_back(part.node);
      open.swap(halves);
    }
    threads.run(open.size(), [&](std::size_t p) { build(open[p]); });
    for (auto node = above.rbegin(); node != above.rend(); ++node) join(*node); // children come after their parents
  }

 private:
  struct Part {
    std::uint32_t node, begin, end;
  };
  /// Where a box stands to float precision, in units of half the largest side of all: only the shape of the tree hangs
  /// on it.
  struct Item {
    std::array<float, 3> centre;
    std::uint32_t number;
  };

  static Box3 bounds_of(std::span<const Box3> boxes, const Threads& threads) {
    std::vector<Box3> parts((boxes.size() + default_block - 1) / default_block);
    for_blocks(threads, boxes.size(), default_block, [&](std::size_t begin, std::size_t end, std::size_t b) {
      for (std::size_t i = begin; i < end; ++i) add(parts[b], boxes[i]);
    });
    Box3 whole;
    for (const Box3& part : parts) add(whole, part);
    return whole;
  }

  void build(const Part& part) {
    if (part.end - part.begin > leaf_size) {
      const auto [left, right] = split(part);
      build(left);
      build(right);
      join(part.node);
      return;
    }
    const auto first = tree_.order_.begin() + part.begin, last = tree_.order_.begin() + part.end;
    for (std::uint32_t i = part.begin; i < part.end; ++i) tree_.order_[i] = items_[i].number;
    std::sort(first, last);
    Node& node = tree_.nodes_[part.node];
    node.first = part.begin;
    node.count = part.end - part.begin;
    std::for_each(first, last, [&](std::uint32_t item) { add(node.box, boxes_[item]); });
  }

  std::pair<Part, Part> split(const Part& part) {
    std::array<float, 3> low = items_[part.begin].centre, high = low;
    for (std::uint32_t i = part.begin; i < part.end; ++i)
      for (std::size_t k = 0; k < 3; ++k) {
        low[k] = std::min(low[k], items_[i].centre[k]);
        high[k] = std::max(high[k], items_[i].centre[k]);
      }
    const auto size = [&](std::size_t k) { return high[k] - low[k]; };
    const std::uint32_t middle = part.begin + (part.end - part.begin) / 2;
    if (size(2) > std::max(size(0), size(1)))
      part_by<2>(part, middle);
    else if (size(1) > size(0))
      part_by<1>(part, middle);
    else
      part_by<0>(part, middle);
    const std::uint32_t left = part.node + 1, right = left + node_counts(middle - part.begin).first;
    tree_.nodes_[part.node].first = right;
    return {{left, part.begin, middle}, {right, middle, part.end}};
  }

  template <std::size_t axis>
  void part_by(const Part& part, std::uint32_t middle) {
    // Ties go by number: the tree is the same whatever the library's selection algorithm does.
    const auto before = [](const Item& a, const Item& b) {
      return a.centre[axis] < b.centre[axis] || (a.centre[axis] == b.centre[axis] && a.number < b.number);
    };
    const auto first = items_.begin();
    std::nth_element(first + part.begin, first + middle, first + part.end, before);
  }

  void join(std::uint32_t node) {
    Box3& box = tree_.nodes_[node].box;
    add(box, tree_.nodes_[node + 1].box);
    add(box, tree_.nodes_[tree_.nodes_[node].first].box);
  }

  BoxTree& tree_;
  std::span<const Box3> boxes_;
  std::vector<Item> items_; ///< moved as a whole: what is compared lies side by side
};

std::vector<BoxTree::NodePair> BoxTree::parts_of_join() const {
  constexpr std::size_t enough = 512; // for many threads, and short beside the whole
  std::vector<NodePair> parts;
  if (!nodes_.empty()) parts.push_back({0, 0});
  for (bool split = true; split && parts.size() < enough;) {
    split = false;
    std::vector<NodePair> next;
    for (const NodePair& part : parts) {
      const auto [a, b] = part;
      if (nodes_[a].count > 0 && nodes_[b].count > 0) {
        next.push_back(part);
        continue;
      }
      split = true;
      for_each_child_pair(part, [&](const NodePair& child) {
        if (child[0] == child[1] || overlap(nodes_[child[0]].box, nodes_[child[1]].box)) next.push_back(child);
      });
    }
    parts = std::move(next);
  }
  return parts;
}

BoxTree::BoxTree(std::span<const Box3> boxes, const Threads& threads) : order_(boxes.size()) {
  if (boxes.empty()) return;
  nodes_.resize(node_counts(static_cast<std::uint32_t>(boxes.size())).first);
  Builder(*this, boxes, threads).run(threads);
}

} // namespace eigencrust
