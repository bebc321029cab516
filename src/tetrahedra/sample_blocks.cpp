// SPDX-License-Identifier: GPL-3.0-or-later
#include "tetrahedra/sample_blocks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "samples/local_frame.h"

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

Box3 SampleBlocks::Node::child(std::size_t i) const {
  return {{min_x[i], min_y[i], min_z[i]}, {max_x[i], max_y[i], max_z[i]}};
}

Box3 SampleBlocks::Node::around() const {
  Box3 all;
  for (std::size_t i = 0; i < branches; ++i) {
    if (!(min_x[i] <= max_x[i])) continue; // there is no such child
    all.add(child(i).min);
    all.add(child(i).max);
  }
  return all;
}

SampleBlocks::SampleBlocks(std::span<const Vec3> samples, const Threads& threads)
    : count_(static_cast<std::uint32_t>(samples.size())), blocks_(groups_of(groups_of(samples.size()))) {
  groups_.resize(blocks_.size());
  std::vector<Box3> boxes(blocks_.size());
  for_each_index(threads, blocks_.size(), [&](std::size_t b) {
    const SampleRange range = samples_of(static_cast<std::uint32_t>(b));
    set_groups(samples.subspan(range.begin, range.size()), groups_[b]);
    blocks_[b] = {samples.data() + range.begin, &groups_[b]};
    boxes[b] = groups_[b].around();
  });
  build_above(std::move(boxes));
}

SampleBlocks::SampleBlocks(std::uint32_t count, std::vector<BlockSketch> sketches)
    : count_(count), blocks_(sketches.size()), sketches_(std::move(sketches)) {
  std::vector<Box3> boxes;
  for (const BlockSketch& sketch : sketches_) boxes.push_back(sketch.box);
  build_above(std::move(boxes));
}

void SampleBlocks::build_above(std::vector<Box3> boxes) {
  do {
    std::vector<Node>& level = above_.emplace_back(groups_of(boxes.size()));
    for (std::size_t i = 0; i < boxes.size(); ++i) level[i / branches].set(i % branches, boxes[i]);
    std::vector<Box3> around(level.size());
    for (std::size_t i = 0; i < level.size(); ++i) around[i] = level[i].around();
    boxes = std::move(around);
  } while (boxes.size() > 1);
}

void SampleBlocks::learn(std::uint32_t block, std::span<const Vec3> samples) {
  Learned& known = learned_.emplace_back();
  std::copy(samples.begin(), samples.end(), known.samples.begin());
  set_groups(samples, known.groups);
  blocks_[block] = {known.samples.data(), &known.groups};
}

void SampleBlocks::set_groups(std::span<const Vec3> samples, Node& groups) {
  for (std::size_t g = 0; g < groups_of(samples.size()); ++g) {
    Box3 box;
    for (const Vec3& p : samples.subspan(g * branches, std::min<std::size_t>(branches, samples.size() - g * branches)))
      box.add(p);
    groups.set(g, box);
  }
}

Box3 SampleBlocks::box_of_block(std::uint32_t block) const {
  return above_.front()[block / branches].child(block % branches);
}

BlockSketch SampleBlocks::sketch_of(std::uint32_t block) const {
  const SampleRange range = samples_of(block);
  const std::span<const Vec3> samples(blocks_[block].samples, range.size());
  BlockSketch sketch;
  sketch.box = box_of_block(block);
  const Vec3 centre = sketch.box.centre();
  const auto nearest = std::min_element(samples.begin(), samples.end(), [&](const Vec3& a, const Vec3& b) {
    return squared_norm(a - centre) < squared_norm(b - centre);
  });
  sketch.scout = *nearest;
  sketch.scout_sample = range.begin + static_cast<std::uint32_t>(nearest - samples.begin());

  std::vector<std::uint32_t> all(samples.size());
  std::iota(all.begin(), all.end(), 0u);
  sketch.axis = local_frame(samples, all, centre).axis;
  sketch.middle = centre;
  const double rounding = 64 * std::numeric_limits<double>::epsilon() * (norm(centre) + sketch.box.diagonal());
  for (std::size_t k = 0; k < sketch.axis.size(); ++k) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Vec3& p : samples) {
      low = std::min(low, dot(p - centre, sketch.axis[k]));
      high = std::max(high, dot(p - centre, sketch.axis[k]));
    }
    sketch.middle = sketch.middle + (low + high) / 2 * sketch.axis[k];
    sketch.half[k] = (high - low) / 2 + rounding;
  }
  return sketch;
}

double SampleBlocks::distance_to_others(const Box3& box, const SampleRange& left_out) const {
  double squared = std::numeric_limits<double>::infinity();
  std::uint64_t looked_at = 0;
  walk([&](const Node& node) { return node.squared_distances(box); }, left_out, squared, looked_at,
       [&](std::uint32_t s) {
         const Vec3& p = position(s);
         squared =
             std::min(squared, squared_norm({gap(box.min.x, box.max.x, p.x, p.x), gap(box.min.y, box.max.y, p.y, p.y),
                                             gap(box.min.z, box.max.z, p.z, p.z)}));
       },
       [&](const Place& block) { squared = std::min(squared, block.bound); });
  return std::sqrt(squared);
}

} // namespace eigencrust
