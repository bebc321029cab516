// SPDX-License-Identifier: GPL-3.0-or-later
// What no sample bears out, how it is cut away, and one-sided scans.
#include <eigencrust/validate.h>
#include <gmock/gmock.h>

#include "clouds.h"
#include "evidence/contradictions.h"
#include "parallel/threads.h"
#include "shapes.h"
#include "surface/trim.h"

namespace eigencrust {
namespace {

using clouds::Points;
using clouds::Prepared;

/// The hull of the points as a surface with full support.
struct Hull {
  Threads threads{2};
  Prepared p;
  SampleModel model;
  Labels labels;
  Surface surface;

  explicit Hull(const Points& points) : p(clouds::prepare(points)) {
    labels = Labels(p.t.tetrahedra.size(), Label::outside);
    for (TetrahedronIndex i{0}; i.value < labels.size(); ++i.value)
      if (!p.t.touches_cube(i)) labels[i] = Label::inside;
    model = sample_model(std::span(p.t.positions.raw()).first(p.t.sample_count), std::nullopt, threads);
    surface = extract_surface(p.t, labels, Threads(2));
    surface.support.assign(surface.mesh.triangles.size(), 1);
  }
  /// A line from each sample to the same place, relative to the origin.
  [[nodiscard]] std::vector<SightLine> lines_to(const Vec3& place) const {
    std::vector<SightLine> lines;
    for (std::uint32_t s = 0; s < p.t.sample_count; ++s) lines.push_back({SampleIndex{s}, 0, place});
    return lines;
  }
  std::vector<std::uint8_t> unsupported(std::span<const SightLine> lines, bool one_sided) {
    return unsupported_triangles(p.t, model, lines, one_sided, {}, surface, threads);
  }
  [[nodiscard]] Vec3 normal(std::size_t i) const {
    const auto& [a, b, c] = surface.mesh.triangles[i];
    const Vec3& o = surface.mesh.vertices[a];
    const Vec3 n = cross(surface.mesh.vertices[b] - o, surface.mesh.vertices[c] - o);
    return (1 / norm(n)) * n;
  }
};

TEST(Unsupported, NothingOnEvenSamples) {
  Hull hull(clouds::sphere(1000));
  EXPECT_THAT(hull.unsupported({}, false), testing::Each(0));
  EXPECT_EQ(share_of_area(hull.surface, hull.unsupported({}, false)), 0);
}

TEST(Unsupported, LittleSupportAndLongEdges) {
  // A ball whose lower half has no samples but at the pole: the triangles to the pole are long.
  Points points;
  for (const Vec3& p : clouds::sphere(4000))
    if (p.z > 0) points.push_back(p);
  const std::size_t upper = points.size();
  points.push_back({0, 0, -1});
  Hull hull(points);
  const auto marked = hull.unsupported({}, false);
  for (std::size_t i = 0; i < marked.size(); ++i) {
    bool at_pole = false;
    for (const std::uint32_t v : hull.surface.mesh.triangles[i])
      at_pole = at_pole || hull.p.t.source[hull.surface.sample_of[v]] == upper;
    EXPECT_EQ(marked[i], at_pole) << i;
  }
  EXPECT_NEAR(share_of_area(hull.surface, marked), std::sqrt(2.0) / (std::sqrt(2.0) + 2), 0.01); // a cone of two
  hull.surface.support[0] = 0.24f;
  hull.surface.support[1] = 0.26f;
  const auto again = hull.unsupported({}, false);
  EXPECT_EQ(again[0], 1);
  EXPECT_EQ(again[1], marked[1]);
}

TEST(Unsupported, WhatTheScannerCannotHaveSeen) {
  Hull hull(clouds::sphere(3000));
  const auto lines = hull.lines_to({0, 0, 1e6});
  const auto marked = hull.unsupported(lines, true);
  for (std::size_t i = 0; i < marked.size(); ++i) {
    const double degrees = std::acos(hull.normal(i).z) * 180 / 3.141592653589793;
    if (std::fabs(degrees - 85) > 0.01) {
      EXPECT_EQ(marked[i], degrees > 85) << i;
    }
  }
}

TEST(Unsupported, OneVertexThatWasSeenIsEnoughUnlessTheScanIsOneSided) {
  Hull hull(clouds::sphere(300));
  // Half of the samples were seen from above, the others from below.
  std::vector<SightLine> lines;
  for (std::uint32_t s = 0; s < hull.p.t.sample_count; ++s)
    lines.push_back({SampleIndex{s}, 0, {0, 0, s % 2 == 0 ? 1e6 : -1e6}});
  const auto some = hull.unsupported(lines, false), all = hull.unsupported(lines, true);
  std::size_t only_strict = 0;
  for (std::size_t i = 0; i < some.size(); ++i) {
    int seen = 0;
    for (const std::uint32_t v : hull.surface.mesh.triangles[i])
      seen += (hull.surface.sample_of[v].value % 2 == 0 ? 1 : -1) * hull.normal(i).z > 0.0872; // cos 85°
    EXPECT_EQ(some[i], seen == 0) << i;
    EXPECT_EQ(all[i], seen < 3) << i;
    only_strict += all[i] && !some[i];
  }
  EXPECT_GT(only_strict, 50u);
  EXPECT_THAT(hull.unsupported({}, true), testing::Each(0)); // no line, no doubt
}

Surface surface_of(const TriangleMesh& mesh) {
  Surface surface;
  surface.mesh = mesh;
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) surface.sample_of.push_back(SampleIndex{v});
  surface.inside.resize(mesh.triangles.size());
  surface.support.assign(mesh.triangles.size(), 1);
  return surface;
}

/// Of a ball of 4000 samples without those above a height.
BridgedReport bridges_of_ball(double height, const Vec3& origin) {
  Points points = clouds::sphere(4000);
  std::erase_if(points, [&](const Vec3& p) { return p.z > height || p.z < -height; });
  Hull hull(points);
  return bridged_places(hull.surface, hull.unsupported({}, false), hull.model, origin + hull.p.t.origin, Threads(2));
}

TEST(Bridged, CapsOfABallThatWereNotSeen) {
  EXPECT_EQ(bridges_of_ball(2, {}).places, 0);
  const Vec3 origin{4e6, -2e5, 300};
  const BridgedReport bridged = bridges_of_ball(0.8, origin);
  EXPECT_EQ(bridged.places, 2);
  EXPECT_NEAR(bridged.widest, 2 * 0.6, 0.1);
  EXPECT_NEAR(bridged.at.x - origin.x, 0, 0.1);
  EXPECT_NEAR(bridged.at.y - origin.y, 0, 0.1);
  EXPECT_NEAR(std::fabs(bridged.at.z - origin.z), 0.8, 0.05);
  EXPECT_EQ(bridges_of_ball(0.999, {}).places, 0) << "a few samples are missing anywhere";
}

TEST(Trim, LeavesAManifoldWithBoundary) {
  // At random a third of a ball goes: many fans then meet in a vertex.
  Surface surface = surface_of(shapes::icosphere(3));
  clouds::Random random(7);
  std::vector<std::uint8_t> gone(surface.mesh.triangles.size(), 0);
  for (auto& g : gone) g = random.below(3) == 0;
  std::vector<std::array<Vec3, 3>> kept;
  for (std::size_t i = 0; i < gone.size(); ++i)
    if (!gone[i]) {
      const auto& [a, b, c] = surface.mesh.triangles[i];
      kept.push_back({surface.mesh.vertices[a], surface.mesh.vertices[b], surface.mesh.vertices[c]});
    }
  TriangleMesh merely_dropped = surface.mesh;
  merely_dropped.triangles.clear();
  for (std::size_t i = 0; i < gone.size(); ++i)
    if (!gone[i]) merely_dropped.triangles.push_back(surface.mesh.triangles[i]);
  ASSERT_FALSE(validate(merely_dropped).manifold()); // there is something to do
  trim(gone, surface);
  const MeshSummary m = validate(surface.mesh);
  EXPECT_TRUE(m.manifold() && m.oriented());
  EXPECT_GT(m.boundary_loops, 0u);
  EXPECT_EQ(m.unreferenced_vertices, 0u);
  EXPECT_GT(m.triangles, kept.size() / 2);
  EXPECT_EQ(surface.support.size(), m.triangles);
  EXPECT_EQ(surface.inside.size(), m.triangles);
  EXPECT_EQ(surface.sample_of.size(), surface.mesh.vertices.size());
  for (const auto& [a, b, c] : surface.mesh.triangles) // nothing new, nothing turned
    EXPECT_THAT(kept, testing::Contains(std::array<Vec3, 3>{surface.mesh.vertices[a], surface.mesh.vertices[b],
                                                            surface.mesh.vertices[c]}));
}

TEST(Trim, KeepsTheLargestFan) {
  // Of the six triangles around a vertex two go: fans of one and of three are left.
  TriangleMesh fan;
  fan.vertices.push_back({0, 0, 0});
  for (int i = 0; i < 6; ++i) fan.vertices.push_back({std::cos(i * 1.0472), std::sin(i * 1.0472), 0});
  for (std::uint32_t i = 0; i < 6; ++i) fan.triangles.push_back({0, i + 1, (i + 1) % 6 + 1});
  Surface surface = surface_of(fan);
  trim({1, 0, 1, 0, 0, 0}, surface);
  EXPECT_THAT(surface.support, testing::SizeIs(3)); // triangle 1 went, 3 to 5 stay
  EXPECT_EQ(surface.mesh.vertices.size(), 5u);
  Surface whole = surface_of(fan);
  trim(std::vector<std::uint8_t>(6, 0), whole);
  EXPECT_EQ(whole.mesh.triangles, fan.triangles);
  Surface none = surface_of(fan);
  trim(std::vector<std::uint8_t>(6, 1), none);
  EXPECT_TRUE(none.mesh.triangles.empty() && none.mesh.vertices.empty());
}

TEST(Trim, OnlyRimsOfThreeEdgesAreClosed) {
  Hull hull(clouds::sphere(200));
  const TriangleMesh whole = hull.surface.mesh;
  std::vector<std::uint8_t> gone(whole.triangles.size(), 0);
  gone[7] = 1;
  const auto beside = [&](std::size_t i) { // two triangles side by side make a rim of four edges
    std::size_t common = 0;
    for (const std::uint32_t v : whole.triangles[i])
      common += static_cast<std::size_t>(std::count(whole.triangles[100].begin(), whole.triangles[100].end(), v));
    return common == 2;
  };
  std::size_t next = 101;
  while (!beside(next)) ++next;
  gone[100] = gone[next] = 1;
  const TetrahedronIndex behind = hull.surface.inside[7];
  trim(gone, hull.surface);
  close_smallest_rims(hull.p.t, hull.p.stars, hull.surface);
  const MeshSummary m = validate(hull.surface.mesh);
  EXPECT_EQ(m.triangles, whole.triangles.size() - 2);
  EXPECT_EQ(m.boundary_loops, 1u);
  EXPECT_EQ(m.boundary_edges, 4u);
  EXPECT_TRUE(m.manifold() && m.oriented());
  EXPECT_EQ(hull.surface.inside.back(), behind);
  EXPECT_EQ(hull.surface.support.size(), m.triangles);
}

TEST(Trim, TheRimThatAPieceEndsAtStays) {
  Hull hull(clouds::sphere(200));
  std::vector<std::uint8_t> gone(hull.surface.mesh.triangles.size(), 1);
  gone[7] = 0;
  trim(gone, hull.surface);
  close_smallest_rims(hull.p.t, hull.p.stars, hull.surface);
  EXPECT_EQ(hull.surface.mesh.triangles.size(), 1u);
}

TEST(Trim, ARimAroundAFaceThatDividesNothingIsClosedToo) {
  Hull hull(clouds::sphere(200));
  const auto triangles = hull.surface.mesh.triangles;
  std::vector<std::uint8_t> gone(triangles.size(), 0);
  for (std::size_t i = 0; i < gone.size(); ++i) // a longer rim, which the piece ends at
    gone[i] = std::count(triangles[i].begin(), triangles[i].end(), triangles[100][0]) > 0;
  ASSERT_FALSE(gone[7]);
  gone[7] = 1;
  hull.labels[hull.surface.inside[7]] = Label::outside;
  const auto rest = static_cast<std::size_t>(std::count(gone.begin(), gone.end(), 0));
  trim(gone, hull.surface);
  close_smallest_rims(hull.p.t, hull.p.stars, hull.surface);
  EXPECT_EQ(hull.surface.mesh.triangles.size(), rest + 1);
  EXPECT_EQ(hull.surface.support.back(), 0);
  EXPECT_EQ(validate(hull.surface.mesh).boundary_loops, 1u);
}

TEST(Trim, RimsThatEndAtAnEdgeOfThreeTrianglesAreLeft) {
  Hull hull(clouds::sphere(200));
  auto& triangles = hull.surface.mesh.triangles;
  const std::size_t whole = triangles.size();
  const std::uint32_t far = triangles[100][0];
  for (const std::size_t i : {7, 11}) { // fins that stand across the inside
    const auto [a, b, c] = triangles[i];
    triangles.push_back({a, b, far});
    hull.surface.inside.push_back(hull.surface.inside[i]);
    hull.surface.support.push_back(1);
  }
  ASSERT_EQ(validate(hull.surface.mesh).nonmanifold_edges, 2u);
  close_smallest_rims(hull.p.t, hull.p.stars, hull.surface);
  EXPECT_EQ(triangles.size(), whole + 2);
}

TEST(OneSidedScan, AllLinesWithinSixtyDegreesOfTheirMean) {
  const Prepared p = clouds::prepare(clouds::random_box(40, 9));
  const auto lines_at = [&](double degrees) { // two directions, in turn
    std::vector<SightLine> lines;
    const double a = degrees * 3.141592653589793 / 180;
    for (std::uint32_t s = 0; s < p.t.sample_count; ++s)
      lines.push_back({SampleIndex{s}, 0,
                       p.t.positions[SampleIndex{s}] + 5.0 * Vec3{s % 2 ? std::sin(a) : -std::sin(a), 0, std::cos(a)}});
    return lines;
  };
  const auto narrow = one_sided_scan(p.t, lines_at(59));
  ASSERT_TRUE(narrow.has_value());
  EXPECT_LT(distance(narrow->direction, {0, 0, 1}), 1e-9);
  EXPECT_NEAR(narrow->widest_angle * 180 / 3.141592653589793, 59, 1e-6);
  EXPECT_FALSE(one_sided_scan(p.t, lines_at(61)).has_value());
  EXPECT_FALSE(one_sided_scan(p.t, {}).has_value());
}

} // namespace
} // namespace eigencrust
