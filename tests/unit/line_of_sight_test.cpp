// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>

#include "clouds.h"
#include "evidence/contradictions.h"
#include "tetrahedra/segment_walk.h"

namespace eigencrust {
namespace {

using clouds::Points;
using clouds::Prepared;

/// A flat sheet of spacing 1 at z = 0, 12 × 12, and a roof 5 above its middle that nobody looked at.
Points sheet_and_roof() {
  Points points;
  for (int x = 0; x < 12; ++x)
    for (int y = 0; y < 12; ++y) points.push_back({x + 0.01 * y, y - 0.013 * x, 0.001 * ((x * 7 + y * 3) % 5)});
  for (const double x : {4.1, 5.2, 6.0, 7.3})
    for (const double y : {4.3, 5.1, 6.2, 7.0}) points.push_back({x, y, 5 + 0.01 * x});
  return points;
}
constexpr std::size_t sheet_rows = 144;

PointCloud seen_from(const Points& points, const Sensor& sensor, std::size_t rows) {
  PointCloud cloud = clouds::cloud_of(points);
  cloud.sensors = {sensor};
  cloud.sensor_of.assign(points.size(), PointCloud::no_sensor);
  std::fill_n(cloud.sensor_of.begin(), rows, 0u);
  return cloud;
}

SampleLengths depths(const Prepared& p, float depth) { return SampleLengths(p.t.sample_count, depth); }

TEST(SightLines, EndAtTheSensorOrBeyondTheSamples) {
  const Points points = clouds::random_box(30, 1);
  const Prepared p = clouds::prepare(points);
  PointCloud cloud = clouds::cloud_of(points);
  cloud.sensors = {{{0.3, 0.4, 0.5}, false}, {{0, 0.6, 0.8}, true}, {{1e200, 0, 0}, false}};
  cloud.sensor_of.assign(30, PointCloud::no_sensor);
  cloud.sensor_of[7] = 0;
  cloud.sensor_of[8] = 1;
  cloud.sensor_of[9] = 2;
  const auto lines = sight_lines(cloud, p.sample_of_row, p.t, depths(p, 0.25f), {});
  ASSERT_EQ(lines.size(), 3u);
  for (const SightLine& line : lines) {
    EXPECT_EQ(line.depth, 0.25f);
    const std::uint32_t row = p.t.source[line.sample];
    const Vec3 way = line.target - p.t.positions[line.sample];
    if (row == 7) {
      EXPECT_EQ(line.target, (Vec3{0.3, 0.4, 0.5}) - p.t.origin);
      continue;
    }
    const auto beyond = [&](const Vec3& sample) {
      return line.target.x > sample.x || line.target.y > sample.y || line.target.z > sample.z;
    };
    EXPECT_TRUE(std::all_of(p.t.positions.begin(), p.t.positions.begin() + p.t.sample_count, beyond));
    const Vec3 expected = row == 8 ? Vec3{0, 0.6, 0.8} : Vec3{1, 0, 0};
    EXPECT_LT(distance((1 / norm(way)) * way, expected), 1e-9);
  }
}

TEST(SightLines, DuplicatesCountOncePerSensorAndIsolatedSamplesNot) {
  Points points = clouds::random_box(20, 2);
  points.push_back(points[4]); // seen from a second sensor
  points.push_back(points[4]); // and from the first again
  const Prepared p = clouds::prepare(points);
  PointCloud cloud = clouds::cloud_of(points);
  cloud.sensors = {{{3, 0, 0}, false}, {{0, 3, 0}, false}};
  cloud.sensor_of.assign(points.size(), 0);
  cloud.sensor_of[20] = 1;
  EXPECT_EQ(sight_lines(cloud, p.sample_of_row, p.t, depths(p, 0), {}).size(), 21u);
  SampleLengths isolated(p.t.sample_count, 0.0f);
  for (std::uint32_t s = 0; s < p.t.sample_count; ++s)
    if (p.t.source.raw()[s] == 4) isolated[SampleIndex{s}] = 1;
  EXPECT_EQ(sight_lines(cloud, p.sample_of_row, p.t, depths(p, 0), isolated).size(), 19u);
  cloud.sensor_of.clear();
  EXPECT_TRUE(sight_lines(cloud, p.sample_of_row, p.t, depths(p, 0), {}).empty());
}

TEST(SightCrossings, BeginBeyondTheDepthAndStayAwayFromSamples) {
  const Points points = sheet_and_roof();
  const Prepared p = clouds::prepare(points);
  const PointCloud cloud = seen_from(points, {{5.5, 5.5, 30}, false}, sheet_rows);
  const auto lines = sight_lines(cloud, p.sample_of_row, p.t, depths(p, 1.5f), {});
  ASSERT_EQ(lines.size(), sheet_rows);
  const SightCrossings all = sight_crossings(p.t, p.stars, lines, Weights::paper, p.known, Threads(1));
  const SightCrossings clear = sight_crossings(p.t, p.stars, lines, Weights::evidence, p.known, Threads(1));
  std::size_t shallow = 0, near = 0;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const Vec3 from = p.t.positions[lines[i].sample];
    const Vec3 direction = (1 / distance(lines[i].target, from)) * (lines[i].target - from);
    std::vector<TetrahedronIndex> deep, away;
    SegmentWalk walk(p.t, p.stars, lines[i].sample, lines[i].target);
    while (walk.next()) {
      if (p.t.touches_cube(walk.tetrahedron())) continue; // known to be outside
      shallow += walk.depth() <= 1.5;
      if (walk.depth() <= 1.5) continue;
      deep.push_back(walk.tetrahedron());
      const Vec3 middle = from + (0.5 * (walk.depth() + walk.exit_depth())) * direction;
      double nearest = 1e9;
      for (const VertexIndex v : p.t.tetrahedra[walk.tetrahedron()])
        nearest = std::min(nearest, distance(p.t.positions[v], middle));
      if (nearest > 1.5)
        away.push_back(walk.tetrahedron());
      else
        ++near;
    }
    EXPECT_THAT(all[i], testing::ElementsAreArray(deep));
    EXPECT_THAT(clear[i], testing::ElementsAreArray(away));
  }
  EXPECT_GT(shallow, 100u); // both rules had something to do
  EXPECT_GT(near, 20u);
}

/// Labels by hand: which tetrahedra are crossed by how many of the lines.
TEST(LineOfSight, OutsideIsWhatEnoughLinesCross) {
  const Points points = sheet_and_roof();
  const Prepared p = clouds::prepare(points);
  const PointCloud cloud = seen_from(points, {{5.5, 5.5, 30}, false}, sheet_rows);
  const auto lines = sight_lines(cloud, p.sample_of_row, p.t, depths(p, 1.5f), {});
  const SightCrossings crossings = sight_crossings(p.t, p.stars, lines, Weights::paper, p.known, Threads(1));
  std::vector<std::uint32_t> crossed(p.t.tetrahedra.size(), 0);
  for (const TetrahedronIndex i : crossings.tetrahedra) ++crossed[i.value];
  EXPECT_THAT(crossed, testing::Contains(1u));
  const SightLabels sight = line_of_sight(p.t, p.stars, lines, crossings, {Weights::paper}, p.known, Threads(1));
  EXPECT_EQ(sight.disbelieved, 0u);
  for (std::uint32_t i = 0; i < crossed.size(); ++i) {
    EXPECT_EQ(sight.labels.raw()[i], crossed[i] > 1 ? Label::outside : p.known.raw()[i]); // "more than once"
    EXPECT_EQ(sight.front.raw()[i], std::min(255u, crossed[i]));
    EXPECT_EQ(sight.behind.raw()[i], 0);
  }
}

TEST(LineOfSight, WhatTheUserNamedStands) {
  const Points points = sheet_and_roof();
  const Prepared p = clouds::prepare(points);
  const PointCloud cloud = seen_from(points, {{30, 5.5, 15}, false}, sheet_rows);
  const auto lines = sight_lines(cloud, p.sample_of_row, p.t, depths(p, 0.1f), {});
  Points named_inside;
  for (const double x : {4.5, 5.5, 6.5})
    for (const double y : {4.5, 5.5, 6.5}) named_inside.push_back({x, y, 2.5});
  const Labels named = known_labels(p.t, p.stars, {}, named_inside, {}, Threads(1));
  const SightCrossings crossings = sight_crossings(p.t, p.stars, lines, Weights::paper, named, Threads(1));
  const Labels labels = line_of_sight(p.t, p.stars, lines, crossings, {Weights::paper}, named, Threads(1)).labels;
  std::size_t inside = 0;
  for (std::size_t i = 0; i < named.size(); ++i) {
    if (named.raw()[i] == Label::unlabelled) continue;
    EXPECT_EQ(labels.raw()[i], named.raw()[i]);
    inside += named.raw()[i] == Label::inside;
  }
  EXPECT_GT(inside, 3u);
  EXPECT_GT(contradicting_lines(crossings, labels, Threads(1)), 0u); // they cross what is said to be inside
}

/// A ball seen from six sides, and rows behind it or within it that claim to have been seen through it.
PointCloud ball_with_liars() {
  PointCloud cloud = clouds::cloud_of(clouds::sphere(1500));
  for (const Vec3& d : {Vec3{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}})
    cloud.sensors.push_back({d, true});
  for (const Vec3& p : cloud.points) {
    std::uint32_t best = 0;
    for (std::uint32_t k = 1; k < 6; ++k)
      if (dot(p, cloud.sensors[k].place) > dot(p, cloud.sensors[best].place)) best = k;
    cloud.sensor_of.push_back(best);
  }
  for (int i = 0; i < 40; ++i) {
    const double r = 0.1 * std::sqrt(i); // spread out, less dense than the ball's samples
    cloud.points.push_back({r * std::cos(2.4 * i), r * std::sin(2.4 * i), -0.3});
    cloud.sensor_of.push_back(4); // from above: through half of the ball
  }
  return cloud;
}

TEST(LineOfSight, LinesThroughWhatManySawFromTheirSideAreNotBelieved) {
  const PointCloud cloud = ball_with_liars();
  const Prepared p = clouds::prepare(cloud.points);
  const auto lines = sight_lines(cloud, p.sample_of_row, p.t, depths(p, 0.15f), {});
  const auto wrong = [&](Weights weights, SightLabels& sight) {
    const SightCrossings crossings = sight_crossings(p.t, p.stars, lines, weights, p.known, Threads(1));
    sight = line_of_sight(p.t, p.stars, lines, crossings, {weights}, p.known, Threads(1));
    std::size_t n = 0;
    for (std::uint32_t i = 0; i < p.t.tetrahedra.size(); ++i)
      n += !p.t.touches_cube(TetrahedronIndex{i}) && sight.labels.raw()[i] == Label::outside;
    return n; // all tetrahedra away from the cube are within the ball
  };
  SightLabels sight;
  const std::size_t of_all = wrong(Weights::paper, sight);
  EXPECT_GT(of_all, 10u);
  EXPECT_EQ(sight.disbelieved, 0u);
  EXPECT_LE(4 * wrong(Weights::evidence, sight), of_all); // a single line is believed where nothing speaks against it
  EXPECT_GE(sight.disbelieved, 30u);                      // the others cross nothing that counts
  EXPECT_LE(sight.disbelieved, 40u);                      // none of the honest ones
}

TEST(LineOfSight, InsideIsWhatManySamplesLieInFrontOf) {
  const PointCloud cloud = ball_with_liars();
  const Prepared p = clouds::prepare(cloud.points);
  const auto lines = sight_lines(cloud, p.sample_of_row, p.t, depths(p, 0.15f), {});
  const SightCrossings crossings = sight_crossings(p.t, p.stars, lines, Weights::evidence, p.known, Threads(1));
  std::vector<std::uint32_t> crossed(p.t.tetrahedra.size(), 0);
  for (const TetrahedronIndex i : crossings.tetrahedra) ++crossed[i.value];
  const auto inside = [&](SampleLengthsView isolated) {
    const SightRule rule{Weights::evidence, isolated};
    const SightLabels sight = line_of_sight(p.t, p.stars, lines, crossings, rule, p.known, Threads(1));
    std::size_t n = 0;
    for (std::uint32_t i = 0; i < p.t.tetrahedra.size(); ++i) {
      const bool is_inside = sight.labels.raw()[i] == Label::inside;
      n += is_inside;
      EXPECT_FALSE(is_inside && p.t.touches_cube(TetrahedronIndex{i}));
      EXPECT_FALSE(is_inside && (sight.behind.raw()[i] == 0 || crossed[i] > 0));
      EXPECT_LE(sight.front.raw()[i], crossed[i]); // those believed
    }
    EXPECT_EQ(sight.inside, n);
    return n;
  };
  EXPECT_GT(inside({}), 50u);
  EXPECT_EQ(inside(SampleLengths(p.t.sample_count, 1)), 0u); // all may be outliers
}

TEST(LineOfSight, IsTheSameForAnyNumberOfThreads) {
  Points points = clouds::jittered(clouds::lattice(16, 16, 8), 0.0, 1); // many degenerate hits
  PointCloud cloud = clouds::cloud_of(points);
  cloud.sensors = {{{8, 8, 40}, false}, {{0, 0, 1}, true}, {{-30, 8, 4}, false}};
  for (std::size_t i = 0; i < points.size(); ++i) cloud.sensor_of.push_back(static_cast<std::uint32_t>(i % 3));
  const Prepared p = clouds::prepare(points);
  const auto lines = sight_lines(cloud, p.sample_of_row, p.t, depths(p, 0.5f), {});
  const auto run = [&](unsigned threads) {
    const Threads team(threads);
    const SightCrossings crossings = sight_crossings(p.t, p.stars, lines, Weights::evidence, p.known, team);
    const SightLabels sight = line_of_sight(p.t, p.stars, lines, crossings, {}, p.known, team);
    return std::tuple(crossings.begin, crossings.tetrahedra, sight.labels.raw(), sight.disbelieved,
                      contradicting_lines(crossings, sight.labels, team));
  };
  const auto one = run(1);
  EXPECT_FALSE(std::get<1>(one).empty());
  EXPECT_EQ(one, run(2));
  EXPECT_EQ(one, run(5));
}

TEST(LineOfSight, OfNoLinesIsWhatWasKnown) {
  const Prepared p = clouds::prepare(clouds::random_box(30, 3));
  const SightCrossings none = sight_crossings(p.t, p.stars, {}, Weights::evidence, p.known, Threads(2));
  const SightLabels sight = line_of_sight(p.t, p.stars, {}, none, {}, p.known, Threads(2));
  EXPECT_EQ(sight.labels.raw(), p.known.raw());
  EXPECT_EQ(contradicting_lines(none, sight.labels, Threads(1)), 0u);
  EXPECT_EQ(contradicting_lines({}, sight.labels, Threads(1)), 0u);
}

} // namespace
} // namespace eigencrust
