// SPDX-License-Identifier: GPL-3.0-or-later
// The other methods on clouds whose surface is known.
#include <eigencrust/eigencrust.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "clouds.h"
#include "support.h"

namespace eigencrust {
namespace {

using clouds::Points;
constexpr double pi = std::numbers::pi;

Result by(Method method, const Points& points, unsigned threads = 0) {
  Options options;
  options.method = method;
  options.threads = threads;
  return reconstruct(clouds::cloud_of(points), options);
}

constexpr std::array all{Method::eigencrust,   Method::powercrust,    Method::spectral_powercrust,
                         Method::tight_cocone, Method::robust_cocone, Method::spectral_cocone};

TEST(Crusts, CleanTorusByEachMethod) {
  const Points points = clouds::jittered(clouds::torus(2, 0.7, 120, 42), 0.005, 7);
  const double volume = 2 * pi * pi * 2 * 0.7 * 0.7;
  for (const Method method : all) {
    const Result result = by(method, points);
    SCOPED_TRACE(to_string(method));
    const MeshSummary& m = result.report.mesh;
    EXPECT_TRUE(m.closed());
    EXPECT_TRUE(m.oriented());
    EXPECT_EQ(m.components, 1u);
    EXPECT_EQ(m.genus, 1);
    EXPECT_NEAR(m.volume, volume, 0.01 * volume);
  }
}

TEST(Crusts, TightCoconeHasTheTrianglesOfEigencrustOnCleanSamples) {
  const Points points = clouds::jittered(clouds::torus(2, 0.7, 120, 42), 0.005, 8);
  Options options; // as the labels leave the surface
  options.surface = SurfaceKind::delaunay;
  const auto ours = clouds::triangle_set(reconstruct(clouds::cloud_of(points), options).mesh),
             theirs = clouds::triangle_set(by(Method::tight_cocone, points).mesh);
  std::vector<std::array<Vec3, 3>> common;
  std::set_intersection(ours.begin(), ours.end(), theirs.begin(), theirs.end(), std::back_inserter(common));
  EXPECT_GE(static_cast<double>(common.size()), 0.99 * static_cast<double>(ours.size()));
}

// A cap without samples: the cocone ends there, and the smallest faces close it.
TEST(Crusts, TightCoconeClosesAHole) {
  Points points = clouds::sphere(3000);
  std::erase_if(points, [](const Vec3& p) { return p.z > 0.93; });
  const MeshSummary m = by(Method::tight_cocone, points).report.mesh;
  EXPECT_TRUE(m.closed());
  EXPECT_EQ(m.components, 1u);
  EXPECT_NEAR(m.volume, 4 * pi / 3, 0.05 * 4 * pi / 3);
}

TEST(Crusts, RobustCoconeKeepsTheOuterBoundaryOfNoise) {
  const Points noisy = clouds::jittered(clouds::sphere(6000), 0.06, 9); // two spacings to either side
  const Result robust = by(Method::robust_cocone, noisy);
  EXPECT_TRUE(robust.report.mesh.closed());
  EXPECT_EQ(robust.report.mesh.genus, 0);
  // Outside of the middle of the noise by more than half of its width.
  EXPECT_GT(robust.report.mesh.volume, 4 * pi / 3 * std::pow(1.03, 3));
  EXPECT_LT(robust.report.mesh.volume, 4 * pi / 3 * std::pow(1.06, 3));
  // Without that filter little or nothing is left.
  const auto volume_of_tight = [&] {
    try {
      return by(Method::tight_cocone, noisy).report.mesh.volume;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::no_surface);
      return 0.0;
    }
  };
  EXPECT_LT(volume_of_tight(), 1);
  // Rows keep their numbers.
  const Attribute* source = find_attribute(robust.mesh.vertex_attributes, "source_index");
  ASSERT_NE(source, nullptr);
  for (std::size_t v = 0; v < robust.mesh.vertices.size(); ++v)
    EXPECT_EQ(robust.mesh.vertices[v], noisy[static_cast<std::size_t>(attribute_value(*source, v))]);
}

// Balls between the samples of thin noise are big, too, but do not intersect those outside deeply.
TEST(Crusts, RobustCoconeDoesNotWalkIntoTheNoise) {
  for (const double noise : {0.03, 0.04}) { // half a spacing and more
    SCOPED_TRACE(noise);
    const Points noisy = clouds::jittered(clouds::torus(2, 0.7, 240, 84), noise, 7);
    const MeshSummary m = by(Method::robust_cocone, noisy).report.mesh;
    EXPECT_TRUE(m.closed());
    EXPECT_EQ(m.components, 1u);
    EXPECT_EQ(m.genus, 1);
  }
}

// Strays all around hide the object from what walks in from outside: that is said, and no scrap of strays given out for
// it.
TEST(Crusts, NoScrapPassesForASurface) {
  Points points = clouds::sphere(20'000);
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> place(-1.5, 1.5);
  for (int i = 0; i < 600; ++i) points.push_back({place(random), place(random), place(random)});
  for (const Method method : {Method::tight_cocone, Method::robust_cocone, Method::spectral_cocone}) {
    SCOPED_TRACE(to_string(method));
    try {
      const MeshSummary m = by(method, points).report.mesh;
      EXPECT_GT(m.volume, 0.5 * 4 * pi / 3); // found all the same
      EXPECT_GT(m.vertices, 10'000u);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::no_surface);
    }
  }
}

TEST(Crusts, SameForAnyNumberOfThreads) {
  const Points points = clouds::jittered(clouds::sphere(1500), 0.03, 10);
  for (const Method method : all)
    EXPECT_EQ(by(method, points, 1).mesh.triangles, by(method, points, 3).mesh.triangles) << to_string(method);
}

// Of a few cocircular points in a plane and some strays poles may be larger than the box around everything: their cells
// reach to infinity, and would be left open.
TEST(Crusts, WhatReachesToInfinityIsOutside) {
  int meshes = 0;
  for (std::uint32_t seed = 1; seed <= 100; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> coordinate(-1, 1);
    std::uniform_int_distribution<int> step(0, 8);
    Points points;
    for (int i = 0; i < 34; ++i) points.push_back({double(step(random)), double(step(random)), 0});
    for (int i = 0; i < 3; ++i) points.push_back({coordinate(random), coordinate(random), coordinate(random)});
    try {
      const Result result = by(Method::powercrust, points);
      EXPECT_TRUE(result.report.mesh.closed()) << seed;
      ++meshes;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::no_surface);
    }
  }
  EXPECT_GT(meshes, 80);
}

TEST(Crusts, RefuseWhatOnlyEigencrustKnows) {
  const auto answer = [](auto&& change) {
    Options options;
    options.method = Method::powercrust;
    change(options);
    return error_of([&] { check_options(options); });
  };
  EXPECT_NE(answer([](Options& o) { o.facade = Axis::plus_z; }).find("leave out --method"), std::string::npos);
  EXPECT_NE(answer([](Options& o) { o.base = true; }).find("leave out --method"), std::string::npos);
  EXPECT_NE(answer([](Options& o) { o.trim = true; }).find("leave out --method"), std::string::npos);
  EXPECT_NE(answer([](Options& o) { o.surface = SurfaceKind::fitted; }).find("leave out --surface"), std::string::npos);
}

} // namespace
} // namespace eigencrust
