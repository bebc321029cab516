// SPDX-License-Identifier: GPL-3.0-or-later
#include <eigencrust/validate.h>
#include <gmock/gmock.h>

#include "clouds.h"
#include "surface/components.h"

namespace eigencrust {
namespace {

using clouds::Points;
using clouds::Prepared;
using Kind = KeepComponents::Kind;

/// Three clusters far apart, 300, 80 and 5 points; each cluster's own tetrahedra inside: three pieces.
struct ThreePieces {
  Prepared p;
  Labels labels;
  Surface surface;

  ThreePieces()
      : p(clouds::prepare(clouds::joined(
            clouds::joined(clouds::moved(clouds::sphere(300), {100, 0, 0}), clouds::moved(clouds::sphere(80), {})),
            {{-99, 0, 0}, {-101, 0, 0}, {-100, 1, 0}, {-100, 0, 1}, {-100, -1, -1}}))) {
    labels = Labels(p.t.tetrahedra.size(), Label::outside);
    for (std::uint32_t i = 0; i < labels.size(); ++i) {
      double longest = 0;
      for (const SampleIndex a : p.t.tetrahedra.raw()[i])
        for (const SampleIndex b : p.t.tetrahedra.raw()[i])
          longest = std::max(longest, distance(p.t.positions[a], p.t.positions[b]));
      if (longest < 10) labels.raw()[i] = Label::inside;
    }
    surface = extract_surface(p.t, labels, Threads(2));
    surface.support.assign(surface.mesh.triangles.size(), 1.0f);
  }
  std::vector<DroppedComponent> filter(const KeepComponents& keep) {
    return filter_components(surface, keep, p.t, {}, labels, Threads(2));
  }
  [[nodiscard]] MeshSummary summary() const {
    return validate(surface.mesh, {.self_intersections = false, .merge_equal_vertices = false});
  }
};

TEST(Components, AllKeepsAll) {
  ThreePieces pieces;
  const TriangleMesh before = pieces.surface.mesh;
  EXPECT_EQ(pieces.summary().components, 3u);
  EXPECT_TRUE(pieces.filter({Kind::all, 1}).empty());
  EXPECT_EQ(pieces.surface.mesh.triangles, before.triangles);
  EXPECT_EQ(pieces.surface.mesh.vertices, before.vertices);
}

TEST(Components, LargestKeepsOneAndListsTheOthers) {
  ThreePieces pieces;
  const MeshSummary before = pieces.summary();
  const std::vector<DroppedComponent> dropped = pieces.filter({Kind::largest, 1});
  ASSERT_EQ(dropped.size(), 2u);
  EXPECT_EQ(dropped[0].vertices, 80u); // largest of them first
  EXPECT_EQ(dropped[1].vertices, 5u);
  EXPECT_NEAR(distance(dropped[0].centre, {0, 0, 0}), 0, 0.1); // in input coordinates
  EXPECT_NEAR(distance(dropped[1].centre, {-100, 0, 0}), 0, 0.1);
  const MeshSummary after = pieces.summary();
  EXPECT_EQ(after.components, 1u);
  EXPECT_EQ(after.vertices, 300u);
  EXPECT_EQ(after.triangles + dropped[0].triangles + dropped[1].triangles, before.triangles);
  EXPECT_EQ(after.unreferenced_vertices, 0u);
  EXPECT_TRUE(after.closed() && after.manifold() && after.oriented());
  ASSERT_EQ(pieces.surface.sample_of.size(), 300u);
  for (std::size_t v = 0; v < 300; ++v)
    EXPECT_EQ(pieces.surface.mesh.vertices[v], pieces.p.t.positions[pieces.surface.sample_of[v]]);
}

TEST(Components, CountKeepsThatMany) {
  for (const std::uint32_t count : {1u, 2u, 3u, 99u}) {
    ThreePieces pieces;
    const std::size_t dropped = pieces.filter({Kind::count, count}).size();
    EXPECT_EQ(dropped, 3 - std::min(count, 3u));
    EXPECT_EQ(pieces.summary().components, std::min(count, 3u));
  }
}

TEST(Components, SupportedDropsSpecks) {
  ThreePieces pieces;
  const std::vector<DroppedComponent> dropped = pieces.filter({Kind::supported, 1});
  ASSERT_EQ(dropped.size(), 1u);
  EXPECT_EQ(dropped[0].vertices, 5u);
  EXPECT_EQ(pieces.summary().components, 2u);
}

TEST(Components, SupportedKeepsTheLargestHoweverSmall) {
  const Prepared p = clouds::prepare({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}});
  Labels labels(p.t.tetrahedra.size(), Label::inside);
  for (std::uint32_t i = 0; i < labels.size(); ++i)
    if (p.t.touches_cube(TetrahedronIndex{i})) labels.raw()[i] = Label::outside;
  Surface surface = extract_surface(p.t, labels, Threads(2));
  surface.support.assign(surface.mesh.triangles.size(), 0.0f);
  EXPECT_TRUE(filter_components(surface, {Kind::supported, 1}, p.t, {}, labels, Threads(2)).empty());
  EXPECT_EQ(surface.mesh.vertices.size(), 5u);
}

TEST(Components, OfNothingIsNothing) {
  const Prepared p = clouds::prepare(clouds::random_box(20, 1));
  for (const Kind kind : {Kind::supported, Kind::all, Kind::largest, Kind::count}) {
    Surface surface;
    EXPECT_TRUE(
        filter_components(surface, {kind, 1}, p.t, {}, Labels(p.t.tetrahedra.size(), Label::outside), Threads(2))
            .empty());
  }
}

} // namespace
} // namespace eigencrust
