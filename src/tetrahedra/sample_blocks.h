// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Searches among the samples that a part of the triangulation does not hold.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include <eigencrust/types.h>

#include "parallel/threads.h"
#include "tetrahedra/circumsphere.h"

namespace eigencrust {

/// What everyone knows of a block of samples.
struct BlockSketch {
  Box3 box; ///< around the samples
  /// The middle, axes and half lengths of another box around them, turned as they lie: thin where they are of a
  /// surface, so that spheres that touch the surface nearby do not meet it.
  Vec3 middle;
  std::array<Vec3, 3> axis;
  std::array<double, 3> half{};
  Vec3 scout;
  std::uint32_t scout_sample = 0; ///< the one nearest to the middle of the box

  /// No point of the turned box has less.
  [[nodiscard]] double least_power(const Circumsphere& sphere) const {
    const Vec3 seen = middle - sphere.eye;
    Vec3 nearest = seen;
    for (std::size_t k = 0; k < axis.size(); ++k)
      nearest = nearest + std::clamp(dot(sphere.centre - seen, axis[k]), -half[k], half[k]) * axis[k];
    return sphere.least_of_body(sphere.power(sphere.eye + nearest));
  }
};

/// Samples that follow one another along the Hilbert curve.
struct SampleRange {
  std::uint32_t begin = 0, end = 0;
  [[nodiscard]] bool holds(std::uint32_t sample) const { return begin <= sample && sample < end; }
  [[nodiscard]] std::uint32_t size() const { return end - begin; }
};

/// How far two intervals are apart, 0 where they meet.
inline double gap(double a_min, double a_max, double b_min, double b_max) {
  return std::max(std::max(a_min - b_max, b_min - a_max), 0.0);
}

/// A tree of boxes around consecutive samples, eight to each: neighbours along the Hilbert curve are neighbours in
/// space, so the boxes are small, and a range of samples is a few of them. The samples themselves may be elsewhere,
/// block by block, until they are learned.
class SampleBlocks {
 public:
  static constexpr std::uint32_t branches = 8;
  static constexpr std::uint32_t block_size = branches * branches;

  /// Knows all samples.
  /// \param samples along the Hilbert curve, at least one; they outlive the boxes
  SampleBlocks(std::span<const Vec3> samples, const Threads& threads);

  /// Knows no sample yet but a scout of each block.
  /// \param count of the samples, at least one
  SampleBlocks(std::uint32_t count, std::vector<BlockSketch> sketches);

  SampleBlocks(const SampleBlocks&) = delete;
  SampleBlocks& operator=(const SampleBlocks&) = delete;

  [[nodiscard]] std::uint32_t sample_count() const { return count_; }
  [[nodiscard]] std::uint32_t block_count() const { return static_cast<std::uint32_t>(blocks_.size()); }
  /// The samples [block, block + 1) * block_size; the last block may have fewer.
  [[nodiscard]] SampleRange samples_of(std::uint32_t block) const { return range_of(block_level, block); }
  [[nodiscard]] bool knows(std::uint32_t block) const { return blocks_[block].samples != nullptr; }
  /// \param samples of a block that was not known; copied
  void learn(std::uint32_t block, std::span<const Vec3> samples);
  /// Of a scout, or a sample whose block is known.
  [[nodiscard]] const Vec3& position(std::uint32_t sample) const {
    const std::uint32_t block = sample / block_size;
    return knows(block) ? blocks_[block].samples[sample % block_size] : sketches_[block].scout;
  }
  /// Around the samples of a block, known or not.
  [[nodiscard]] Box3 box_of_block(std::uint32_t block) const;
  /// Of a block that is known.
  [[nodiscard]] BlockSketch sketch_of(std::uint32_t block) const;

  /// The sample deepest inside a sphere, of those not in `left_out` of which accept(sample, power) is true. What lies
  /// outside for certain is not asked for.
  /// \param looked_at is added how many nodes were looked at
  /// \param absent is called with blocks that would have to be known for more than a scout
  template <class Accept, class Absent>
  std::optional<std::uint32_t> deepest(const Circumsphere& sphere, const SampleRange& left_out,
                                       std::uint64_t& looked_at, Accept&& accept, Absent&& absent) const {
    std::optional<std::uint32_t> found;
    double most = 0;
    const auto visit = [&](std::uint32_t s) {
      const Power power = sphere.power(position(s));
      if (power.value - power.doubt > most || !accept(s, power)) return;
      found = s;
      most = power.value;
    };
    const auto bounds = [&](const Node& node) { return node.least_powers(sphere); };
    walk(bounds, left_out, most, looked_at, visit, [&](const Place& block) {
      const BlockSketch& sketch = sketches_[block.index];
      if (sketch.least_power(sphere) > most) return;
      visit(sketch.scout_sample);
      absent(block.index);
    });
    return found;
  }

  /// A length that no sample outside `left_out` is nearer to the box than; infinite where there is none.
  [[nodiscard]] double distance_to_others(const Box3& box, const SampleRange& left_out) const;

 private:
  /// The boxes of eight children, coordinate by coordinate: processors compare several at once.
  struct Node {
    using Eight = std::array<double, branches>;
    Eight min_x, min_y, min_z, max_x, max_y, max_z;
    Node();
    void set(std::size_t child, const Box3& box);
    [[nodiscard]] Box3 child(std::size_t i) const;
    [[nodiscard]] Box3 around() const;
    /// From each child to a box.
    [[nodiscard]] Eight squared_distances(const Box3& to) const {
      Eight result{};
      add_squared_gaps(min_x, max_x, to.min.x, to.max.x, result);
      add_squared_gaps(min_y, max_y, to.min.y, to.max.y, result);
      add_squared_gaps(min_z, max_z, to.min.z, to.max.z, result);
      return result;
    }
    static void add_squared_gaps(const Eight& min, const Eight& max, double to_min, double to_max, Eight& sum) {
      for (std::size_t i = 0; i < branches; ++i) {
        const double length = gap(min[i], max[i], to_min, to_max);
        sum[i] += length * length;
      }
    }
    /// No sample of a child has less; of a child that there is not, nothing is said.
    [[nodiscard]] Eight least_powers(const Circumsphere& sphere) const {
      Eight power{}, doubt{};
      add_powers(min_x, max_x, sphere.eye.x, sphere.centre.x, power, doubt);
      add_powers(min_y, max_y, sphere.eye.y, sphere.centre.y, power, doubt);
      add_powers(min_z, max_z, sphere.eye.z, sphere.centre.z, power, doubt);
      for (std::size_t i = 0; i < branches; ++i)
        power[i] = sphere.least_of_body({power[i], 2 * sphere.doubt * doubt[i]});
      return power;
    }
    static void add_powers(const Eight& min, const Eight& max, double eye, double centre, Eight& power, Eight& doubt) {
      for (std::size_t i = 0; i < branches; ++i) {
        const double nearest = std::min(std::max(centre, min[i] - eye), max[i] - eye);
        power[i] += nearest * (nearest - 2 * centre);
        doubt[i] += std::fabs(nearest);
      }
    }
  };
  struct Place {
    std::uint32_t level, index;
    double bound;
  };
  /// Groups of eight samples are the level below, blocks of blocks those above.
  static constexpr std::uint32_t block_level = 1;
  /// Null where they are elsewhere.
  struct Block {
    const Vec3* samples = nullptr;
    const Node* groups = nullptr;
  };
  struct Learned {
    std::array<Vec3, block_size> samples;
    Node groups;
  };

  void build_above(std::vector<Box3> boxes);
  static void set_groups(std::span<const Vec3> samples, Node& groups);

  /// Walking down, no more than eight wait on each of the eleven levels that 2^32 samples have.
  static constexpr std::size_t most_waiting = 8 * 11;

  /// visit(sample) for those in groups of which bounds(node) are not more than `most`, which visit may make smaller,
  /// and absent(place) for such blocks that are elsewhere.
  template <class Bounds, class Visit, class Absent>
  void walk(Bounds&& bounds, const SampleRange& left_out, const double& most, std::uint64_t& looked_at, Visit&& visit,
            Absent&& absent) const {
    std::array<Place, most_waiting> waiting;
    std::size_t count = 0;
    waiting[count++] = {static_cast<std::uint32_t>(block_level + above_.size()), 0,
                        -std::numeric_limits<double>::infinity()};
    while (count > 0) {
      const Place place = waiting[--count];
      if (place.bound > most) continue;
      ++looked_at;
      if (place.level == 0) {
        const SampleRange range = range_of(place.level, place.index);
        for (std::uint32_t s = range.begin; s < range.end; ++s)
          if (!left_out.holds(s)) visit(s);
        continue;
      }
      if (place.level == block_level && !knows(place.index)) {
        absent(place);
        continue;
      }
      const auto bound = bounds(node_at(place));
      std::size_t nearest = count;
      for (std::uint32_t i = 0; i < branches; ++i) {
        const Place child{place.level - 1, place.index * branches + i, bound[i]};
        const SampleRange range = range_of(child.level, child.index);
        if (child.bound > most || range.size() == 0 || lies_within(range, left_out)) continue;
        if (count == nearest || child.bound < waiting[nearest].bound) nearest = count;
        waiting[count++] = child;
      }
      if (nearest < count) std::swap(waiting[nearest], waiting[count - 1]); // it is the next
    }
  }

  /// Of blocks that are known, and of all above.
  [[nodiscard]] const Node& node_at(const Place& place) const {
    return place.level == block_level ? *blocks_[place.index].groups
                                      : above_[place.level - block_level - 1][place.index];
  }

  [[nodiscard]] SampleRange range_of(std::uint32_t level, std::uint32_t index) const {
    const std::uint64_t n = count_, shift = 3 * (level + 1), first = index;
    return {static_cast<std::uint32_t>(std::min(n, first << shift)),
            static_cast<std::uint32_t>(std::min(n, (first + 1) << shift))};
  }
  static bool lies_within(const SampleRange& inner, const SampleRange& outer) {
    return outer.begin <= inner.begin && inner.end <= outer.end;
  }

  std::uint32_t count_;
  std::vector<Block> blocks_;
  std::vector<std::vector<Node>> above_; ///< over eight blocks each, over eight of those, and so on to one
  std::vector<Node> groups_;             ///< where all samples are known
  std::vector<BlockSketch> sketches_;    ///< else
  std::deque<Learned> learned_;
};

} // namespace eigencrust
