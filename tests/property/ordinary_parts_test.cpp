// SPDX-License-Identifier: GPL-3.0-or-later
// What people bring that is no statue: parts with sharp edges, thin walls, tiny bodies, noise beside none.
#include <eigencrust/eigencrust.h>
#include <eigencrust/error.h>
#include <eigencrust/io.h>

#include <gmock/gmock.h>

#include "clouds.h"
#include "noisy.h"
#include "source_folder.h"

namespace eigencrust {
namespace {

using clouds::Points;

MeshSummary mesh_of(const Points& points, const Options& options = {}) {
  const Result result = reconstruct(clouds::cloud_of(points), options);
  EXPECT_THAT(result.report.broken_guarantees, testing::IsEmpty());
  return result.report.mesh;
}

TEST(OrdinaryParts, GriddedBoxesAreExact) {
  for (const unsigned n : {1u, 2u, 3u, 7u, 15u}) {
    SCOPED_TRACE(n);
    const MeshSummary mesh = mesh_of(clouds::cube_surface(n));
    const double side = n;
    EXPECT_EQ(mesh.vertices, 6 * n * n + 2);
    EXPECT_EQ(mesh.components, 1u);
    EXPECT_EQ(mesh.genus, 0);
    EXPECT_NEAR(mesh.volume, side * side * side, 1e-9 * side * side * side);
    EXPECT_NEAR(mesh.area, 6 * side * side, 1e-9 * side * side);
  }
}

TEST(OrdinaryParts, TinyBodiesAreTheirHull) {
  const MeshSummary prism = mesh_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 2}, {1, 0, 2}, {0, 1, 2}});
  EXPECT_EQ(prism.vertices, 6u);
  EXPECT_NEAR(prism.volume, 1, 1e-9);
  const MeshSummary octahedron = mesh_of({{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}});
  EXPECT_NEAR(octahedron.volume, 4.0 / 3, 1e-9);
}

TEST(OrdinaryParts, AShellOfOutliersIsNoBodyAndACoarseBodyIsOne) {
  const Points ball = clouds::sphere(20000, 0.5);
  for (const std::uint64_t seed : {1u, 2u}) {
    Points shell;
    for (const Vec3& p : clouds::random_box(9000, seed, 1.3))
      if (norm(p) > 1.1 && norm(p) < 1.3) shell.push_back(p);
    Options all;
    all.components.kind = KeepComponents::Kind::all;
    EXPECT_GT(mesh_of(clouds::joined(ball, shell), all).components, 1u);
    const MeshSummary mesh = mesh_of(clouds::joined(ball, shell));
    EXPECT_EQ(mesh.components, 1u);
    EXPECT_EQ(mesh.vertices, 20000u);
    EXPECT_NEAR(mesh.volume, 4 * std::numbers::pi / 3 * 0.125, 0.001); // whatever the space in the shell was taken for
  }
  // Three times as coarse: its samples are lonely, but it is smooth.
  const MeshSummary both = mesh_of(clouds::joined(ball, clouds::moved(clouds::sphere(600, 0.25), {3, 0, 0})));
  EXPECT_EQ(both.components, 2u);
  EXPECT_GT(both.vertices, 20500u);
}

TEST(OrdinaryParts, WhatIsMissingIsTold) {
  const auto warnings = [](double wall) {
    const Points plate = clouds::lattice(31, 31, 2);
    Points flat;
    for (const Vec3& p : plate) flat.push_back({p.x, p.y, wall * p.z});
    return reconstruct(clouds::cloud_of(flat), {}).report.warnings;
  };
  EXPECT_THAT(warnings(1), testing::IsEmpty());
  // Two sheets a tenth of a spacing apart are none for which an inside could be found.
  EXPECT_THAT(warnings(0.1), testing::Contains(testing::HasSubstr("apart from the surface")));
}

TEST(OrdinaryParts, ClumpsOfOutliersAreNoBodies) {
  const Points ball = clouds::sphere(30000);
  Points clumps, bodies;
  for (std::uint64_t k = 0; k < 4; ++k) {
    const Vec3 place{k % 2 == 0 ? 2.0 : -2.0, k < 2 ? 2.0 : -2.0, 0};
    clumps = clouds::joined(clumps, clouds::moved(clouds::random_box(200, k, 0.1), place));
    // As thick as its neighbourhoods are wide, but no sample is passed by.
    bodies = clouds::joined(bodies, clouds::moved(clouds::cube_surface(3), place, 0.05));
  }
  const MeshSummary without = mesh_of(clouds::joined(ball, clumps));
  EXPECT_EQ(without.components, 1u);
  EXPECT_EQ(without.vertices, 30000u);
  const MeshSummary with = mesh_of(clouds::joined(ball, bodies));
  EXPECT_EQ(with.components, 5u);
  EXPECT_EQ(with.vertices, 30000u + 4 * 56);
}

/// Two spheres one within the other, `wall` apart, with one spacing of about 0.036.
Points hollow_ball(double wall, double noise, std::uint64_t seed) {
  const double inner = 1 - wall;
  Points points =
      clouds::joined(clouds::sphere(10000), clouds::sphere(static_cast<std::size_t>(10000 * inner * inner), inner));
  return clouds::jittered(std::move(points), noise, seed);
}

TEST(OrdinaryParts, NothingReachesForStraysOffFlatFaces) {
  // Pairs of strays, too, which are near each other and not near the face.
  constexpr unsigned side = 40;
  for (const double share : {0.01, 0.05, 0.2}) {
    Points points = clouds::jittered(clouds::cube_surface(side), 0.3, 5);
    const std::size_t on_faces = points.size();
    for (Vec3& p : points) // on the faces again
      for (double* x : {&p.x, &p.y, &p.z})
        if (*x < 0.4 || *x > side - 0.4) *x = *x < 0.4 ? 0 : side;
    const auto strays = static_cast<std::size_t>(share * static_cast<double>(on_faces));
    for (const Vec3& p : clouds::random_box(strays, 8, 0.65 * side)) points.push_back(p + 0.5 * side * Vec3{1, 1, 1});
    const Result result = reconstruct(clouds::cloud_of(points));
    EXPECT_EQ(result.report.mesh.genus, 0);
    std::size_t spikes = 0, kept = 0;
    for (const Vec3& p : result.mesh.vertices) {
      const Vec3 beyond{std::fabs(p.x - side / 2.0), std::fabs(p.y - side / 2.0), std::fabs(p.z - side / 2.0)};
      const double off = std::max({beyond.x, beyond.y, beyond.z}) - side / 2.0;
      spikes += std::fabs(off) > 1.5;
      kept += off == 0;
    }
    EXPECT_LE(spikes, 1u) << share;
    EXPECT_GT(static_cast<double>(kept), 0.999 * static_cast<double>(on_faces)) << share;
  }
}

TEST(OrdinaryParts, ThinWallsAreNotFilled) {
  for (const double wall_in_spacings : {1.5, 1.8, 3.0})
    for (const double noise : {0.0, 0.002}) {
      const double wall = 0.0355 * wall_in_spacings, inner = 1 - wall;
      SCOPED_TRACE(wall_in_spacings);
      Options options;
      options.inside_points = {{1 - wall / 2, 0, 0}};
      options.outside_points = {{0, 0, 0}};
      const MeshSummary mesh = mesh_of(hollow_ball(wall, noise, 3), options);
      EXPECT_EQ(mesh.components, 2u);
      EXPECT_NEAR(mesh.volume / (4.1888 * (1 - inner * inner * inner)), 1, 0.03);
    }
}

TEST(OrdinaryParts, ASheetOneSpacingThickKeepsItsSides) {
  Points plate;
  for (const Vec3& p : clouds::lattice(31, 31, 2)) plate.push_back(p);
  const MeshSummary mesh = mesh_of(plate);
  EXPECT_EQ(mesh.components, 1u);
  EXPECT_NEAR(mesh.volume, 900, 9);
}

TEST(OrdinaryParts, ANoisyBodyLeavesACleanOneAlone) {
  const Points clean = clouds::sphere(8000);
  const Points noisy = clouds::moved(clouds::jittered(clouds::sphere(24000, 1), 0.06, 4), {4, 0, 0});
  const Result result = reconstruct(clouds::cloud_of(clouds::joined(clean, noisy)));
  EXPECT_EQ(result.report.mesh.components, 2u);
  const auto kept =
      std::count_if(result.mesh.vertices.begin(), result.mesh.vertices.end(), [](const Vec3& v) { return v.x < 1.5; });
  EXPECT_GE(kept, 7920);
  EXPECT_NEAR(result.report.mesh.volume / (2 * 4.1888), 1, 0.03);
}

TEST(OrdinaryParts, NoiseMeasuredIsReported) {
  const Result result = reconstruct(clouds::cloud_of(clouds::jittered(clouds::sphere(20000), 0.05, 5)));
  double reported = 0;
  for (const StageReport& stage : result.report.stages)
    if (stage.name == "sample_model")
      for (const auto& [name, value] : stage.counts)
        if (name == "grid_spacing_median") reported = value;
  EXPECT_NEAR(reported / 1.2, 0.05 / std::sqrt(3.0), 0.01); // deviation of even noise in ±0.05
}

// A cluster whose samples are apart by the last digit of their coordinates, since a stray far away keeps the origin
// from it: centres of circumspheres round onto samples.
TEST(OrdinaryParts, TheEnergyIsANumberWhereCentresRoundOntoSamples) {
  Points points{{-5.6661873516763122e28, -7.4814378972478658e27, -4.81327006960015e27}};
  const Points apart{{-1, 0, 0}, {-1, 1, -2}, {0, -2, 1}, {0, -1, 0}, {0, 0, 1},   {0, 0, 0},
                     {0, 0, -1}, {0, 1, 0},   {0, 1, -2}, {1, -1, 0}, {1, -1, -1}, {1, 0, 0}};
  for (const Vec3& p : apart) points.push_back(Vec3{5903789242941675, 6136668703515533, -5242763564974025} + p);
  Options options;
  options.noise = {LengthChoice::Kind::length, 0.003};
  options.facade = Axis::minus_z;
  const Result result = reconstruct(clouds::cloud_of(points), options);
  double energy = std::numeric_limits<double>::quiet_NaN();
  for (const StageReport& stage : result.report.stages)
    if (stage.name == "minimum_cut")
      for (const auto& [name, value] : stage.counts)
        if (name == "energy") energy = value;
  EXPECT_TRUE(std::isfinite(energy));
}

TEST(OrdinaryParts, NoiseFarAboveTheSpacingGetsAWarning) {
  // In spacings of 0.025: deviations of 3 and of 0.7.
  const auto warnings = [](double jitter) {
    const Result result = reconstruct(clouds::cloud_of(clouds::jittered(clouds::sphere(20000), jitter, 5)));
    return std::count_if(result.report.warnings.begin(), result.report.warnings.end(), [](const std::string& warning) {
      return warning.find("noise is larger than the samples are apart") != std::string::npos;
    });
  };
  EXPECT_EQ(warnings(0.13), 1);
  EXPECT_EQ(warnings(0.03), 0);
}

TEST(OrdinaryParts, PointsThatFillAVolumeGetAWarning) {
  const Result result = reconstruct(clouds::cloud_of(clouds::random_box(6000, 6)));
  EXPECT_THAT(result.report.warnings, testing::Contains(testing::HasSubstr("fill a volume")));
}

TEST(OrdinaryParts, APartLeftOutGetsAWarningAndOutliersGetNone) {
  const auto warns = [](const Points& points) {
    return testing::Value(reconstruct(clouds::cloud_of(points)).report.warnings,
                          testing::Contains(testing::HasSubstr("side by side apart from the surface")));
  };
  // A sheet within a ball bounds nothing.
  const Points ball = clouds::sphere(8000);
  const Points within = clouds::moved(clouds::lattice(16, 16, 1, 0.04), {-0.3, -0.3, 0.1});
  EXPECT_TRUE(warns(clouds::joined(ball, within)));
  EXPECT_FALSE(warns(clouds::joined(ball, clouds::random_box(400, 3, 1.2))));
  EXPECT_FALSE(warns(clouds::jittered(ball, 0.03, 3)));
}

TEST(OrdinaryParts, AScrapIsNoSuccess) {
  // Ground with its places in degrees and its heights in metres is next to a line: what comes out holds a few samples.
  Points points;
  for (int i = 0; i < 55; ++i)
    for (int j = 0; j < 55; ++j)
      points.push_back({8.4 + 1.4e-3 * i, 49 + 9e-4 * j, 300 + 30 * std::sin(i / 9.0) * std::cos(j / 7.0)});
  const PointCloud cloud = clouds::cloud_of(points);
  Options everything, named;
  everything.components.kind = KeepComponents::Kind::all;
  named.inside_points = {{8.44, 49.02, 300}};
  // The test is worth something: there is a scrap, and who asks for every piece gets it.
  const Result scrap = reconstruct(cloud, everything);
  EXPECT_GT(scrap.mesh.vertices.size(), 3u);
  EXPECT_LT(scrap.mesh.vertices.size(), points.size() / 10);
  for (const Options& options : {Options{}, named}) {
    try {
      const Result result = reconstruct(cloud, options);
      ADD_FAILURE() << "a scrap of " << result.mesh.vertices.size() << " vertices passed";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::no_surface);
      EXPECT_THAT(error.cause(), testing::ContainsRegex("only [1-9][0-9]* of 3025 samples lie on the surface"));
    }
  }
}

TEST(OrdinaryParts, ANoisyFenceOnACleanBlockIsNotFittedAndStaysAtItsRows) {
  // Less than a tenth of the vertices are noisy, which may be curvature. The fence is eased all the same.
  Points points = clouds::moved(clouds::cube_surface(140), {-36, -68, -140});
  const auto in_fence = [](const Vec3& p) { return p.x >= 0 && p.x <= 67 && p.y >= 0 && p.y <= 4; };
  std::erase_if(points, [&](const Vec3& p) { return p.z == 0 && in_fence(p); });
  Points fence = clouds::fence();
  std::erase_if(fence, [](const Vec3& p) { return p.z < 0.5; });
  points = clouds::joined(std::move(points), clouds::noisy(std::move(fence), 0.4, 3));
  const Result result = reconstruct(clouds::cloud_of(points));
  EXPECT_EQ(result.report.mesh.genus, 7);
  EXPECT_EQ(result.report.mesh.components, 1);
  const Attribute& source = *find_attribute(result.mesh.vertex_attributes, "source_index");
  std::size_t moved = 0;
  for (std::size_t v = 0; v < result.mesh.vertices.size(); ++v)
    moved += result.mesh.vertices[v] != points[static_cast<std::size_t>(attribute_value(source, v))];
  EXPECT_LT(moved, 500); // of 8,000; these would cross
}

TEST(OrdinaryParts, NothingReachesForTheStrayPointsUnderTheTeapot) {
  const PointCloud cloud = read_point_cloud(source_folder() / "examples/teapot_scan.ply");
  const Result result = reconstruct(cloud);
  EXPECT_EQ(result.report.mesh.genus, 1);
  EXPECT_GT(result.report.mesh.bounds.min.z, -0.01); // the teapot stands on z = 0; a stray point at -0.13 was taken in
}

} // namespace
} // namespace eigencrust
