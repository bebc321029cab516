// SPDX-License-Identifier: GPL-3.0-or-later
#include "evidence/surroundings.h"

#include <eigencrust/eigencrust.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "clouds.h"
#include "evidence/hidden.h"
#include "evidence/walls.h"

namespace eigencrust {
namespace {

using clouds::Points;

/// What surroundings look at.
Scene scene_of(const Points& points, double noise = 0) {
  const Threads threads(2);
  clouds::Prepared p = clouds::prepare(points);
  Scene scene;
  scene.measures.model = sample_model(p.t.positions.raw(), noise, threads);
  scene.tetrahedralization = std::move(p.t);
  scene.sample_of_row = std::move(p.sample_of_row);
  scene.stars = std::move(p.stars);
  scene.poles = std::move(p.poles);
  return scene;
}

PointCloud seen_from(Points points, const Vec3& place) {
  PointCloud cloud = clouds::cloud_of(std::move(points));
  cloud.sensors = {{place, false}};
  cloud.sensor_of.assign(cloud.points.size(), 0);
  return cloud;
}

HullSight sight_of(const PointCloud& cloud) {
  const Scene scene = scene_of(cloud.points);
  const Tetrahedralization& t = scene.tetrahedralization;
  const auto lines = sight_lines(cloud, scene.sample_of_row, t, SampleLengths(t.sample_count, 0), {});
  return hull_sight(t, scene.stars, lines, Threads(2));
}

TEST(HullSight, IsThatOfTheSensors) {
  const Points cube = clouds::cube_surface(8);
  const double area = 6 * 8 * 8;
  const HullSight within = sight_of(seen_from(cube, {3, 4.5, 4}));
  EXPECT_NEAR(within.within, area, 1e-9 * area);
  EXPECT_EQ(within.without, 0);
  // Also what lies on the far side: its line leaves the hull on its way.
  const HullSight without = sight_of(seen_from(cube, {3, 4.5, 40}));
  EXPECT_EQ(without.within, 0);
  EXPECT_NEAR(without.without, area, 1e-9 * area);
}

TEST(HullSight, SharesASampleOfSeveralSensors) {
  PointCloud cloud = seen_from(clouds::cube_surface(8), {3.9, 4.2, 4.5});
  const std::size_t n = cloud.points.size();
  cloud.sensors.push_back({{3.7, 4.45, 50}, false}); // its lines run within no plane of the lattice
  for (std::size_t i = 0; i < n; ++i) {
    cloud.points.push_back(cloud.points[i]);
    cloud.sensor_of.push_back(1);
  }
  const HullSight sight = sight_of(cloud);
  EXPECT_NEAR(sight.within, sight.without, 1e-9 * sight.within);
}

Points heights(unsigned n, const std::function<double(double, double)>& height) {
  Points points;
  clouds::Random random(3);
  for (unsigned i = 0; i < n; ++i)
    for (unsigned j = 0; j < n; ++j) {
      const double x = i + 0.4 * random.uniform(), y = j + 0.4 * random.uniform();
      points.push_back({x, y, height(x, y)});
    }
  return points;
}

TEST(AxisReading, TellsGroundFromBodies) {
  constexpr int z = 2;
  const Threads threads(2);
  const auto stacked = [&](const Points& points, int axis) {
    return read_axis(scene_of(points), axis, threads).stacked;
  };
  const Points hills = heights(30, [](double x, double y) { return 3 * std::sin(x / 5) * std::cos(y / 4); });
  EXPECT_LT(stacked(hills, z), 0.05);
  EXPECT_GT(stacked(hills, 0), 0.9);
  EXPECT_GT(stacked(clouds::sphere(3000), z), 0.9);
  EXPECT_GT(stacked(clouds::torus(3, 1, 80, 30), z), 0.9);
  // A plate one spacing thick.
  Points plate = heights(30, [](double, double) { return 0.0; });
  for (const Vec3& p : heights(30, [](double, double) { return 1.0; })) plate.push_back(p + Vec3{0.3, 0.2, 0});
  EXPECT_GT(stacked(plate, z), 0.75); // as far from ground as other bodies
}

TEST(AxisReading, TellsThinNoisyPlatesFromGround) {
  // Noise hides which sample has another one above it, but not that they lie in two sheets.
  const auto noisy = [](double height) {
    Points points = heights(60, [&](double, double) { return height; });
    return clouds::jittered(points, 0.3, static_cast<std::uint64_t>(2 + height));
  };
  const auto stacked = [](const Points& points) { return read_axis(scene_of(points), 2, Threads(2)).stacked; };
  EXPECT_GT(stacked(clouds::joined(noisy(0), noisy(2.5))), 0.75);
  EXPECT_LT(stacked(noisy(0)), 0.05);
  // Terraces are steps, each with one sheet.
  EXPECT_LT(stacked(heights(60, [](double x, double) { return 2.5 * std::floor(x / 10); })), 0.25);
}

TEST(AxisReading, CountsAreaWhereSamplesLieUnevenly) {
  // A block whose bottom lies in the plane of a scan line, which sampled all of it; its walls have 5 lines.
  clouds::Random random(4);
  Points block;
  for (int k = 0; k < 4000; ++k) block.push_back({10 * random.uniform(), 10 * random.uniform(), 0});
  for (int line = 1; line <= 5; ++line)
    for (int side = 0; side < 4; ++side)
      for (int k = 0; k < 50; ++k) {
        const double along = 0.2 * (k + 0.5 * random.uniform()), level = 2 * line + 0.01 * random.uniform();
        block.push_back(side < 2 ? Vec3{along, 10.0 * side, level} : Vec3{10.0 * (side - 2), along, level});
      }
  EXPECT_GT(read_axis(scene_of(block), 2, Threads(2)).stacked, 0.55); // four fifths are walls; of the samples a fifth
}

TEST(AxisReading, TellsTheCapOfABodyFromGround) {
  const auto cap = [](const std::function<double(double, double)>& height) {
    return read_axis(scene_of(heights(30, height)), 2, Threads(2)).cap;
  };
  const auto from_middle = [](double x, double y) { return std::hypot(x - 15, y - 15); };
  EXPECT_GT(cap([&](double x, double y) { return -0.02 * std::pow(from_middle(x, y), 2); }), 3);
  EXPECT_LT(cap([&](double x, double y) { return std::max(0.0, 5 - from_middle(x, y)); }), 0.5);
  EXPECT_EQ(cap([&](double x, double y) { return 0.6 * x - 0.3 * y; }),
            std::numeric_limits<double>::infinity()); // a plane but for rounding
}

TEST(Surroundings, FollowTheUserFirst) {
  const Points hills = heights(30, [](double x, double y) { return 3 * std::sin(x / 5) * std::cos(y / 4); });
  const Scene scene = scene_of(hills);
  const PointCloud cloud = clouds::cloud_of(hills);
  const auto kind = [&](const Options& options) { return surroundings_of(cloud, scene, options, Threads(1)).kind; };
  Options options;
  EXPECT_EQ(kind(options), SceneKind::facade);
  options.detect_facade = false;
  EXPECT_EQ(kind(options), SceneKind::body);
  options.facade = Axis::minus_x;
  EXPECT_EQ(surroundings_of(cloud, scene, options, Threads(1)).front, Axis::minus_x);
  EXPECT_EQ(kind(Options::of(Preset::paper)), SceneKind::body);
}

/// A roof above flat ground, without walls.
double roof(double x, double y) { return x > 15 && x < 40 && y > 18 && y < 44 ? 30 : 0; }

TEST(Hidden, IsWhatLiesBehindSamplesAndBeforeNone) {
  const Scene scene = scene_of(heights(60, roof));
  const Tetrahedralization& t = scene.tetrahedralization;
  const SampleLengths depth(t.sample_count, 0.5F);
  const Labels named(t.tetrahedra.size());
  const HiddenCounts hidden = count_hidden(scene, {0, 0, 1}, depth, named, Threads(2));
  const HiddenCounts from_below = count_hidden(scene, {0, 0, -1}, depth, named, Threads(1));
  double under = 0, hiding = 0, free = 0, free_but_hiding = 0; // volumes
  for (TetrahedronIndex i{0}; i.value < hidden.size(); ++i.value) {
    if (t.touches_cube(i)) continue;
    const Vec3 p = clouds::centroid(t, i) + t.origin;
    const double volume = clouds::volume(t, i);
    if (p.z < 1 || p.z > 29) continue;
    if (roof(p.x - 1, p.y - 1) > 0 && roof(p.x + 1, p.y + 1) > 0) {
      under += volume;
      if (hidden[i] > 0) hiding += volume;
      EXPECT_LE(from_below[i], 0);
    } else if (roof(p.x - 1, p.y - 1) == 0 && roof(p.x + 1, p.y + 1) == 0) {
      free += volume;
      if (hidden[i] > 0) free_but_hiding += volume;
    }
  }
  EXPECT_GT(hiding, 0.9 * under);          // slivers between two lines are crossed by none
  EXPECT_LT(free_but_hiding, 0.05 * free); // and some lean out from below the roof
}

TEST(Hidden, IsNothingBelowWhatWasSeenFromBelow) {
  // A slab above flat ground: samples on its top and on its underside, and below it.
  Points points = heights(60, [](double, double) { return 0.0; });
  for (const double height : {20.0, 26.0})
    for (const Vec3& p : heights(60, roof))
      if (p.z > 0) points.push_back({p.x + 0.1, p.y + 0.2, height});
  const Scene scene = scene_of(points);
  const Tetrahedralization& t = scene.tetrahedralization;
  const SampleLengths depth(t.sample_count, 0.5F);
  const HiddenCounts hidden = count_hidden(scene, {0, 0, 1}, depth, Labels(t.tetrahedra.size()), Threads(2));
  double free = 0, hiding = 0; // volumes
  for (TetrahedronIndex i{0}; i.value < hidden.size(); ++i.value) {
    const Vec3 p = clouds::centroid(t, i) + t.origin;
    if (t.touches_cube(i) || p.z < 1 || p.z > 19 || roof(p.x - 6, p.y - 6) == 0 || roof(p.x + 6, p.y + 6) == 0)
      continue;
    free += clouds::volume(t, i);
    if (hidden[i] > 0) hiding += clouds::volume(t, i);
  }
  EXPECT_GT(free, 2000);
  EXPECT_LT(hiding, 0.25 * free); // where one line more from above meets a sliver
}

TEST(Hidden, LabelsWhatWasSeenAlongTheAxis) {
  const Scene scene = scene_of(heights(60, roof));
  const Tetrahedralization& t = scene.tetrahedralization;
  EXPECT_TRUE(is_seen_along(scene, Axis::plus_z, Threads(2)));
  EXPECT_FALSE(is_seen_along(scene, Axis::plus_x, Threads(2)));
  const SampleLengths depth(t.sample_count, 0.5F);
  Labels labels(t.tetrahedra.size());
  label_hidden(count_hidden(scene, {0, 0, 1}, depth, labels, Threads(2)), labels);
  double under = 0, inside = 0, free = 0, outside = 0, wrong = 0; // volumes
  for (TetrahedronIndex i{0}; i.value < labels.size(); ++i.value) {
    const Vec3 p = clouds::centroid(t, i) + t.origin;
    const double volume = clouds::volume(t, i);
    if (t.touches_cube(i) || p.z < 1 || p.z > 29) continue;
    if (roof(p.x - 1, p.y - 1) > 0 && roof(p.x + 1, p.y + 1) > 0) {
      under += volume;
      if (labels[i] == Label::inside) inside += volume;
      if (labels[i] == Label::outside) wrong += volume;
    } else if (roof(p.x - 1, p.y - 1) == 0 && roof(p.x + 1, p.y + 1) == 0) {
      free += volume;
      if (labels[i] == Label::outside) outside += volume;
      if (labels[i] == Label::inside) wrong += volume;
    }
  }
  EXPECT_GT(inside, 0.85 * under); // slivers between two lines are crossed by none
  EXPECT_GT(outside, 0.8 * free);
  EXPECT_LT(wrong, 0.05 * (under + free));
}

TEST(Surroundings, RoofsFromTheAirStandOnTheGround) {
  // Three houses of which no wall was seen, noise of 0.3 spacings in height; then with strays above and below.
  const auto roofs = [](double x, double y) {
    return std::hypot(x - 20, y - 20) < 9 || (std::fabs(x - 55) < 8 && std::fabs(y - 20) < 12) ||
                   (std::fabs(x - 35) < 14 && std::fabs(y - 58) < 9)
               ? 18.0
               : 0.0;
  };
  clouds::Random random(9);
  Points points = heights(80, roofs);
  for (Vec3& p : points) p.z += 0.5 * random.uniform(-1, 1);
  const Points clean = points;
  for (const std::size_t strays : {0u, 60u}) {
    points = clean;
    for (std::size_t i = 0; i < strays; ++i)
      points.push_back({random.uniform(0, 80), random.uniform(0, 80), random.uniform(-5, 30)});
    Options options;
    options.threads = 2;
    const Result result = reconstruct(clouds::cloud_of(points), options);
    EXPECT_EQ(result.report.surroundings.kind, SceneKind::facade);
    EXPECT_EQ(result.report.mesh.genus, 0) << strays;
    // Each cell of the map is under its roof, or there is air above its ground.
    std::size_t on_roofs = 0, tents = 0;
    for (const Vec3& p : result.mesh.vertices) {
      on_roofs += p.z > 16;
      tents += p.z > 3 && p.z < 16;
    }
    const auto of_roofs = std::count_if(clean.begin(), clean.end(), [](const Vec3& p) { return p.z > 16; });
    EXPECT_GT(static_cast<double>(on_roofs), 0.95 * static_cast<double>(of_roofs)) << strays;
    EXPECT_LT(tents, 30u) << strays;
  }
}

/// The ground before y = 40, and there a wall 30 high with panes two spacings behind it.
Points street() {
  Points points = heights(80, [](double, double) { return 0.0; });
  std::erase_if(points, [](const Vec3& p) { return p.y > 40; });
  clouds::Random random(4);
  for (unsigned i = 0; i < 80; ++i)
    for (unsigned k = 0; k < 30; ++k) {
      const double x = i + 0.4 * random.uniform(), z = k + 0.4 * random.uniform(), y = 40 + 0.1 * random.uniform(-1, 1);
      points.push_back({x, i % 20 < 8 && k > 4 && k % 15 < 10 ? y + 2 : y, z});
    }
  return points;
}

/// Ground with a shed at its rim, all of whose walls and roof were seen.
Points shed_at_the_rim() {
  const auto is_in = [](double x, double y) { return x > 20 && x < 40 && y > 40; };
  Points points = heights(60, [&](double x, double y) { return is_in(x, y) ? 14.0 : 0.0; });
  clouds::Random random(4);
  for (unsigned i = 0; i < 20; ++i)
    for (unsigned k = 1; k < 14; ++k) {
      const double along = i + 0.4 * random.uniform(), up = k + 0.4 * random.uniform();
      for (const Vec3& p :
           {Vec3{20 + along, 40, up}, Vec3{20 + along, 60, up}, Vec3{20, 40 + along, up}, Vec3{40, 40 + along, up}})
        points.push_back(p);
    }
  return points;
}

TEST(Walls, AtTheRimOfAStreetAreSolidBehind) {
  const Result result = reconstruct(clouds::cloud_of(street()), Options());
  EXPECT_EQ(result.report.surroundings.kind, SceneKind::facade);
  EXPECT_EQ(result.report.mesh.components, 1);
  EXPECT_EQ(result.report.mesh.genus, 0);
  EXPECT_EQ(result.report.mesh.boundary_loops, 1);
  // Nothing of it is behind the panes, and nothing faces that way.
  const TriangleMesh& mesh = result.mesh;
  double backwards = 0, all = 0;
  for (const auto& t : mesh.triangles) {
    const Vec3& a = mesh.vertices[t[0]];
    const Vec3 normal = cross(mesh.vertices[t[1]] - a, mesh.vertices[t[2]] - a);
    all += norm(normal);
    if (normal.y > 0.8 * norm(normal)) backwards += norm(normal);
  }
  EXPECT_LT(backwards, 0.01 * all);
  for (const std::string& warning : result.report.warnings) EXPECT_EQ(warning.find("named"), std::string::npos);
}

TEST(Walls, WhatLiesBehindThemMayBeNamedSolidOnly) {
  Options options;
  options.inside_points = {{40.3, 44, 12}};
  EXPECT_EQ(reconstruct(clouds::cloud_of(street()), options).report.mesh.genus, 0);
  options.outside_points = options.inside_points;
  options.inside_points.clear();
  try {
    reconstruct(clouds::cloud_of(street()), options);
    ADD_FAILURE() << "a point in the solid passed for one outside";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::usage);
    EXPECT_NE(error.cause().find("behind the facade"), std::string::npos);
  }
}

TEST(Walls, OfAShedAtTheRimAreNotSolidBehind) {
  const auto beyond = [](const Points& points) {
    const Scene scene = scene_of(points);
    const Tetrahedralization& t = scene.tetrahedralization;
    const Labels named = known_labels(t, scene.stars, {}, {}, {SceneKind::facade, Axis::plus_z, {}}, Threads(1));
    const SampleLengths depth(t.sample_count, 0.5F);
    return beyond_walls(scene, {0, 0, 1}, count_hidden(scene, {0, 0, 1}, depth, named, Threads(2)), named).size();
  };
  EXPECT_GT(beyond(street()), 20u);
  EXPECT_EQ(beyond(shed_at_the_rim()), 0u);
  EXPECT_EQ(beyond(heights(30, [](double x, double y) { return 3 * std::sin(x / 5) * std::cos(y / 4); })), 0u);
}

TEST(Surroundings, OfGroundAreTheSameWithSensors) {
  const Points hills = heights(30, [](double x, double y) { return 3 * std::sin(x / 5) * std::cos(y / 4); });
  const Scene scene = scene_of(hills);
  const auto kind = [&](const Vec3& place) {
    return surroundings_of(seen_from(hills, place), scene, Options(), Threads(1)).kind;
  };
  EXPECT_EQ(kind({15, 15, 60}), SceneKind::facade);
  EXPECT_EQ(kind({14, 17, 3}), SceneKind::facade); // amid the hills
  EXPECT_NE(kind({15, 15, -60}), SceneKind::facade);
}

TEST(Surroundings, OfAHallWithoutItsCeilingAreItsWalls) {
  // 40 × 40 and 6 high: most samples lie on the floor.
  Points hall = heights(41, [](double, double) { return 0.0; });
  clouds::Random random(5);
  for (unsigned i = 0; i < 41; ++i)
    for (unsigned k = 1; k <= 6; ++k) {
      const double along = i + 0.4 * random.uniform(), up = k - 0.4 * random.uniform();
      for (const Vec3& p : {Vec3{along, 0, up}, Vec3{along, 41, up}, Vec3{0, along, up}, Vec3{41, along, up}})
        hall.push_back(p);
    }
  const Scene scene = scene_of(hall);
  EXPECT_LT(read_axis(scene, 2, Threads(1)).stacked, 0.5);
  EXPECT_EQ(surroundings_of(seen_from(hall, {19.3, 21.2, 2.9}), scene, Options(), Threads(1)).kind,
            SceneKind::interior);
}

} // namespace
} // namespace eigencrust
