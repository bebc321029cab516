// SPDX-License-Identifier: GPL-3.0-or-later
// A cavity never stays without its shell; smoothing turns nothing over.
#include <eigencrust/eigencrust.h>
#include <eigencrust/validate.h>
#include <gmock/gmock.h>

#include <numbers>

#include "clouds.h"
#include "surface/components.h"
#include "surface/turned_over.h"

namespace eigencrust {
namespace {

using clouds::Prepared;
using Kind = KeepComponents::Kind;

/// Spheres around one another, each region between two of them labelled in turn from the outside in: body, hollow,
/// body.
struct Nested {
  Prepared p = clouds::prepare(
      clouds::joined(clouds::joined(clouds::sphere(60, 10), clouds::sphere(400, 6)), clouds::sphere(200, 2)));
  Labels labels;
  Surface surface;

  Nested() {
    labels = Labels(p.t.tetrahedra.size(), Label::outside);
    for (TetrahedronIndex i{0}; i.value < labels.size(); ++i.value) {
      if (p.t.touches_cube(i)) continue;
      double largest = 0, least = 1e9;
      for (const VertexIndex s : p.t.tetrahedra[i]) {
        const double r = norm(p.t.positions[s] + p.t.origin);
        largest = std::max(largest, r);
        least = std::min(least, r);
      }
      if (largest > 9 || largest < 3) labels[i] = Label::inside; // below the outer sphere, and the inner ball
      if (largest < 7 && largest > 3) labels[i] = Label::outside;
    }
    surface = extract_surface(p.t, labels, Threads(2));
    surface.support.assign(surface.mesh.triangles.size(), 1.0f);
  }
  /// Of a piece by its vertices' distance from the middle.
  void set_support(double near, float support) {
    for (std::size_t i = 0; i < surface.support.size(); ++i)
      if (std::fabs(norm(surface.mesh.vertices[surface.mesh.triangles[i][0]] + p.t.origin) - near) < 1)
        surface.support[i] = support;
  }
  [[nodiscard]] MeshSummary summary() const { return validate(surface.mesh, {.self_intersections = false}); }
};

TEST(Shells, ThePiecesAreAShellACavityAndABallWithin) {
  const Nested nested;
  const MeshSummary mesh = nested.summary();
  ASSERT_EQ(mesh.components, 3u);
  EXPECT_EQ(mesh.component_list[0].vertices, 400u);
  EXPECT_GT(mesh.volume, 0);
}

TEST(Shells, TheLargestPieceBringsItsShell) {
  Nested nested;
  const auto dropped = filter_components(nested.surface, {Kind::largest, 1}, nested.p.t, {}, nested.labels, Threads(2));
  ASSERT_EQ(dropped.size(), 1u);
  EXPECT_EQ(dropped[0].vertices, 200u);
  EXPECT_EQ(nested.summary().components, 2u);
  EXPECT_GT(nested.summary().volume, 0);
}

TEST(Shells, WithoutAShellThatNothingBearsOutItsCavityIsABody) {
  Nested nested;
  nested.set_support(10, 0.0f);
  const auto dropped =
      filter_components(nested.surface, {Kind::supported, 1}, nested.p.t, {}, nested.labels, Threads(2));
  ASSERT_EQ(dropped.size(), 1u);
  EXPECT_EQ(dropped[0].vertices, 60u);
  EXPECT_EQ(nested.summary().components, 2u);
  const double volume = 4 * std::numbers::pi / 3 * (6 * 6 * 6 - 2 * 2 * 2); // the ball is now its cavity
  EXPECT_NEAR(nested.summary().volume, volume, 0.05 * volume);
}

TEST(Shells, ABallInACavityNeedsNoneOfThem) {
  Nested nested;
  // Without the cavity's wall, which is the largest: the two smaller ones.
  std::vector<std::uint8_t> gone;
  for (const auto& triangle : nested.surface.mesh.triangles)
    gone.push_back(norm(nested.surface.mesh.vertices[triangle[0]] + nested.p.t.origin) < 9 &&
                   norm(nested.surface.mesh.vertices[triangle[0]] + nested.p.t.origin) > 3);
  drop_triangles(gone, nested.surface);
  const auto dropped = filter_components(nested.surface, {Kind::largest, 1}, nested.p.t, {}, nested.labels, Threads(2));
  EXPECT_EQ(dropped.size(), 1u);
  EXPECT_EQ(nested.summary().components, 1u);
  EXPECT_GT(nested.summary().volume, 0);
}

/// The same in a solid that goes on for ever: a room, a hollow body in it, and its cavity.
struct NestedRoom : Nested {
  NestedRoom() {
    for (TetrahedronIndex i{0}; i.value < labels.size(); ++i.value)
      labels[i] = labels[i] == Label::inside ? Label::outside : Label::inside;
    surface = extract_surface(p.t, labels, Threads(2));
    surface.support.assign(surface.mesh.triangles.size(), 1.0f);
  }
};

TEST(Shells, ARoomNeedsNone) {
  NestedRoom room;
  std::vector<std::uint8_t> gone;
  for (const auto& triangle : room.surface.mesh.triangles)
    gone.push_back(norm(room.surface.mesh.vertices[triangle[0]] + room.p.t.origin) < 9);
  drop_triangles(gone, room.surface);
  for (const Kind kind : {Kind::supported, Kind::largest, Kind::all})
    EXPECT_TRUE(filter_components(room.surface, {kind, 1}, room.p.t, {}, room.labels, Threads(2)).empty());
  EXPECT_EQ(room.summary().components, 1u);
  EXPECT_LT(room.summary().volume, 0);
}

TEST(Shells, ABodyInARoomBringsTheRoom) {
  NestedRoom room;
  const auto dropped = filter_components(room.surface, {Kind::largest, 1}, room.p.t, {}, room.labels, Threads(2));
  ASSERT_EQ(dropped.size(), 1u);
  EXPECT_EQ(dropped[0].vertices, 200u);
  EXPECT_EQ(room.summary().components, 2u);
  EXPECT_LT(room.summary().volume, 0);
}

TEST(Shells, InARoomNothingIsTurned) {
  NestedRoom room;
  const double volume = room.summary().volume;
  ASSERT_LT(volume, 0);
  room.set_support(10, 0.0f); // lines of sight cross the room all the same
  EXPECT_TRUE(filter_components(room.surface, {Kind::supported, 1}, room.p.t, {}, room.labels, Threads(2)).empty());
  EXPECT_EQ(room.summary().components, 3u);
  EXPECT_EQ(room.summary().volume, volume);
}

TriangleMesh octahedron(const Vec3& middle, double size) {
  TriangleMesh mesh;
  for (const Vec3& v : {Vec3{1, 0, 0}, Vec3{-1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, -1, 0}, Vec3{0, 0, 1}, Vec3{0, 0, -1}})
    mesh.vertices.push_back(middle + size * v);
  mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  return mesh;
}

TEST(TurnedOver, OnlyWhatTurnedGoesBack) {
  TriangleMesh mesh = octahedron({0, 0, 0}, 1);
  const TriangleMesh other = octahedron({5, 0, 0}, 1);
  for (const auto& [a, b, c] : other.triangles) mesh.triangles.push_back({a + 6, b + 6, c + 6});
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  const std::vector<Vec3> before = mesh.vertices;
  const Threads threads(1);
  for (std::size_t v = 0; v < 6; ++v) mesh.vertices[v] = -0.5 * mesh.vertices[v]; // inside out
  for (std::size_t v = 6; v < 12; ++v) mesh.vertices[v] = 0.9 * mesh.vertices[v];
  EXPECT_EQ(take_back_turned(before, SurfaceFans(mesh), mesh, threads).pieces, 1u);
  EXPECT_EQ(mesh.vertices[0], before[0]);
  EXPECT_NE(mesh.vertices[7], before[7]);
}

TEST(TurnedOver, WhatIsFlatGoesBackToo) {
  TriangleMesh mesh = octahedron({3, 4, 5}, 1);
  const std::vector<Vec3> before = mesh.vertices;
  for (Vec3& v : mesh.vertices) v.z = 5 + 1e-17 * v.z;
  EXPECT_EQ(take_back_turned(before, SurfaceFans(mesh), mesh, Threads(1)).pieces, 1u);
  EXPECT_EQ(mesh.vertices, before);
}

TEST(TurnedOver, ACoarseShellThatShrinksBelowItsCavityGoesBack) {
  TriangleMesh mesh = octahedron({0, 0, 0}, 1);
  const TriangleMesh cavity = octahedron({0.01, 0, 0}, 0.9);
  for (const auto& [a, b, c] : cavity.triangles) mesh.triangles.push_back({b + 6, a + 6, c + 6});
  mesh.vertices.insert(mesh.vertices.end(), cavity.vertices.begin(), cavity.vertices.end());
  const std::vector<Vec3> before = mesh.vertices;
  for (std::size_t v = 0; v < 6; ++v) mesh.vertices[v] = 0.5 * mesh.vertices[v];
  EXPECT_EQ(take_back_turned(before, SurfaceFans(mesh), mesh, Threads(1)).pieces, 2u);
  EXPECT_EQ(mesh.vertices, before);
}

TEST(TurnedOver, TheWallOfACavityMayShrink) {
  TriangleMesh mesh = octahedron({0, 0, 0}, 1);
  for (auto& t : mesh.triangles) std::swap(t[0], t[1]);
  const std::vector<Vec3> before = mesh.vertices;
  for (Vec3& v : mesh.vertices) v = 1e-6 * v;
  EXPECT_EQ(take_back_turned(before, SurfaceFans(mesh), mesh, Threads(1)).pieces, 0u);
  EXPECT_NE(mesh.vertices, before);
}

} // namespace
} // namespace eigencrust
