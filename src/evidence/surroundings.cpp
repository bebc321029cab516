// SPDX-License-Identifier: GPL-3.0-or-later
#include "evidence/surroundings.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include <eigencrust/error.h>

#include "evidence/hull.h"
#include "parallel/compressed_rows.h"
#include "samples/scales.h"
#include "samples/two_sheets.h"
#include "tetrahedra/segment_walk.h"

namespace eigencrust {
namespace {

// Fewer samples say nothing of how they lie.
constexpr std::uint32_t least_samples = 100;
// So many of them are looked at.
constexpr std::uint32_t looked_at = 2048;
// Of ground with what stands on it, trees included, up to half of the area is stacked; of closed bodies two thirds and
// more.
constexpr double most_stacked = 0.5, perhaps_stacked = 0.65;
// Of roofs, hills and crowns of trees from the air, with a hundredth of strays, up to 0.15 of the samples are; of a
// wall with what hangs on it, scanned from the ground, 0.4.
constexpr double few_stacked = 0.2;
// Roofs without their walls have four times as much space behind them as in front, ground with objects at most as much.
constexpr double cap_of_body = 2;
// Lenses and plates thinner than their samples are apart are not stacked; but the hull goes along both of their sides.
constexpr double most_on_hull = 0.5;
// Walls lean by less than 15° (the sine), and are more of the hull than upright slivers at the rim of flat ground.
constexpr double most_leaning = 0.26, least_walls = 0.05;
// Two sheets are looked for among the samples within so many spacings across the axis, if they are so many, and are not
// a step: that has its halves side by side, by half of the way and more.
constexpr double sheet_radius = 3, most_aside = 0.35;
constexpr std::size_t least_in_sheets = 30;
// What stands on z is taken to be ground first: of two sides of a façade nothing tells the one that was seen.
constexpr int z = 2;

/// Samples spread evenly over all, at most about `looked_at`.
std::vector<SampleIndex> some_samples(const Tetrahedralization& t) {
  std::vector<SampleIndex> some;
  const std::uint32_t step = std::max(1u, t.sample_count / looked_at);
  for (std::uint32_t s = 0; s < t.sample_count; s += step) some.push_back(SampleIndex{s});
  return some;
}

double along(int axis, const Vec3& p) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }
double across(int axis, const Vec3& p, const Vec3& q) {
  return norm(p - q - along(axis, p - q) * direction_of(static_cast<Axis>(2 * axis)));
}

/// Square columns along an axis, each with those of some samples that are in it or in one beside it.
class Columns {
 public:
  Columns(const Tetrahedralization& t, int axis, std::span<const SampleIndex> some, double side)
      : axis_(axis), side_(side) {
    for (std::uint32_t k = 0; k < some.size(); ++k) {
      const Place place = place_of(t.positions[some[k]]);
      for (const std::int64_t u : {-1, 0, 1})
        for (const std::int64_t v : {-1, 0, 1}) entries_.push_back({{place[0] + u, place[1] + v}, k});
    }
    std::sort(entries_.begin(), entries_.end());
  }
  template <class Meet>
  void for_each_near(const Vec3& p, Meet&& meet) const {
    const Place place = place_of(p);
    for (auto i = std::lower_bound(entries_.begin(), entries_.end(), Entry{place, 0});
         i != entries_.end() && i->first == place; ++i)
      meet(i->second);
  }

 private:
  using Place = std::array<std::int64_t, 2>;
  using Entry = std::pair<Place, std::uint32_t>;

  [[nodiscard]] Place place_of(const Vec3& p) const {
    // What is beyond shares the outermost columns.
    constexpr double farthest = std::numeric_limits<std::int32_t>::max();
    const auto number = [&](double x) {
      return static_cast<std::int64_t>(std::clamp(std::floor(x / side_), -farthest, farthest));
    };
    return {number(axis_ == 0 ? p.y : p.x), number(axis_ == 2 ? p.y : p.z)};
  }

  int axis_;
  double side_;
  std::vector<Entry> entries_;
};

/// How far above a sample another one is, at that distance across, that nothing explains but something before or
/// behind it.
double unexplained_height(const SampleModel& model, SampleIndex s, double across) {
  // Two noisy samples differ by more than that once in fifty times; the rest is for what is flat only nearly.
  constexpr double noise_of_two = noise_bound * std::numbers::sqrt2, unevenness = 0.3, steepest = 2;
  return steepest * across + unevenness * static_cast<double>(model.spacing[s]) +
         noise_of_two * static_cast<double>(model.noise[s]);
}

/// How much of what was seen has something above or below it.
struct StackedShare {
  double of_samples, of_area;
};
StackedShare share_stacked(const Scene& scene, int axis, const Threads& threads) {
  const Tetrahedralization& t = scene.tetrahedralization;
  const SampleModel& model = scene.measures.model;
  // Isolated samples have wide spacings, which would make all columns wide.
  const double widest = 2 * model.typical_spacing;
  const std::vector<SampleIndex> some = some_samples(t);
  const Columns columns(t, axis, some, widest);
  std::vector<std::atomic<bool>> stacked(some.size()); // set, never cleared: any order gives the same
  for_each_index(threads, t.sample_count, [&](std::size_t i) {
    const Vec3& p = t.positions.raw()[i];
    columns.for_each_near(p, [&](std::uint32_t k) {
      const SampleIndex s = some[k];
      const double aside = across(axis, p, t.positions[s]), height = std::fabs(along(axis, p - t.positions[s]));
      if (aside <= std::min(static_cast<double>(model.spacing[s]), widest) &&
          height > unexplained_height(model, s, aside))
        stacked[k].store(true, std::memory_order_relaxed);
    });
  });
  double samples = 0, area = 0, all_area = 0;
  for (std::size_t k = 0; k < some.size(); ++k) {
    const double side = std::min(static_cast<double>(model.spacing[some[k]]), widest);
    all_area += side * side;
    if (!stacked[k]) continue;
    samples += 1;
    area += side * side;
  }
  return {samples / static_cast<double>(some.size()), area / all_area};
}

/// Of points[index[0]] and so on, with the axis for the normal.
LocalFrame standing_frame(std::span<const Vec3> points, std::span<const std::uint32_t> index, int axis) {
  LocalFrame frame;
  for (std::size_t k = 0; k < 3; ++k) {
    const int turned = (axis + static_cast<int>(k)) % 3;
    frame.axis[k] = direction_of(static_cast<Axis>(2 * turned));
  }
  for (const std::uint32_t i : index) frame.mean = frame.mean + points[i];
  frame.mean = (1 / static_cast<double>(index.size())) * frame.mean;
  for (std::size_t k = 0; k < 3; ++k) {
    for (const std::uint32_t i : index) {
      const double d = dot(points[i] - frame.mean, frame.axis[k]);
      frame.variance[k] += d * d / static_cast<double>(index.size());
    }
  }
  return frame;
}

/// The share of the area around which there are two sheets along the axis, where noise hides which sample has another
/// one above it: the sides of a thin plate.
double share_of_two_sheets(const Scene& scene, int axis, const Threads& threads) {
  const Tetrahedralization& t = scene.tetrahedralization;
  const SampleModel& model = scene.measures.model;
  const std::span<const Vec3> positions(t.positions.raw().data(), t.sample_count);
  const double widest = sheet_radius * model.typical_spacing;
  const std::vector<SampleIndex> some = some_samples(t);
  const Columns columns(t, axis, some, widest);
  const auto radius = [&](std::uint32_t k) {
    return std::min(sheet_radius * static_cast<double>(model.spacing[some[k]]), widest);
  };
  const auto around = build_rows<std::uint32_t>(some.size(), [&](auto&& visit) {
    for (std::uint32_t i = 0; i < t.sample_count; ++i)
      columns.for_each_near(positions[i], [&](std::uint32_t k) {
        if (across(axis, positions[i], t.positions[some[k]]) <= radius(k)) visit(k, i);
      });
  });
  std::vector<std::uint8_t> two(some.size(), 0);
  const auto look = [&](std::size_t k) {
    if (around[k].size() < least_in_sheets) return;
    const LocalFrame frame = standing_frame(positions, around[k], axis);
    const auto sheets = two_sheets(positions, around[k], frame);
    // What lies higher beside is a step.
    two[k] = sheets && sheets->gap > static_cast<double>(model.spacing[some[k]]) &&
             sheets->aside < most_aside * radius(static_cast<std::uint32_t>(k));
  };
  for_each_index(threads, some.size(), look, costly_block);
  double in_two = 0, all = 0;
  for (std::size_t k = 0; k < some.size(); ++k) {
    const double side = std::min(static_cast<double>(model.spacing[some[k]]), model.typical_spacing);
    all += side * side;
    in_two += two[k] * side * side;
  }
  return in_two / all;
}

/// How far the hull is from a sample in a direction.
double depth_of_hull(const Scene& scene, SampleIndex s, const Vec3& direction, double far) {
  const Tetrahedralization& t = scene.tetrahedralization;
  SegmentWalk walk(t, scene.stars, s, t.positions[s] + far * direction);
  while (walk.next())
    if (t.touches_cube(walk.tetrahedron())) return std::max(0.0, walk.depth());
  return 0;
}

double cap_of(const Scene& scene, int axis, const Threads& threads) {
  const Tetrahedralization& t = scene.tetrahedralization;
  Box3 box;
  for (std::uint32_t s = 0; s < t.sample_count; ++s) box.add(t.positions.raw()[s]);
  const double far = 2 * box.diagonal();
  const Vec3 up = direction_of(static_cast<Axis>(2 * axis));
  const std::vector<SampleIndex> some = some_samples(t);
  std::vector<std::array<double, 2>> space(some.size());
  const auto measure = [&](std::size_t k) {
    const auto spacing = static_cast<double>(scene.measures.model.spacing[some[k]]);
    space[k] = {spacing * spacing * depth_of_hull(scene, some[k], -1.0 * up, far),
                spacing * spacing * depth_of_hull(scene, some[k], up, far)};
  };
  for_each_index(threads, some.size(), measure, costly_block);
  double behind = 0, before = 0, shallow = 0;
  constexpr double unevenness = 0.05; // in spacings: planes have as much by rounding and noise, on either side
  for (std::size_t k = 0; k < some.size(); ++k) {
    behind += space[k][0];
    before += space[k][1];
    const auto spacing = static_cast<double>(scene.measures.model.spacing[some[k]]);
    shallow += unevenness * spacing * spacing * spacing;
  }
  // Flat as far as can be told: a plane has no side behind it.
  return behind + before < shallow ? std::numeric_limits<double>::infinity() : behind / std::max(before, shallow);
}

/// Is a triangle of the hull one among neighbouring samples? Others hang between parts of the scene.
bool is_borne_out(const Scene& scene, const std::array<SampleIndex, 3>& corner) {
  const Tetrahedralization& t = scene.tetrahedralization;
  double longest = 0, spacing = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    longest = std::max(longest, norm(t.positions[corner[(k + 1) % 3]] - t.positions[corner[k]]));
    spacing += static_cast<double>(scene.measures.model.spacing[corner[k]]) / static_cast<double>(corner.size());
  }
  return longest <= longest_edge * spacing;
}

/// The share of the hull's shadow along the axis that triangles among neighbouring samples cast, on the side where that
/// is less: both sides of a closed body that is convex or flat are on its hull, of ground at most one.
double share_on_hull(const Scene& scene, int axis) {
  const Tetrahedralization& t = scene.tetrahedralization;
  const Vec3 up = direction_of(static_cast<Axis>(2 * axis));
  std::array<double, 2> borne_out{}, all{};
  for_each_hull_triangle(t, [&](const HullTriangle& triangle) {
    const double shadow = dot(triangle.outward, up);
    const bool upward = shadow > 0;
    all[upward] += std::fabs(shadow);
    if (is_borne_out(scene, triangle.corner)) borne_out[upward] += std::fabs(shadow);
  });
  return std::min(borne_out[0] / all[0], borne_out[1] / all[1]);
}

/// The part of the hull's area that each sample on it stands for; 0 for all others.
IndexedArray<SampleIndex, double> hull_area(const Tetrahedralization& t) {
  IndexedArray<SampleIndex, double> area(t.sample_count, 0);
  for_each_hull_triangle(t, [&](const HullTriangle& triangle) {
    const auto& corner = triangle.corner;
    for (const SampleIndex s : corner) area[s] += norm(triangle.outward) / 2 / static_cast<double>(corner.size());
  });
  return area;
}

/// How the samples lie.
Surroundings reading_of_samples(const Scene& scene, const Threads& threads) {
  Surroundings result;
  if (scene.tetrahedralization.sample_count < least_samples) return result;
  const AxisReading ground = read_axis(scene, z, threads);
  if (ground.stacked <= most_stacked && ground.cap <= cap_of_body && share_on_hull(scene, z) < most_on_hull) {
    result.kind = SceneKind::facade;
    return result;
  }
  if (ground.stacked <= perhaps_stacked) {
    result.likely_facade = Axis::plus_z;
    return result;
  }
  for (const int axis : {0, 1})
    if (read_axis(scene, axis, threads).stacked <= most_stacked) result.likely_facade = static_cast<Axis>(2 * axis);
  return result;
}

/// Does the hull run along walls? A room keeps them where its ceiling was not seen; from the rim of the ground to what
/// stands on it the hull hangs like a curtain.
bool has_walls(const Scene& scene, int axis) {
  const Vec3 up = direction_of(static_cast<Axis>(2 * axis));
  double walls = 0, all = 0;
  for_each_hull_triangle(scene.tetrahedralization, [&](const HullTriangle& triangle) {
    const double area = norm(triangle.outward);
    all += area;
    if (std::fabs(dot(triangle.outward, up)) < most_leaning * area && is_borne_out(scene, triangle.corner))
      walls += area;
  });
  return walls > least_walls * all;
}

/// Were most samples seen from that side?
bool is_seen_from(const Vec3& side, const Tetrahedralization& t, std::span<const SightLine> lines) {
  const auto seen = std::count_if(lines.begin(), lines.end(), [&](const SightLine& line) {
    return dot(side, line.target - t.positions[line.sample]) > 0;
  });
  return 2 * static_cast<std::size_t>(seen) > lines.size();
}

/// Who wants a base says that it is one side. \throws Error{usage} when the samples do not lie so along z
Surroundings side_for_base(const Scene& scene, const Threads& threads) {
  if (share_stacked(scene, z, threads).of_area > perhaps_stacked)
    throw Error(ErrorKind::usage, "evidence",
                "--base: the samples do not lie like ground, one above each place of a map",
                "name the side that was seen, as --facade +z; or leave out --base where the body is closed");
  return {SceneKind::facade, Axis::plus_z, {}};
}

} // namespace

AxisReading read_axis(const Scene& scene, int axis, const Threads& threads) {
  AxisReading reading;
  reading.stacked = share_stacked(scene, axis, threads).of_area;
  if (reading.stacked <= perhaps_stacked)
    reading.stacked = std::max(reading.stacked, share_of_two_sheets(scene, axis, threads));
  if (reading.stacked <= most_stacked) reading.cap = cap_of(scene, axis, threads);
  return reading;
}

bool is_seen_along(const Scene& scene, Axis front, const Threads& threads) {
  return share_stacked(scene, static_cast<int>(front) / 2, threads).of_samples <= few_stacked;
}

HullSight hull_sight(const Tetrahedralization& t, const VertexStars& stars, std::span<const SightLine> lines,
                     const Threads& threads) {
  const IndexedArray<SampleIndex, double> area = hull_area(t);
  std::vector<std::uint8_t> stays(lines.size(), 0);
  for_each_index(
      threads, lines.size(),
      [&](std::size_t i) {
        if (area[lines[i].sample] == 0) return;
        SegmentWalk walk(t, stars, lines[i].sample, lines[i].target);
        bool within = true;
        while (within && walk.next()) within = !t.touches_cube(walk.tetrahedron());
        stays[i] = within;
      },
      costly_block);
  HullSight sight;
  for (std::size_t begin = 0, end = 0; begin < lines.size(); begin = end) {
    double within = 0;
    for (; end < lines.size() && lines[end].sample == lines[begin].sample; ++end) within += stays[end];
    const double whole = area[lines[begin].sample], share = within / static_cast<double>(end - begin);
    sight.within += share * whole;
    sight.without += (1 - share) * whole;
  }
  return sight;
}

Surroundings surroundings_of(const PointCloud& cloud, const Scene& scene, const Options& options,
                             const Threads& threads) {
  if (options.facade) return {SceneKind::facade, *options.facade, {}};
  if (options.base) return side_for_base(scene, threads);
  if (!options.detect_facade || options.weights == Weights::paper) return {};
  if (cloud.sensor_of.empty()) return reading_of_samples(scene, threads);
  const Tetrahedralization& t = scene.tetrahedralization;
  const auto lines = sight_lines(cloud, scene.sample_of_row, t, SampleLengths(t.sample_count, 0), {});
  // Sensors change nothing about how ground lies: it was seen from above, and no walls stand around it.
  if (const Surroundings ground = reading_of_samples(scene, threads);
      ground.kind == SceneKind::facade && is_seen_from(direction_of(ground.front), t, lines) && !has_walls(scene, z))
    return ground;
  const HullSight sight = hull_sight(t, scene.stars, lines, threads);
  return Surroundings{sight.within > sight.without ? SceneKind::interior : SceneKind::body};
}

} // namespace eigencrust
