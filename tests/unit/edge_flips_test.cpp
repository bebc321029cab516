// SPDX-License-Identifier: GPL-3.0-or-later
// Edges that are flipped where the other diagonal is nearer to the surface.
#include "fit/edge_flips.h"

#include <eigencrust/eigencrust.h>
#include <eigencrust/validate.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "clouds.h"
#include "geometry/mesh_topology.h"

namespace eigencrust {
namespace {

using clouds::Points;

/// A ridge from a to b above c and d, between which the roof is cut off; the tip below is e.
Surface cut_ridge() {
  Surface surface;
  surface.mesh.vertices = {{-1, 0, 1}, {1, 0, 1}, {0, -1, 0.6}, {0, 1, 0.6}, {0, 0, -1}};
  const std::uint32_t a = 0, b = 1, c = 2, d = 3, e = 4;
  surface.mesh.triangles = {{a, c, d}, {c, b, d}, {a, e, c}, {c, e, b}, {b, e, d}, {d, e, a}};
  surface.support = {0.5f, 0.7f, 1, 1, 1, 1};
  return surface;
}

std::vector<float> anything(const Surface& surface) {
  return std::vector<float>(surface.mesh.vertices.size(), std::numeric_limits<float>::infinity());
}

Result reconstructed(Points points, SurfaceKind kind, unsigned threads = 2) {
  Options options;
  options.surface = kind;
  options.threads = threads;
  return reconstruct(clouds::cloud_of(std::move(points)), options);
}

/// Random points of a torus, of the same number per area.
Points on_torus(double major, double minor, std::size_t n, std::uint64_t seed) {
  Points points;
  clouds::Random random(seed);
  while (points.size() < n) {
    const double around = 2 * std::numbers::pi * random.uniform(), across = 2 * std::numbers::pi * random.uniform();
    const double from_axis = major + minor * std::cos(across);
    if (random.uniform() * (major + minor) > from_axis) continue;
    points.push_back({from_axis * std::cos(around), from_axis * std::sin(around), minor * std::sin(across)});
  }
  return points;
}

/// Of the points of the triangles farthest from their corners.
double mean_distance_to_torus(const TriangleMesh& mesh, double major, double minor) {
  double sum = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vec3 p = (1.0 / 3) * (mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c]);
    sum += std::fabs(std::hypot(std::hypot(p.x, p.y) - major, p.z) - minor);
  }
  return sum / static_cast<double>(mesh.triangles.size());
}

/// Random points of the faces of a cube, and of its edges.
Points cube_with_edges(std::size_t of_face, std::size_t of_edge, std::uint64_t seed) {
  Points points;
  clouds::Random random(seed);
  const Vec3 axis[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (int k = 0; k < 3; ++k)
    for (const double side : {0.0, 1.0}) {
      for (std::size_t i = 0; i < of_face; ++i)
        points.push_back(side * axis[k] + random.uniform() * axis[(k + 1) % 3] + random.uniform() * axis[(k + 2) % 3]);
      for (const double other : {0.0, 1.0})
        for (std::size_t i = 0; i < of_edge; ++i)
          points.push_back(random.uniform() * axis[k] + side * axis[(k + 1) % 3] + other * axis[(k + 2) % 3]);
    }
  return points;
}

/// Area of triangles in none of the planes of a cube.
double area_across_edges(const TriangleMesh& mesh) {
  double sum = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vec3 area = cross(mesh.vertices[b] - mesh.vertices[a], mesh.vertices[c] - mesh.vertices[a]);
    const double most = std::max({std::fabs(area.x), std::fabs(area.y), std::fabs(area.z)});
    if (most < 0.999 * norm(area)) sum += norm(area) / 2;
  }
  return sum;
}

TEST(EdgeFlips, ARidgeGetsItsEdge) {
  Surface surface = cut_ridge();
  const EdgeFlipCounts counts = flip_edges(anything(surface), {}, surface, Threads(1));
  EXPECT_EQ(counts.triangles, 2);
  EXPECT_EQ(counts.crossings, 0);
  EXPECT_EQ(surface.support, (std::vector<float>{0.5f, 0.5f, 1, 1, 1, 1}));
  EXPECT_TRUE(std::ranges::any_of(surface.mesh.triangles, [](const auto& t) {
    return std::ranges::count(t, 0u) + std::ranges::count(t, 1u) == 2;
  })) << "a triangle at the ridge";
  const MeshSummary summary = validate(surface.mesh);
  EXPECT_TRUE(summary.closed() && summary.manifold() && summary.oriented());
  EXPECT_GT(summary.volume, 0);
}

TEST(EdgeFlips, NotThroughWhatIsInTheWay) {
  Surface surface = cut_ridge();
  // A spike that ends below the ridge, above what cuts it off.
  TriangleMesh& mesh = surface.mesh;
  const auto tip = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const Vec3& p : {Vec3{0, 0.1, 0.75}, Vec3{0.05, 0.1, 1.5}, Vec3{-0.05, 0.15, 1.5}, Vec3{-0.05, 0.05, 1.5}})
    mesh.vertices.push_back(p);
  for (const auto& t : {std::array<std::uint32_t, 3>{1, 2, 3}, {0, 2, 1}, {0, 3, 2}, {0, 1, 3}})
    mesh.triangles.push_back({tip + t[0], tip + t[1], tip + t[2]});
  surface.support.resize(mesh.triangles.size(), 1);
  const auto before = mesh.triangles;
  const EdgeFlipCounts counts = flip_edges(anything(surface), {}, surface, Threads(1));
  EXPECT_GT(counts.crossings, 0);
  EXPECT_EQ(counts.triangles, 0);
  EXPECT_EQ(mesh.triangles, before);
}

TEST(EdgeFlips, WhatStaysStays) {
  Surface surface = cut_ridge();
  const auto before = surface.mesh.triangles;
  for (const float longest : {0.0f, 1.9f}) { // the new edge has a length of 2
    std::vector<float> limits = anything(surface);
    limits[3] = longest;
    EXPECT_EQ(flip_edges(limits, {}, surface, Threads(1)).triangles, 0);
  }
  surface.unsupported = {1, 0, 0, 0, 0, 0};
  EXPECT_EQ(flip_edges(anything(surface), {}, surface, Threads(1)).triangles, 0);
  EXPECT_EQ(surface.mesh.triangles, before);
}

TEST(EdgeFlips, OnlyToWhatItsSensorsHaveSeen) {
  Surface surface = cut_ridge();
  std::vector<Vec3> view(surface.mesh.vertices.size());
  view[2] = {0, 0, 1};
  view[3] = {0, -0.995, -0.1}; // behind the triangle on its side
  EXPECT_EQ(flip_edges(anything(surface), view, surface, Threads(1)).triangles, 0);
  view[3] = {0, 0.9, 0.43};
  EXPECT_EQ(flip_edges(anything(surface), view, surface, Threads(1)).triangles, 2);
}

TEST(EdgeFlips, NearerToATorusWithTheSameVertices) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Points points = on_torus(2, 0.7, 5000, seed);
    const Result faces = reconstructed(points, SurfaceKind::delaunay),
                 flipped = reconstructed(points, SurfaceKind::samples);
    EXPECT_LT(mean_distance_to_torus(flipped.mesh, 2, 0.7), 0.85 * mean_distance_to_torus(faces.mesh, 2, 0.7));
    EXPECT_EQ(flipped.mesh.vertices, faces.mesh.vertices);
    EXPECT_EQ(flipped.mesh.triangles.size(), faces.mesh.triangles.size());
    const MeshSummary summary = validate(flipped.mesh); // counts crossings itself
    EXPECT_TRUE(summary.closed() && summary.manifold() && summary.oriented());
    EXPECT_EQ(summary.genus, 1);
    EXPECT_EQ(summary.self_intersections, 0);
  }
}

TEST(EdgeFlips, EdgesOfACubeAreNotNotched) {
  const Points points = cube_with_edges(1000, 40, 5);
  const double faces = area_across_edges(reconstructed(points, SurfaceKind::delaunay).mesh),
               flipped = area_across_edges(reconstructed(points, SurfaceKind::samples).mesh);
  EXPECT_LT(flipped, 0.6 * faces);
}

// Where the four vertices lie around a body their normals cancel, and say nothing of which way is up.
TEST(EdgeFlips, SmallBodiesDoNotCollapse) {
  for (std::size_t n = 6; n <= 10; ++n)
    for (std::uint64_t seed = 1; seed <= 15; ++seed) {
      Points points;
      clouds::Random random(seed * 100 + n);
      while (points.size() < n)
        if (const Vec3 p = random.in_box(1); norm(p) > 0.1 && norm(p) < 1) points.push_back((1 / norm(p)) * p);
      const double volume = reconstructed(points, SurfaceKind::delaunay).report.mesh.volume;
      EXPECT_GT(reconstructed(points, SurfaceKind::samples).report.mesh.volume, 0.9 * volume) << n << " " << seed;
    }
}

/// Edges whose triangles lie on one another, to 10 degrees.
std::size_t folded_back(const TriangleMesh& mesh) {
  std::size_t folds = 0;
  const std::vector<Side> sides = sorted_sides(mesh.triangles, mesh.vertices.size(), Threads(1));
  for_each_edge(sides, [&](std::span<const Side> edge) {
    const Vec3 a = area_vector(mesh, edge[0].triangle()), b = area_vector(mesh, edge[1].triangle());
    folds += dot(a, b) < -std::cos(std::numbers::pi / 18) * norm(a) * norm(b);
  });
  return folds;
}

TEST(EdgeFlips, NoTriangleIsFoldedBackOnAnother) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    Points points; // a wedge of 30 degrees with samples on its edges
    clouds::Random random(seed);
    const double slope = std::tan(std::numbers::pi / 6);
    for (int i = 0; i < 1500; ++i) {
      const double x = std::sqrt(random.uniform()), y = random.uniform(0, 2), share = random.uniform();
      points.push_back({x, y, 0});
      points.push_back({x, y, slope * x});
      points.push_back({1, y, slope * share});
      points.push_back({x, i % 2 == 0 ? 0.0 : 2.0, slope * x * share});
      if (i % 15 == 0)
        for (const Vec3& p : {Vec3{0, y, 0}, Vec3{1, y, 0}, Vec3{1, y, slope}}) points.push_back(p);
    }
    EXPECT_LE(folded_back(reconstructed(points, SurfaceKind::samples).mesh),
              folded_back(reconstructed(points, SurfaceKind::delaunay).mesh))
        << seed;
  }
}

TEST(EdgeFlips, TheSameForAnyNumberOfThreadsAndWithoutNoiseForEveryKindOfSurface) {
  const Points points = on_torus(2, 0.7, 5000, 4);
  const TriangleMesh one = reconstructed(points, SurfaceKind::samples, 1).mesh;
  EXPECT_EQ(one.triangles, reconstructed(points, SurfaceKind::samples, 3).mesh.triangles);
  EXPECT_EQ(one.triangles, reconstructed(points, SurfaceKind::automatic, 2).mesh.triangles);
  EXPECT_NE(one.triangles, reconstructed(points, SurfaceKind::delaunay, 2).mesh.triangles);
}

TEST(EdgeFlips, NoneWhereNoiseIsLeft) {
  Points points = on_torus(2, 0.7, 5000, 6);
  points = clouds::jittered(std::move(points), 0.1, 7);
  EXPECT_EQ(reconstructed(points, SurfaceKind::samples).mesh.triangles,
            reconstructed(points, SurfaceKind::delaunay).mesh.triangles);
}

} // namespace
} // namespace eigencrust
