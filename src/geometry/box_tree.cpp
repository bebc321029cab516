// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/box_tree.h"

#include <algorithm>
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
  Builder(BoxTree& tree, std::span<const Box3> boxes) : tree_(tree), boxes_(boxes), items_(boxes.size()) {
    for (std::uint32_t i = 0; i < items_.size(); ++i) items_[i] = {boxes[i].centre(), i};
  }

  void run(const Threads& threads) {
    const Part whole{0, 0, static_cast<std::uint32_t>(boxes_.size())};
    std::vector<Part> open{whole}, parts;
    std::vector<std::uint32_t> above;
    while (!open.empty()) {
      const Part part = open.back();
      open.pop_back();
      if (part.end - part.begin <= items_of_a_part) {
        parts.push_back(part);
        continue;
      }
      above.push_back(part.node);
      const auto [left, right] = split(part);
      open.push_back(right);
      open.push_back(left);
    }
    threads.run(parts.size(), [&](std::size_t p) { build(parts[p]); });
    for (auto node = above.rbegin(); node != above.rend(); ++node) join(*node); // children come after their parents
  }

 private:
  struct Part {
    std::uint32_t node, begin, end;
  };
  struct Item {
    Vec3 centre;
    std::uint32_t number;
  };

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
    const auto first = items_.begin();
    Box3 spread;
    for (std::uint32_t i = part.begin; i < part.end; ++i) add(spread, items_[i].centre);
    const Vec3 size = spread.max - spread.min;
    double Vec3::*axis = &Vec3::x;
    if (size.y > size.*axis) axis = &Vec3::y;
    if (size.z > size.*axis) axis = &Vec3::z;
    // Ties go by number: the tree is the same whatever the library's selection algorithm does.
    const auto before = [&](const Item& a, const Item& b) {
      const double ka = a.centre.*axis, kb = b.centre.*axis;
      return ka < kb || (ka == kb && a.number < b.number);
    };
    const std::uint32_t middle = part.begin + (part.end - part.begin) / 2;
    std::nth_element(first + part.begin, first + middle, first + part.end, before);
    const std::uint32_t left = part.node + 1, right = left + node_counts(middle - part.begin).first;
    tree_.nodes_[part.node].first = right;
    return {{left, part.begin, middle}, {right, middle, part.end}};
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
  Builder(*this, boxes).run(threads);
}

} // namespace eigencrust
