// SPDX-License-Identifier: GPL-3.0-or-later
// What the speed benchmark makes of its times, by hand-typed times.
#include "speed_figures.h"

#include <gmock/gmock.h>

#include <cmath>

#include "speed_table.h"

namespace eigencrust::bench {
namespace {

using testing::HasSubstr;

WholeTimes whole_of(double samples, double delaunay, double later, double other) {
  WholeTimes whole;
  whole.seconds = {samples + delaunay + later + other};
  whole.stages = {{"samples", {samples}}, {"delaunay", {delaunay}}, {"poles", {later}}, {"other", {other}}};
  return whole;
}

SpeedOutcome sphere_of(std::uint64_t points, double cgal, const WholeTimes& whole) {
  SpeedOutcome outcome;
  outcome.item = {"sphere-" + std::to_string(points), "", points};
  outcome.points = points;
  outcome.cgal.seconds = {cgal};
  outcome.whole = {whole};
  return outcome;
}

TEST(SpeedFigures, MedianOfOddEvenAndNone) {
  EXPECT_EQ(median(std::vector{3.0, 9.0, 1.0}), 3);
  EXPECT_EQ(median(std::vector{4.0, 1.0, 2.0, 100.0}), 3);
  EXPECT_TRUE(std::isnan(median({})));
}

TEST(SpeedFigures, AfterDelaunayIsTheMedianOfSumsNotTheSumOfMedians) {
  WholeTimes whole;
  whole.seconds = {10, 10, 10};
  // Sums behind the Delaunay stage: 1 + 5, 2 + 1, 3 + 1. Medians 2 and 1 would give 3.
  whole.stages = {{"samples", {9, 9, 9}},
                  {"delaunay", {4, 4, 4}},
                  {"poles", {1, 2, 3}},
                  {"surface", {5, 1, 1}},
                  {"other", {7, 7, 7}}};
  EXPECT_EQ(whole.seconds_after_delaunay(), 4);
  EXPECT_EQ(whole.stage_seconds("poles"), 2);
  EXPECT_EQ(whole.stage_seconds("smoothing"), 0);
}

TEST(SpeedFigures, GrowthBeginsAtAHundredThousandPoints) {
  // From 100,000 to 400,000 points: CGAL 1 -> 6 s (1.5 per point), own Delaunay 1 -> 8 s (2), the rest 2 -> 12 s (1.5).
  const std::vector<SpeedOutcome> outcomes{sphere_of(10'000, 7, whole_of(7, 7, 7, 7)),
                                           sphere_of(100'000, 1, whole_of(0.5, 1, 1, 0.5)),
                                           sphere_of(400'000, 6, whole_of(2, 8, 8, 2))};
  const std::vector<Growth> growth = growth_of(outcomes);
  ASSERT_EQ(growth.size(), 2U);
  EXPECT_EQ(growth[0].points, 100'000U);
  EXPECT_DOUBLE_EQ(growth[0].rest, 1);
  EXPECT_DOUBLE_EQ(growth[1].cgal, 1.5);
  EXPECT_DOUBLE_EQ(growth[1].delaunay, 2);
  EXPECT_DOUBLE_EQ(growth[1].rest, 1.5);
  EXPECT_DOUBLE_EQ(growth[1].rest_to_cgal(), 1);
}

TEST(SpeedFigures, WhatFailedHasNoGrowthAndIsInTheTable) {
  SpeedOutcome failed = sphere_of(100'000, 1, whole_of(1, 1, 1, 1));
  failed.error = "ended by signal 9";
  const std::vector<SpeedOutcome> outcomes{failed, sphere_of(200'000, 2, whole_of(1, 3, 1, 1))};
  ASSERT_EQ(growth_of(outcomes).size(), 1U);
  const std::string table = to_markdown(outcomes, {"a machine", 2, {{1, 1e10}}}, 1);
  EXPECT_THAT(table, HasSubstr("| sphere-100000 | error: ended by signal 9 |"));
  EXPECT_THAT(table, HasSubstr("10.0 GB/s on 1 thread. Medians of 1 run."));
  EXPECT_THAT(table, HasSubstr("| sphere-200000 | 200000 | 1 | 2.00 | 6.00 | 3.00 | 0.50 |")); // whole, after Delaunay
  EXPECT_THAT(table, HasSubstr("| delaunay | 1.500 |"));
  EXPECT_THAT(table, HasSubstr("| samples | 0.500 |\n| delaunay")); // in the order of the run
}

} // namespace
} // namespace eigencrust::bench
