// SPDX-License-Identifier: GPL-3.0-or-later
#include <eigencrust/error.h>
#include <gmock/gmock.h>
#include <cmath>

#include <limits>
#include <numeric>

#include "clouds.h"
#include "geometry/exact_difference.h"
#include "geometry/spatial_order.h"
#include "support.h"

namespace eigencrust {
namespace {

using clouds::Points;
using testing::HasSubstr;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();
const Points five{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, 4}, {4, 4, 4}};

TEST(Samples, DuplicatesKeepTheSmallestRow) {
  Points points = five;
  points.insert(points.begin(), {4, 4, 4}); // row 0 equals row 5
  points.push_back({0, 4, 0});              // row 6 equals row 3
  points.push_back({0, 4, 0});
  const Samples samples = prepare_samples(points, Threads(1));
  EXPECT_EQ(samples.duplicates, 3u);
  std::vector<std::uint32_t> source = samples.source.raw();
  std::sort(source.begin(), source.end());
  EXPECT_THAT(source, testing::ElementsAre(0, 1, 2, 3, 4));
}

TEST(Samples, ZerosOfBothSignsAreOnePoint) {
  Points points = five;
  points.push_back({-0.0, 0.0, -0.0});
  const Samples samples = prepare_samples(points, Threads(1));
  EXPECT_EQ(samples.duplicates, 1u);
  EXPECT_EQ(samples.positions.size(), 5u);
}

TEST(Samples, RowsThatAreNotFiniteAreCountedAndLeftOut) {
  Points points{{nan, 0, 0}};
  points.insert(points.end(), five.begin(), five.end());
  points.push_back({0, infinity, 0});
  points.push_back({0, 0, -infinity});
  const Samples samples = prepare_samples(points, Threads(1));
  EXPECT_EQ(samples.nonfinite, 3u);
  EXPECT_EQ(samples.positions.size(), 5u);
  EXPECT_EQ(samples.bounds.max, (Vec3{4, 4, 4}));
  for (std::uint32_t i = 0; i < 5; ++i)
    EXPECT_EQ(samples.positions.raw()[i] + samples.origin, points[samples.source.raw()[i]]);
}

TEST(Samples, OriginIsTheMiddleOfTheBox) {
  const Samples samples = prepare_samples(clouds::moved(five, {100, 200, 300}), Threads(1));
  EXPECT_EQ(samples.origin, (Vec3{102, 202, 302}));
  EXPECT_EQ(samples.bounds.min, (Vec3{100, 200, 300}));
}

// Moved to the middle of their box, points of double precision would be rounded, differ a little less, and their
// triangles could cross.
TEST(Samples, LoseNothingByTheOrigin) {
  const Points box = clouds::random_box(500, 8);
  for (const double offset : {0.0, 0.3, 1.7, 3.4, 3.6, 20.0, 1e6})
    for (const Vec3& direction : {Vec3{1, 0, 0}, Vec3{1, -1, 1}, Vec3{0, 0.01, -1}}) {
      Points points = clouds::moved(box, offset * direction);
      points.push_back(points[7] + Vec3{0, 1e-300, 0});                               // far from 0 the same point
      points.push_back({points[7].x, points[7].y, std::nextafter(points[7].z, 1e9)}); // never
      const Samples samples = prepare_samples(points, Threads(2));
      EXPECT_GE(samples.positions.size(), 501u);
      for (std::uint32_t i = 0; i < samples.positions.size(); ++i) {
        const Vec3& point = points[samples.source.raw()[i]];
        EXPECT_TRUE(is_exact_difference(point, samples.origin)) << offset;
        EXPECT_EQ(samples.positions.raw()[i] + samples.origin, point);
      }
    }
}

TEST(Samples, OrderDependsNeitherOnRowsNorOnThreads) {
  // More than 4096 points, so that sorting goes through its blocks; equal coordinates among them.
  Points points = clouds::random_box(6000, 1);
  for (int i = 0; i < 50; ++i) points.push_back(points[static_cast<std::size_t>(7 * i)]);
  const Samples reference = prepare_samples(points, Threads(1));
  EXPECT_EQ(reference.duplicates, 50u);
  for (const unsigned threads : {2u, 3u}) {
    const Points other = clouds::shuffled(points, threads);
    const Samples samples = prepare_samples(other, Threads(threads));
    EXPECT_EQ(samples.positions.raw(), reference.positions.raw());
    for (std::uint32_t i = 0; i < samples.source.size(); ++i) {
      const auto first = std::find(other.begin(), other.end(), points[reference.source.raw()[i]]);
      EXPECT_EQ(samples.source.raw()[i], first - other.begin());
    }
  }
}

TEST(Samples, AStrayRowDoesNotSpoilTheOrder) {
  // Cells as large as the object: all samples of the ball have one key at first.
  const Points ball = clouds::sphere(5000);
  const auto way = [](const Samples& samples) {
    double sum = 0;
    for (std::uint32_t i = 1; i < samples.positions.size(); ++i)
      sum += std::min(2.0, distance(samples.positions.raw()[i - 1], samples.positions.raw()[i]));
    return sum;
  };
  const double alone = way(prepare_samples(ball, Threads(2)));
  EXPECT_LT(way(prepare_samples(clouds::joined(ball, {{1e9, 2e8, -3e8}}), Threads(2))), 1.2 * alone);
}

TEST(Samples, HilbertCurveVisitsEveryCellAndOnlyMovesToNeighbours) {
  // Middles of 16³ cells: the curve of that order passes from each to a cell that shares a face.
  Points middles = clouds::moved(clouds::lattice(16, 16, 16), {0.5, 0.5, 0.5});
  const Box3 box{{0, 0, 0}, {16, 16, 16}};
  std::sort(middles.begin(), middles.end(),
            [&](const Vec3& a, const Vec3& b) { return hilbert_key(a, box) < hilbert_key(b, box); });
  for (std::size_t i = 1; i < middles.size(); ++i) {
    ASSERT_NE(hilbert_key(middles[i - 1], box), hilbert_key(middles[i], box));
    ASSERT_EQ(squared_norm(middles[i] - middles[i - 1]), 1.0) << i;
  }
}

TEST(Samples, TooFewPointsAreRefused) {
  const auto refused = [](const Points& points) {
    try {
      prepare_samples(points, Threads(1));
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input);
      EXPECT_FALSE(error.remedy().empty());
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_THAT(refused({}), HasSubstr("no finite point"));
  EXPECT_THAT(refused({{nan, nan, nan}}), HasSubstr("no finite point"));
  EXPECT_THAT(refused({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}), HasSubstr("only 4 distinct"));
  EXPECT_THAT(refused({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 1}}), HasSubstr("only 4 distinct"));
  EXPECT_THAT(refused(Points(50, Vec3{1, 2, 3})), HasSubstr("lie within 1e-30"));
}

TEST(Samples, CoordinatesThatWouldOverflowAreRefused) {
  Points points = five;
  points.push_back({1e31, 0, 0});
  EXPECT_THAT(error_of([&] { prepare_samples(points, Threads(1)); }), HasSubstr("1e30"));
  // All of them far away, but close together: squares of the coordinates would overflow all the same.
  EXPECT_NE(error_of([&] { prepare_samples(clouds::moved(five, {1e200, 0, 0}), Threads(1)); }), "");
  // The sum of the two ends of the box overflows.
  EXPECT_NE(error_of([&] {
              prepare_samples(clouds::joined(five, {{1.7e308, 0, 0}, {-1.7e308, 0, 0}}), Threads(1));
            }),
            "");
}

TEST(Samples, LargeAndSmallUnitsAreAccepted) {
  for (const double unit : {1e-25, 1e-9, 1e9, 1e25}) {
    const Samples samples = prepare_samples(clouds::moved(five, {}, unit), Threads(1));
    EXPECT_EQ(samples.positions.size(), 5u) << unit;
  }
}

TEST(Spacing, OfALatticeIsItsStep) {
  const Points points = clouds::lattice(6, 5, 4, 0.25);
  const Samples samples = prepare_samples(points, Threads(2));
  EXPECT_EQ(median_spacing(samples, points, {}, Threads(2)), 0.25);
}

TEST(Spacing, WithinAScanIgnoresTheOtherScans) {
  // Two lattices of step 0.25, the second shifted by 0.0625: neighbours across scans are closer.
  const Points one = clouds::lattice(6, 5, 4, 0.25);
  const Points both = clouds::joined(one, clouds::moved(one, {0.0625, 0, 0}));
  std::vector<std::uint32_t> scan(both.size(), 7);
  std::fill(scan.begin() + static_cast<std::ptrdiff_t>(one.size()), scan.end(), 3);
  const Samples samples = prepare_samples(both, Threads(1));
  EXPECT_EQ(median_spacing(samples, both, {}, Threads(1)), 0.0625);
  EXPECT_EQ(median_spacing(samples, both, scan, Threads(1)), 0.25);
  EXPECT_DOUBLE_EQ(resolve_grid_spacing({}, samples, both, scan, Threads(1)), 0.25 * std::numbers::sqrt2);
}

TEST(Spacing, AutomaticGridSpacingIsOffForASingleScan) {
  const Points points = clouds::lattice(4, 4, 4, 0.5);
  const Samples samples = prepare_samples(points, Threads(1));
  const std::vector<std::uint32_t> same(points.size(), 9);
  EXPECT_EQ(resolve_grid_spacing({}, samples, points, {}, Threads(1)), 0);
  EXPECT_EQ(resolve_grid_spacing({}, samples, points, same, Threads(1)), 0);
}

TEST(Spacing, GridSpacingAsToldInLengthOrPercent) {
  const Samples samples = prepare_samples(five, Threads(1));
  using Kind = LengthChoice::Kind;
  EXPECT_EQ(resolve_grid_spacing({Kind::off, 0}, samples, five, {}, Threads(1)), 0);
  EXPECT_EQ(resolve_grid_spacing({Kind::length, 0.125}, samples, five, {}, Threads(1)), 0.125);
  EXPECT_DOUBLE_EQ(resolve_grid_spacing({Kind::percent, 5}, samples, five, {}, Threads(1)), 0.05 * std::sqrt(48.0));
}

TEST(Spacing, RowsWithoutFiniteCoordinatesAndDuplicatesDoNotCount) {
  Points points = clouds::lattice(3, 3, 3, 2.0);
  points.insert(points.begin(), {nan, 0, 0});
  points.push_back({0, 0, 0}); // distance 0 to its double
  std::vector<std::uint32_t> scan(points.size(), 0);
  scan.front() = 1; // the only row of its scan, and not finite
  const Samples samples = prepare_samples(points, Threads(1));
  EXPECT_EQ(median_spacing(samples, points, scan, Threads(1)), 2.0);
}

TEST(Spacing, ScanNumbersMayBeAnyNumbers) {
  // Scan numbers are names: a large one asks for no memory, and the largest does not wrap around.
  const Points one = clouds::lattice(3, 3, 3, 1.0);
  const Points both = clouds::joined(one, clouds::moved(one, {0.25, 0, 0}));
  std::vector<std::uint32_t> scan(both.size(), 4294967295u);
  std::fill(scan.begin(), scan.begin() + static_cast<std::ptrdiff_t>(one.size()), 3000000000u);
  const Samples samples = prepare_samples(both, Threads(1));
  EXPECT_EQ(median_spacing(samples, both, scan, Threads(1)), 1.0);
}

} // namespace
} // namespace eigencrust
