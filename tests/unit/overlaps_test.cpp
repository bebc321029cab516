// SPDX-License-Identifier: GPL-3.0-or-later
#include <eigencrust/eigencrust.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "clouds.h"

namespace eigencrust {
namespace {

using clouds::Points;

double chambers_of(const Result& result) {
  for (const StageReport& stage : result.report.stages)
    if (stage.name == "overlaps")
      for (const auto& [name, value] : stage.counts)
        if (name == "chambers") return value;
  return -1;
}

Points random_ball(std::size_t n, double radius, const Vec3& centre, std::uint64_t seed) {
  clouds::Random random(seed);
  Points points;
  while (points.size() < n) {
    const Vec3 p = random.in_box(1);
    if (const double length = norm(p); length <= 1 && length > 0.1) points.push_back((radius / length) * p + centre);
  }
  return points;
}

/// Two unit balls whose centres are `apart`.
Points two_balls(double apart, std::size_t n = 8000) {
  return clouds::joined(random_ball(n, 1, {}, 1), random_ball(n, 1, {apart, 0, 0}, 2));
}
double volume_of_two_balls(double apart) {
  const double cap = 1 - apart / 2;
  return 2 * std::numbers::pi * (4.0 / 3 - cap * cap * (3 - cap) / 3);
}

TEST(Overlaps, OfTwoBallsAreSolid) {
  for (const double apart : {0.8, 1.2, 1.6}) {
    const Result result = reconstruct(clouds::cloud_of(two_balls(apart)));
    EXPECT_EQ(chambers_of(result), 1) << apart;
    EXPECT_EQ(result.report.mesh.components, 1u) << apart;
    EXPECT_EQ(result.report.mesh.genus, 0) << apart;
    EXPECT_NEAR(result.report.mesh.volume / volume_of_two_balls(apart), 1, 0.01) << apart;
    const auto is_about_it = [](const std::string& warning) {
      return warning.find("1 chamber where parts overlap was taken to be solid") != std::string::npos;
    };
    EXPECT_EQ(std::count_if(result.report.warnings.begin(), result.report.warnings.end(), is_about_it), 1);
    const auto is_about_samples = [](const std::string& warning) {
      return warning.find("samples lie side by side apart") != std::string::npos;
    };
    EXPECT_EQ(std::count_if(result.report.warnings.begin(), result.report.warnings.end(), is_about_samples), 0);
  }
}

TEST(Overlaps, AreSolidAmidNoiseAndWhereOneBallIsCoarser) {
  const double spacing = 0.04;
  const Result noisy = reconstruct(clouds::cloud_of(clouds::jittered(two_balls(1.2), 0.4 * spacing, 3)));
  EXPECT_EQ(noisy.report.mesh.genus, 0);
  EXPECT_NEAR(noisy.report.mesh.volume / volume_of_two_balls(1.2), 1, 0.01);
  const Points uneven = clouds::joined(random_ball(12000, 1, {}, 1), random_ball(3000, 1, {1.2, 0, 0}, 2));
  const Result coarse = reconstruct(clouds::cloud_of(uneven));
  EXPECT_EQ(coarse.report.mesh.genus, 0);
  EXPECT_NEAR(coarse.report.mesh.volume / volume_of_two_balls(1.2), 1, 0.01);
}

/// Samples of a box's surface, turned around the y axis.
Points turned_box(std::size_t n, const Vec3& half, double angle, const Vec3& centre, std::uint64_t seed) {
  clouds::Random random(seed);
  Points points;
  const double x = half.y * half.z, y = half.x * half.z, z = half.x * half.y;
  while (points.size() < n) {
    const double face = random.uniform(0, x + y + z), side = random.uniform() < 0.5 ? -1 : 1;
    Vec3 p{random.uniform(-half.x, half.x), random.uniform(-half.y, half.y), random.uniform(-half.z, half.z)};
    (face < x ? p.x : face < x + y ? p.y : p.z) = side * (face < x ? half.x : face < x + y ? half.y : half.z);
    points.push_back(
        Vec3{std::cos(angle) * p.x + std::sin(angle) * p.z, p.y, std::cos(angle) * p.z - std::sin(angle) * p.x} +
        centre);
  }
  return points;
}

TEST(Overlaps, OfBoxesWhoseFacesMeetAtSmallAnglesAreSolid) {
  for (const double degrees : {8.0, 12.0, 20.0}) {
    const Vec3 half{1, 0.6, 0.6};
    const Points boxes = clouds::joined(turned_box(12000, half, 0, {}, 1),
                                        turned_box(12000, half, degrees * std::numbers::pi / 180, {0.7, 0.15, 0.3}, 2));
    const Result result = reconstruct(clouds::cloud_of(boxes));
    EXPECT_EQ(chambers_of(result), 1) << degrees;
    EXPECT_EQ(result.report.mesh.components, 1u) << degrees;
    EXPECT_EQ(result.report.mesh.genus, 0) << degrees;
  }
}

TEST(Overlaps, OfThreeBallsAreSolid) {
  Points points;
  for (int k = 0; k < 3; ++k)
    points = clouds::joined(
        points, random_ball(8000, 1, {0.7 * std::cos(2.1 * k), 0.7 * std::sin(2.1 * k), 0}, static_cast<unsigned>(k)));
  const Result result = reconstruct(clouds::cloud_of(points));
  EXPECT_EQ(chambers_of(result), 3);
  EXPECT_EQ(result.report.mesh.components, 1u);
  EXPECT_EQ(result.report.mesh.genus, 0);
}

TEST(Overlaps, DoNotDependOnThreads) {
  Options one, three;
  one.threads = 1;
  three.threads = 3;
  const PointCloud cloud = clouds::cloud_of(two_balls(1.2));
  EXPECT_EQ(reconstruct(cloud, one).mesh.triangles, reconstruct(cloud, three).mesh.triangles);
}

TEST(Overlaps, StayOpenWhereAPointSaysSo) {
  Options options;
  options.outside_points = {{0.6, 0, 0}};
  const Result result = reconstruct(clouds::cloud_of(two_balls(1.2)), options);
  EXPECT_EQ(chambers_of(result), 0);
  EXPECT_LT(result.report.mesh.volume, 0.95 * volume_of_two_balls(1.2));
}

TEST(Overlaps, OfTheHybridAreSolid) {
  Options options;
  options.method = Method::spectral_powercrust;
  const Result result = reconstruct(clouds::cloud_of(two_balls(1.2)), options);
  EXPECT_NEAR(result.report.mesh.volume / volume_of_two_balls(1.2), 1, 0.01);
}

/// Samples at random on the surface that a line turned around the z axis makes; of it radius and height.
Points turned(const std::vector<std::array<double, 2>>& line, std::size_t n, double noise, std::uint64_t seed) {
  clouds::Random random(seed);
  std::vector<double> area{0};
  for (std::size_t k = 1; k < line.size(); ++k)
    area.push_back(area.back() + (line[k][0] + line[k - 1][0]) *
                                     std::hypot(line[k][0] - line[k - 1][0], line[k][1] - line[k - 1][1]));
  Points points;
  while (points.size() < n) {
    const double at = random.uniform(0, area.back()), angle = random.uniform(0, 2 * std::numbers::pi);
    const auto k = static_cast<std::size_t>(std::upper_bound(area.begin() + 1, area.end() - 1, at) - area.begin());
    const double t = (at - area[k - 1]) / (area[k] - area[k - 1]);
    const double r = line[k - 1][0] + t * (line[k][0] - line[k - 1][0]);
    points.push_back(
        Vec3{r * std::cos(angle), r * std::sin(angle), line[k - 1][1] + t * (line[k][1] - line[k - 1][1])} +
        random.in_box(noise));
  }
  return points;
}

/// A bottle: a ball of radius 1 with a wall of 0.14 and a neck.
std::vector<std::array<double, 2>> bottle(double neck) {
  std::vector<std::array<double, 2>> line;
  constexpr int steps = 60;
  const auto arc = [&](double radius, double narrow, int k) {
    const double end = std::numbers::pi - std::asin(narrow / radius), angle = end * k / steps;
    line.push_back({radius * std::sin(angle), -radius * std::cos(angle)});
  };
  for (int k = 0; k <= steps; ++k) arc(1, neck + 0.14, k);
  line.push_back({neck + 0.14, 1.8});
  line.push_back({neck, 1.8});
  for (int k = steps; k >= 0; --k) arc(0.86, neck, k);
  return line;
}

TEST(Overlaps, BottlesAreEmpty) {
  constexpr double spacing = 0.033;
  for (const std::uint64_t seed : {4u, 5u, 6u}) {
    const Result result = reconstruct(clouds::cloud_of(turned(bottle(3 * spacing), 20000, 0.35 * spacing, seed)));
    EXPECT_EQ(chambers_of(result), 0) << seed;
    EXPECT_EQ(result.report.mesh.genus, 0) << seed;
    EXPECT_LT(result.report.mesh.volume, 0.5 * 4 * std::numbers::pi / 3) << seed;
  }
}

TEST(Overlaps, CavitiesAreNone) {
  // Spacing 0.04; one cavity near the wall, one deep, one with noise and a wall of three spacings.
  for (const double offset : {0.0, 0.25}) {
    const Points hollow = clouds::joined(random_ball(8000, 1, {}, 1), random_ball(4000, 0.6, {offset, 0, 0}, 2));
    const Result result = reconstruct(clouds::cloud_of(hollow));
    EXPECT_EQ(chambers_of(result), 0) << offset;
    EXPECT_EQ(result.report.mesh.components, 2u) << offset;
  }
  const Points thin = clouds::joined(random_ball(8000, 1, {}, 1), random_ball(6000, 0.88, {}, 2));
  EXPECT_EQ(chambers_of(reconstruct(clouds::cloud_of(clouds::jittered(thin, 0.035, 3)))), 0);
}

TEST(Overlaps, VesselsWithANarrowNeckAreNone) {
  const double wall = 0.16;
  for (const double neck : {0.03, 0.05, 0.08}) {
    Points points;
    for (const double radius : {1.0, 1 - wall})
      for (const Vec3& p : random_ball(8000, radius, {}, radius == 1 ? 1 : 2))
        if (p.z < 0 || std::hypot(p.x, p.y) > neck * radius) points.push_back(p);
    clouds::Random random(3);
    for (int k = 0; k < 40; ++k) { // the neck's side
      const double radius = 1 - wall * random.uniform(), u = 2 * std::numbers::pi * random.uniform();
      points.push_back({neck * radius * std::cos(u), neck * radius * std::sin(u), radius});
    }
    EXPECT_EQ(chambers_of(reconstruct(clouds::cloud_of(points))), 0) << neck;
  }
}

TEST(Overlaps, PoresBetweenTouchingBeadsAreNone) {
  // Beads of 12 spacings' radius at the places of a face-centred lattice, the pore between six of them in the middle.
  Points points;
  std::uint64_t seed = 0;
  for (int i = -1; i <= 1; ++i)
    for (int j = -1; j <= 1; ++j)
      for (int k = -1; k <= 1; ++k)
        if ((i + j + k) % 2 != 0) {
          const Vec3 centre{static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)};
          points = clouds::joined(points, random_ball(1900, 1.01 / std::numbers::sqrt2, centre, ++seed));
        }
  EXPECT_EQ(chambers_of(reconstruct(clouds::cloud_of(points))), 0);
}

} // namespace
} // namespace eigencrust
