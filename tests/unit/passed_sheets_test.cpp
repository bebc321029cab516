// SPDX-License-Identifier: GPL-3.0-or-later
// What the surface goes past is told.
#include <eigencrust/eigencrust.h>
#include <gmock/gmock.h>

#include <cmath>

#include "clouds.h"

namespace eigencrust {
namespace {

/// A plate of 70 by 70 by 4 spacings with noise, in whose upper side no sample is within that radius of the middle.
clouds::Points plate(double unseen, std::uint64_t seed) {
  constexpr double length = 70, thickness = 4;
  clouds::Random random(seed);
  clouds::Points points;
  while (points.size() < 11000) {
    const double x = length * random.uniform(), y = length * random.uniform(), z = thickness * random.uniform();
    const double face = random.uniform(0, 2 * length + 4 * thickness);
    if (face < length)
      points.push_back({x, y, 0});
    else if (face < 2 * length)
      points.push_back({x, y, thickness});
    else if (face < 2 * length + 2 * thickness)
      points.push_back({x, face < 2 * length + thickness ? 0 : length, z});
    else
      points.push_back({face < 2 * length + 3 * thickness ? 0 : length, y, z});
  }
  points = clouds::jittered(points, 0.35, seed);
  std::erase_if(points, [&](const Vec3& p) {
    return p.z > thickness / 2 && std::hypot(p.x - length / 2, p.y - length / 2) < unseen;
  });
  return points;
}

double sheets_of(const Report& report) {
  for (const StageReport& stage : report.stages)
    if (stage.name == "sheets")
      for (const auto& [name, count] : stage.counts)
        if (name == "sheets") return count;
  return -1;
}

TEST(PassedSheets, OfAWallSeenFromOneSideAreTold) {
  const Report whole = reconstruct(clouds::cloud_of(plate(0, 1)), {}).report;
  EXPECT_EQ(sheets_of(whole), 0);
  EXPECT_THAT(whole.warnings, testing::Each(testing::Not(testing::HasSubstr("side by side"))));
  const Report one_sided = reconstruct(clouds::cloud_of(plate(22, 1)), {}).report;
  EXPECT_GE(sheets_of(one_sided), 1);
  // The middle of the plate.
  EXPECT_THAT(
      one_sided.warnings,
      testing::Contains(testing::ContainsRegex("around (2[5-9]|3[0-9]|4[0-5])[.][0-9]*,(2[5-9]|3[0-9]|4[0-5])[.]")));
}

} // namespace
} // namespace eigencrust
