// SPDX-License-Identifier: GPL-3.0-or-later
#include "tetrahedra/sample_blocks.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace eigencrust {
namespace {

/// How many groups of `branches` hold `count` things.
std::size_t groups_of(std::size_t count) { return (count + SampleBlocks::branches - 1) / SampleBlocks::branches; }

} // namespace

SampleBlocks::Node::Node() {
  for (std::size_t i = 0; i < branches; ++i) set(i, {});
}

void SampleBlocks::Node::set(std::size_t child, const Box3& box) {
  min_x[child] = box.min.x;
  min_y[child] = box.min.y;
  min_z[child] = box.min.z;
  max_x[child] = box.max.x;
  max_y[child] = box.max.y;
  max_z[child] = box.max.z;
}

Box3 SampleBlocks::Node::around() const {
  Box3 all;
  for (std::size_t i = 0; i < branches; ++i) {
    if (!(min_x[i] <= max_x[i])) continue; // there is no such child
    all.add({min_x[i], min_y[i], min_z[i]});
    all.add({max_x[i], max_y[i], max_z[i]});
  }
  return all;
}

SampleBlocks::SampleBlocks(std::span<const Vec3> samples, const Threads& threads) : samples_(samples) {
  std::vector<Box3> boxes(groups_of(samples.size()));
  for_each_index(threads, boxes.size(), [&](std::size_t b) {
    const std::size_t end = std::min(samples.size(), (b + 1) * branches);
    for (std::size_t s = b * branches; s < end; ++s) boxes[b].add(samples[s]);
  });
  do {
    std::vector<Node>& level = levels_.emplace_back(groups_of(boxes.size()));
    std::vector<Box3> around(level.size());
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      level[i / branches].set(i % branches, boxes[i]);
    }
    for (std::size_t i = 0; i < level.size(); ++i) around[i] = level[i].around();
    boxes = std::move(around);
  } while (boxes.size() > 1);
}

Box3 SampleBlocks::box_of_block(std::uint32_t block) const { return levels_.front()[block].around(); }

double SampleBlocks::distance_to_others(const Box3& box, const SampleRange& left_out) const {
  double squared = std::numeric_limits<double>::infinity();
  std::uint64_t looked_at = 0;
  walk(box, left_out, squared, looked_at, [&](std::uint32_t s) {
    const Vec3& p = samples_[s];
    squared = std::min(squared, squared_norm({gap(box.min.x, box.max.x, p.x, p.x), gap(box.min.y, box.max.y, p.y, p.y),
                                              gap(box.min.z, box.max.z, p.z, p.z)}));
  });
  return std::sqrt(squared);
}

} // namespace eigencrust
