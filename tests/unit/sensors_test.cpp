// SPDX-License-Identifier: GPL-3.0-or-later
// The sensors of a cloud are checked before anything is done with them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "samples/check_cloud.h"
#include "support.h"

namespace eigencrust {
namespace {

using ::testing::HasSubstr;

TEST(Sensors, AreChecked) {
  PointCloud cloud;
  cloud.points.resize(3);
  cloud.sensors = {{{1, 2, 3}, false}, {{0, 0.6, 0.8}, true}};
  cloud.sensor_of = {0, PointCloud::no_sensor, 1};
  const auto error = [](const PointCloud& c) { return error_of([&] { check_cloud(c); }); };
  EXPECT_EQ(error(cloud), "");
  PointCloud other = cloud;
  other.sensor_of.clear(); // sensors that saw nothing
  EXPECT_EQ(error(other), "");
  other = cloud;
  other.sensor_of.pop_back();
  EXPECT_THAT(error(other), HasSubstr("2 entries for 3 points"));
  other = cloud;
  other.sensor_of[0] = 2;
  EXPECT_THAT(error(other), HasSubstr("sensor 2 of 2"));
  other = cloud;
  other.sensors[0].place.y = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(error(other), HasSubstr("not finite"));
  other = cloud;
  other.sensors[1].place.z = 2;
  EXPECT_THAT(error(other), HasSubstr("no unit vector"));
}

} // namespace
} // namespace eigencrust
