// SPDX-License-Identifier: GPL-3.0-or-later
// §3.1: what the scanner looked through is outside.
#include <algorithm>
#include <atomic>
#include <limits>
#include <memory>
#include <tuple>

#include <eigencrust/stages.h>

#include "evidence/contradictions.h"
#include "parallel/compressed_rows.h"
#include "tetrahedra/segment_walk.h"

namespace eigencrust {
namespace {

// A single sample in front of a tetrahedron may be an outlier.
constexpr std::uint32_t least_doubt = 2;
// The lines of a façade's cameras and of one range image are within 60° of their mean, those of scans from around
// reach 98° and more.
constexpr double least_cosine = 0.5;

/// Lines per tetrahedron. Whole numbers that only grow: the sums do not depend on the order of the lines.
class Tally {
 public:
  explicit Tally(std::size_t n) : counts_(std::make_unique<std::atomic<std::uint32_t>[]>(n)) {}
  void add(TetrahedronIndex i) { counts_[i.value].fetch_add(1, std::memory_order_relaxed); }
  std::uint32_t operator[](TetrahedronIndex i) const { return counts_[i.value].load(std::memory_order_relaxed); }

 private:
  std::unique_ptr<std::atomic<std::uint32_t>[]> counts_;
};

/// Places on a line.
class Ray {
 public:
  Ray(const Tetrahedralization& t, const SightLine& line)
      : t_(t), start_(t.positions[line.sample]), depth_(static_cast<double>(line.depth)) {
    const Vec3 way = line.target - start_;
    direction_ = (1 / norm(way)) * way;
  }
  [[nodiscard]] Vec3 at(double depth) const { return start_ + depth * direction_; }
  /// Is the middle of the way through the tetrahedron away from its vertices? Lines at a grazing angle dip into what
  /// other scans put a little higher; there they are close to samples.
  [[nodiscard]] bool is_clear(const SegmentWalk& walk) const {
    const Vec3 middle = at((walk.depth() + walk.exit_depth()) / 2);
    for (const VertexIndex s : t_.tetrahedra[walk.tetrahedron()])
      if (squared_norm(t_.positions[s] - middle) <= depth_ * depth_) return false;
    return true;
  }

 private:
  const Tetrahedralization& t_;
  Vec3 start_, direction_;
  double depth_;
};

/// What holds the places half a depth and one depth behind the sample, seen from the scanner.
void count_behind(const Tetrahedralization& t, const VertexStars& stars, const SightLine& line, Tally& behind) {
  const double depth = static_cast<double>(line.depth);
  SegmentWalk walk(t, stars, line.sample, Ray(t, line).at(-2 * depth)); // farther than needed: it ends before its end
  while (walk.next() && walk.depth() <= depth) {
    for (const double place : {depth / 2, depth})
      if (walk.depth() <= place && place < walk.exit_depth()) behind.add(walk.tetrahedron());
  }
}

/// Where the line from a sample ends: the scanner, or a place outside the samples' box when that comes first. Beyond
/// it there are only tetrahedra at the cube.
Vec3 target_of(const Sensor& sensor, const Vec3& origin, const Box3& box, const Vec3& sample) {
  const Vec3 way = sensor.at_infinity ? sensor.place : (sensor.place - origin) - sample;
  const double size = std::max({std::fabs(way.x), std::fabs(way.y), std::fabs(way.z)});
  if (!(size > 0)) return sample;
  const Vec3 scaled = (1 / size) * way; // coordinates may be so large that their squares overflow
  double leave = std::numeric_limits<double>::infinity();
  for (const auto& [at, step, low, high] :
       {std::tuple{sample.x, scaled.x, box.min.x, box.max.x}, std::tuple{sample.y, scaled.y, box.min.y, box.max.y},
        std::tuple{sample.z, scaled.z, box.min.z, box.max.z}})
    if (step != 0) leave = std::min(leave, ((step > 0 ? high : low) - at) / step);
  if (!sensor.at_infinity && size <= leave) return sensor.place - origin;
  return sample + leave * scaled;
}

/// The samples' box and a margin that no rounding takes up.
Box3 wide_box(const Tetrahedralization& t) {
  Box3 box;
  for (std::uint32_t i = 0; i < t.sample_count; ++i) box.add(t.positions.raw()[i]);
  const double margin = box.diagonal();
  box.min = box.min - Vec3{margin, margin, margin};
  box.max = box.max + Vec3{margin, margin, margin};
  return box;
}

} // namespace

std::vector<SightLine> sight_lines(const PointCloud& cloud, std::span<const SampleIndex> sample_of,
                                   const Tetrahedralization& t, SampleLengthsView depth, SampleLengthsView left_out) {
  std::vector<SightLine> lines;
  if (cloud.sensor_of.empty()) return lines;
  const Box3 box = wide_box(t);
  for (std::size_t row = 0; row < sample_of.size(); ++row) {
    const SampleIndex s = sample_of[row];
    const std::uint32_t sensor = cloud.sensor_of[row];
    if (!s.valid() || sensor == PointCloud::no_sensor || (!left_out.empty() && left_out[s] > 0)) continue;
    lines.push_back({s, depth[s], target_of(cloud.sensors[sensor], t.origin, box, t.positions[s])});
  }
  // In the order of the samples neighbouring lines go through the same tetrahedra.
  const auto key = [](const SightLine& l) { return std::pair(l.sample, l.target); };
  std::sort(lines.begin(), lines.end(), [&](const SightLine& a, const SightLine& b) { return key(a) < key(b); });
  lines.erase(
      std::unique(lines.begin(), lines.end(), [&](const SightLine& a, const SightLine& b) { return key(a) == key(b); }),
      lines.end());
  return lines;
}

std::optional<OneSided> one_sided_scan(const Tetrahedralization& t, std::span<const SightLine> lines) {
  const auto direction_of = [&](const SightLine& line) {
    const Vec3 way = line.target - t.positions[line.sample];
    const double length = norm(way);
    return length > 0 ? (1 / length) * way : Vec3{};
  };
  Vec3 sum;
  for (const SightLine& line : lines) sum = sum + direction_of(line);
  if (!(norm(sum) > 0)) return std::nullopt;
  const Vec3 mean = (1 / norm(sum)) * sum;
  double least = 1;
  for (const SightLine& line : lines) least = std::min(least, dot(direction_of(line), mean));
  if (least < least_cosine) return std::nullopt;
  return OneSided{mean, std::acos(least)};
}

SightCrossings sight_crossings(const Tetrahedralization& t, const VertexStars& stars, std::span<const SightLine> lines,
                               Weights weights, const Labels& known, const Threads& threads) {
  auto rows = build_rows<TetrahedronIndex>(threads, lines.size(), costly_block, [&] {
    return [&](std::size_t i, std::vector<TetrahedronIndex>& crossed) {
      SegmentWalk walk(t, stars, lines[i].sample, lines[i].target);
      const Ray ray(t, lines[i]);
      while (walk.next())
        if (walk.depth() > static_cast<double>(lines[i].depth) && known[walk.tetrahedron()] != Label::outside &&
            (weights == Weights::paper || ray.is_clear(walk)))
          crossed.push_back(walk.tetrahedron());
    };
  });
  return {std::move(rows.begin), std::move(rows.item)};
}

SightLabels line_of_sight(const Tetrahedralization& t, const VertexStars& stars, std::span<const SightLine> lines,
                          const SightCrossings& crossings, const SightRule& rule, const Labels& known,
                          const Threads& threads) {
  Tally behind(t.tetrahedra.size()), crossed(t.tetrahedra.size()), believed(t.tetrahedra.size());
  if (rule.weights == Weights::evidence)
    for_each_index(
        threads, lines.size(), [&](std::size_t i) { count_behind(t, stars, lines[i], behind); }, costly_block);
  for_each_index(threads, crossings.tetrahedra.size(), [&](std::size_t i) { crossed.add(crossings.tetrahedra[i]); });
  const auto is_believed = [&](std::size_t line) {
    return std::none_of(crossings[line].begin(), crossings[line].end(),
                        [&](TetrahedronIndex at) { return behind[at] >= least_doubt && behind[at] > crossed[at]; });
  };
  SightLabels result;
  result.disbelieved = sum_blocks<std::uint64_t>(
      threads, lines.size(),
      [&](std::size_t begin, std::size_t end) {
        std::uint64_t disbelieved = 0;
        for (std::size_t i = begin; i < end; ++i) {
          if (is_believed(i))
            for (const TetrahedronIndex at : crossings[i]) believed.add(at);
          else
            ++disbelieved;
        }
        return disbelieved;
      },
      costly_block);
  constexpr std::uint32_t most = std::numeric_limits<std::uint8_t>::max();
  result.front = result.behind = IndexedArray<TetrahedronIndex, std::uint8_t>(known.size());
  for_each_index(threads, known.size(), [&](std::size_t i) {
    const TetrahedronIndex at{static_cast<std::uint32_t>(i)};
    result.front[at] = static_cast<std::uint8_t>(std::min(most, believed[at]));
    result.behind[at] = static_cast<std::uint8_t>(std::min(most, behind[at]));
  });
  result.labels = known;
  const std::uint32_t least_lines = rule.weights == Weights::paper ? 2 : 1; // "more than once"
  // Behind a thin part a tetrahedron may reach out to an outlier.
  const auto holds_isolated = [&](TetrahedronIndex at) {
    return !rule.isolated.empty() && std::any_of(t.tetrahedra[at].begin(), t.tetrahedra[at].end(), [&](VertexIndex v) {
      return !t.is_corner(v) && rule.isolated[t.sample(v)] > 0;
    });
  };
  for_each_index(threads, known.size(), [&](std::size_t i) {
    const TetrahedronIndex at{static_cast<std::uint32_t>(i)};
    if (known[at] != Label::unlabelled) return;
    if (believed[at] >= least_lines && believed[at] > behind[at]) result.labels[at] = Label::outside;
    if (behind[at] > 0 && crossed[at] == 0 && !holds_isolated(at)) result.labels[at] = Label::inside;
  });
  for (std::size_t i = 0; i < known.size(); ++i) {
    if (known.raw()[i] != Label::unlabelled) continue;
    result.outside += result.labels.raw()[i] == Label::outside;
    result.inside += result.labels.raw()[i] == Label::inside;
  }
  return result;
}

std::uint64_t contradicting_lines(const SightCrossings& crossings, const Labels& labels, const Threads& threads) {
  return sum_blocks<std::uint64_t>(
      threads, crossings.begin.empty() ? 0 : crossings.begin.size() - 1,
      [&](std::size_t begin, std::size_t end) {
        std::uint64_t contradicting = 0;
        for (std::size_t i = begin; i < end; ++i)
          contradicting += std::any_of(crossings[i].begin(), crossings[i].end(),
                                       [&](TetrahedronIndex at) { return labels[at] == Label::inside; });
        return contradicting;
      },
      costly_block);
}

} // namespace eigencrust
