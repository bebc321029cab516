// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/box_tree.h"

#include <algorithm>
#include <numeric>

namespace eigencrust {

BoxTree::BoxTree(std::span<const Box3> boxes) : order_(boxes.size()) {
  std::iota(order_.begin(), order_.end(), 0u);
  std::vector<Vec3> centres(boxes.size());
  std::transform(boxes.begin(), boxes.end(), centres.begin(), [](const Box3& b) { return b.centre(); });
  nodes_.reserve(boxes.size());
  if (!boxes.empty()) build(boxes, centres, 0, static_cast<std::uint32_t>(boxes.size()));
}

void BoxTree::build(std::span<const Box3> boxes, std::span<const Vec3> centres, std::uint32_t begin,
                    std::uint32_t end) {
  const std::size_t self = nodes_.size();
  nodes_.emplace_back();
  Box3 box, spread;
  for (std::uint32_t i = begin; i < end; ++i) {
    const Box3& item = boxes[order_[i]];
    box.add(item.min);
    box.add(item.max);
    spread.add(centres[order_[i]]);
  }
  nodes_[self].box = box;
  if (end - begin <= leaf_size) {
    std::sort(order_.begin() + begin, order_.begin() + end);
    nodes_[self].first = begin;
    nodes_[self].count = end - begin;
    return;
  }
  const Vec3 size = spread.max - spread.min;
  double Vec3::*axis = &Vec3::x;
  if (size.y > size.*axis) axis = &Vec3::y;
  if (size.z > size.*axis) axis = &Vec3::z;
  // Ties go by number: the tree is the same whatever the library's selection algorithm does.
  const auto before = [&](std::uint32_t a, std::uint32_t b) {
    const double ka = centres[a].*axis, kb = centres[b].*axis;
    return ka < kb || (ka == kb && a < b);
  };
  const std::uint32_t middle = begin + (end - begin) / 2;
  std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end, before);
  build(boxes, centres, begin, middle);
  nodes_[self].first = static_cast<std::uint32_t>(nodes_.size());
  build(boxes, centres, middle, end);
}

} // namespace eigencrust
