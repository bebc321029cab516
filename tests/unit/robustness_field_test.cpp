// SPDX-License-Identifier: GPL-3.0-or-later
// Parts, thin walls and what else people bring: the generators of the group `field`, and its measures.
#include <eigencrust/eigencrust.h>
#include <eigencrust/io.h>
#include <eigencrust/metrics.h>
#include <eigencrust/validate.h>
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>
#include <set>

#include "cases.h"
#include "clouds.h"
#include "field_scenes.h"
#include "measures.h"
#include "open_scenes.h"
#include "parts.h"
#include "runner.h"
#include "sampling.h"
#include "shapes.h"
#include "support.h"
#include "table.h"

namespace eigencrust::bench {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr double pi = std::numbers::pi;

Part box_part(const Vec3& size, double spacing) {
  const std::array<Block, 1> box{Block{{0, 0, 0}, size}};
  return block_part(box, spacing);
}

double edge_length(const Part& part) {
  double length = 0;
  for (const auto& [a, b] : part.sharp_edges) length += distance(part.samples[a], part.samples[b]);
  return length;
}

struct PartRow {
  const char* name;
  Part part;
  double volume, area, edges, spacing;
  std::int64_t genus = 0;
  double off = 1e-9; ///< farthest sample from the truth
};

std::vector<PartRow> all_parts() {
  const std::array<Block, 2> bracket{Block{{0, 0, 0}, {20, 20, 10}}, Block{{8, 8, 0}, {20, 20, 10}, false}};
  const std::array<Block, 2> window{Block{{0, 0, 0}, {20, 8, 20}}, Block{{6, 0, 6}, {14, 8, 14}, false}};
  const double inner = 18.4; // of the cup
  const auto knot = [](double t) {
    return 3.0 * Vec3{std::sin(t) + 2 * std::sin(2 * t), std::cos(t) - 2 * std::cos(2 * t), -std::sin(3 * t)};
  };
  std::vector<PartRow> rows;
  rows.push_back({"box", box_part({20, 16, 12}, 1), 3840, 1504, 4 * 48, 1});
  rows.push_back({"bracket", block_part(bracket, 1), 2560, 1312, 2 * 80 + 6 * 10, 1});
  rows.push_back(
      {"window", block_part(window, 1), (400 - 64) * 8, 2 * 336 + 80 * 8 + 32 * 8, 4 * 48 + 2 * 32 + 4 * 8, 1, 1});
  rows.push_back({"bin", open_bin({50, 40, 40}, 2, 1.5), 17072, 17432, 4 * 130 + 2 * 164 + 4 * 38, 1.5});
  rows.push_back({"cup", cup(20, 40, 1.6, 0.875), pi * (16'000 - inner * inner * 38.4),
                  pi * (1600 + 800 + 2 * inner * 38.4), 2 * pi * (40 + 2 * inner), 0.875, 0, 1e-3});
  rows.push_back({"bend", pipe_bend(30, 8, 6, 1.1), pi * 28 * 15 * pi, 2 * pi * 14 * 15 * pi + 2 * pi * 28, 4 * pi * 14,
                  1.1, 1, 2e-3});
  rows.push_back({"plate", holed_plate({60, 40, 2}, 8, 1.4, true), (2400 - pi * 64) * 2,
                  2 * (2400 - pi * 64) + 400 + 32 * pi, 2 * 200 + 4 * 2 + 4 * pi * 8, 1.4, 1, 1e-3});
  rows.push_back({"sheets", holed_plate({100, 80, 0.8}, 15, 1, false), (8000 - pi * 225) * 0.8,
                  2 * (8000 - pi * 225) + 288 + 24 * pi, 0, 0.8, 1});
  rows.push_back({"knot", closed_tube(knot, 1.2, 0.15), 0, 0, 0, 0.15, 1, 2e-3});
  return rows;
}

TEST(FieldParts, AreClosedAndAsLargeAsTheFormula) {
  for (const PartRow& row : all_parts()) {
    SCOPED_TRACE(row.name);
    const Truth& truth = row.part.truth;
    const MeshSummary mesh = validate(*truth.mesh);
    EXPECT_TRUE(mesh.closed() && mesh.manifold() && mesh.oriented());
    EXPECT_EQ(mesh.self_intersections, 0u);
    EXPECT_EQ(mesh.components, 1u);
    EXPECT_EQ(mesh.genus, row.genus);
    EXPECT_EQ(truth.genus, row.genus);
    EXPECT_NEAR(mesh.volume / truth.volume, 1, 1e-3);
    EXPECT_NEAR(mesh.area / truth.area, 1, 1e-3);
    if (row.volume == 0) continue; // the knot's length has no formula
    EXPECT_NEAR(truth.volume / row.volume, 1, 1e-9);
    EXPECT_NEAR(truth.area / row.area, 1, 1e-9);
  }
}

TEST(FieldParts, SamplesAreDistinctAndOnTheSurface) {
  for (const PartRow& row : all_parts()) {
    SCOPED_TRACE(row.name);
    const std::set<Vec3> distinct(row.part.samples.begin(), row.part.samples.end());
    EXPECT_EQ(distinct.size(), row.part.samples.size());
    EXPECT_LT(summarize(distances_to_surface(row.part.samples, *row.part.truth.mesh, 1)).max, row.off);
    EXPECT_NEAR(median_spacing(row.part.samples, 1) / row.spacing, 1, 0.25);
    // No hole: every part of the surface has a sample near.
    if (row.spacing == 0.8) continue; // sheets without rims
    const std::vector<Vec3> probes = sample_surface(*row.part.truth.mesh, 2000, 1);
    EXPECT_LT(summarize(distances_to_points(probes, row.part.samples, 1)).max, 1.3 * row.spacing);
  }
}

TEST(FieldParts, SharpEdgesAreAllThere) {
  for (const PartRow& row : all_parts()) {
    SCOPED_TRACE(row.name);
    if (row.edges == 0)
      EXPECT_TRUE(row.part.sharp_edges.empty());
    else
      EXPECT_NEAR(edge_length(row.part) / row.edges, 1, 4e-3); // chords of circles are shorter
  }
}

TEST(FieldParts, TurnedPartKeepsItsShape) {
  const Part plain = box_part({3, 2, 1}, 1), turned = rotated(plain, 5), other = rotated(plain, 6);
  EXPECT_NEAR(validate(*turned.truth.mesh).volume, 6, 1e-12);
  for (std::size_t i = 1; i < plain.samples.size(); ++i)
    EXPECT_NEAR(distance(turned.samples[0], turned.samples[i]), distance(plain.samples[0], plain.samples[i]), 1e-12);
  EXPECT_GT(distance(turned.samples.back(), other.samples.back()), 0.01);
}

TEST(FieldParts, RoundProfilesHaveNoSharpEdges) {
  std::vector<ProfilePoint> profile; // a ball
  for (int i = 0; i <= 30; ++i) profile.push_back({i % 30 == 0 ? 0 : std::sin(pi * i / 30), -std::cos(pi * i / 30)});
  const Part ball = turned_part(profile, 0.1);
  EXPECT_TRUE(ball.sharp_edges.empty());
  EXPECT_NEAR(ball.truth.volume, 4 * pi / 3, 0.03);
}

TEST(FieldParts, BesideKeepsBoth) {
  const Part both = beside(box_part({1, 1, 1}, 1), moved(box_part({2, 2, 2}, 1), {5, 0, 0}));
  EXPECT_EQ(both.truth.components, 2u);
  EXPECT_NEAR(both.truth.volume, 9, 1e-12);
  EXPECT_NEAR(both.truth.area, 30, 1e-12);
  EXPECT_NEAR(edge_length(both), 12 + 24, 1e-12);
}

TEST(FieldScenes, OrganHasTheAreaOfItsContours) {
  // Two round vessels that overlap at their upper ends.
  const Organ organ({{{-2, 0, 0}, {-0.5, 0, 2}, 1, 1}, {{2, 0, 0}, {0.5, 0, 2}, 1, 0.7}});
  EXPECT_NEAR(organ.section_area(0), 2 * pi, 1e-12);
  clouds::Random random(3);
  std::size_t hits = 0;
  constexpr std::size_t count = 200'000;
  for (std::size_t i = 0; i < count; ++i) hits += organ.inside({random.uniform(-2, 2), random.uniform(-2, 2), 1.9});
  EXPECT_NEAR(16.0 * static_cast<double>(hits) / count, organ.section_area(1.9), 0.05);
  const Scene scene = organ.contours(9, 0.1, 1);
  EXPECT_EQ(std::set<double>([&] {
              std::set<double> heights;
              for (const Vec3& p : scene.cloud.points) heights.insert(p.z);
              return heights;
            }())
                .size(),
            9u);
  for (const Vec3& p : scene.cloud.points) {
    EXPECT_FALSE(organ.inside({1.001 * p.x, 1.001 * p.y, p.z}) && organ.inside({0.999 * p.x, 0.999 * p.y, p.z}))
        << p.x << " " << p.y << " " << p.z; // on an outline, not within
  }
}

TEST(FieldScenes, RoomIsSeenFromWithin) {
  const std::vector<Vec3> scanners{{2.6, 2.2, 1.5}, {0.6, 3.2, 1.5}};
  const Scene empty = room(std::span(scanners).first(1), false, 0, 1, 1), furnished = room(scanners, true, 0, 1, 1);
  EXPECT_NEAR(empty.truth.volume, 54, 1e-9);
  EXPECT_EQ(empty.truth.genus, 0);
  EXPECT_EQ(empty.cloud.points.size(), 6 * 60 * 60u); // every ray meets something
  EXPECT_NEAR(furnished.truth.volume, 54 - 0.09 * 2.7 - 0.96 * 0.06 - 0.04 * 0.72, 1e-9);
  EXPECT_EQ(furnished.truth.genus, 1);
  EXPECT_EQ(furnished.truth.components, 1u);
  ASSERT_EQ(furnished.cloud.sensor_of.size(), furnished.cloud.points.size());
  EXPECT_EQ(furnished.cloud.sensors.size(), 2u);
  EXPECT_EQ(std::set<std::uint32_t>(furnished.cloud.sensor_of.begin(), furnished.cloud.sensor_of.end()).size(), 2u);
}

TEST(FieldScenes, OnlyTheOneBallIsNoisy) {
  const Scene scene = noisy_beside_clean(20'000, 2, 1, 1);
  ASSERT_EQ(scene.clean_rows.size(), 2u);
  const auto& [ball, plate] = std::pair(scene.clean_rows[0], scene.clean_rows[1]);
  EXPECT_EQ(scene.truth.components, 3u);
  EXPECT_NEAR(scene.truth.volume, 4 * pi / 3 * (8 + 0.125) + 0.06, 1e-3);
  double worst = 0;
  for (std::size_t i = ball[0]; i < ball[1]; ++i)
    worst = std::max(worst, std::fabs(distance(scene.cloud.points[i], {6, 0, 0}) - 0.5));
  EXPECT_LT(worst, 1e-12);
  for (std::size_t i = plate[0]; i < plate[1]; ++i) EXPECT_GE(scene.cloud.points[i].y, 2.5);
  double square = 0;
  for (std::size_t i = plate[1]; i < scene.cloud.points.size(); ++i)
    square += std::pow(norm(scene.cloud.points[i]) - 2, 2);
  const double spacing = 3.5 * 2 / std::sqrt(20'000.0);
  EXPECT_NEAR(std::sqrt(square / 20'000), 2 * spacing, 0.1 * spacing);
}

TEST(FieldScenes, CavitiesAreInsideAndEllipsoidsAreFull) {
  const std::vector<Cavity> cavities{{{0.42, 0, 0}, 0.5}};
  const Scene hollow = ball_with_cavities(1, cavities, 0.05, 1);
  EXPECT_EQ(hollow.truth.components, 2u);
  EXPECT_NEAR(hollow.truth.volume, 3.665, 1e-3);
  EXPECT_FALSE(hollow.truth.inside({0.42, 0, 0}));
  EXPECT_TRUE(hollow.truth.inside({-0.5, 0, 0}));
  EXPECT_EQ(filled_ellipsoid({4, 3, 2}, 500, 1, 1).cloud.points.size(), 500u);
  const Scene voxels = filled_ellipsoid({14, 10, 9}, 0, 1, 1);
  EXPECT_NEAR(static_cast<double>(voxels.cloud.points.size()) / (4 * pi / 3 * 14 * 10 * 9), 1, 0.03);
}

TEST(FieldMeasures, AreaEdgesAndCleanRows) {
  Scene scene = part_scene(box_part({4, 4, 4}, 1), 0, 1, 1);
  scene.clean_rows = {{0, 10}, {10, scene.cloud.points.size()}};
  Result result = reconstruct(scene.cloud);
  result.mesh = *scene.truth.mesh; // as it should be
  result.report.mesh.area = 96 * 1.02;
  std::vector<std::uint32_t> source(result.mesh.vertices.size());
  for (std::uint32_t v = 0; v < source.size(); ++v) source[v] = v;
  result.mesh.vertex_attributes = {make_attribute("source_index", source)};
  Figures right;
  measure_area(scene, result, right);
  measure_sharp_edges(scene, result, right);
  measure_clean_rows(scene, result, right);
  EXPECT_NEAR(*right.find("area_error"), 0.02, 1e-12);
  EXPECT_EQ(right.find("sharp_edges_kept"), 1.0);
  EXPECT_EQ(right.find("clean_rows_kept"), 1.0);

  std::erase_if(result.mesh.triangles, [&](const auto& t) { // without all that touches one corner
    return std::any_of(t.begin(), t.end(), [&](auto v) { return result.mesh.vertices[v] == Vec3{0, 0, 0}; });
  });
  source[std::find(result.mesh.vertices.begin(), result.mesh.vertices.end(), Vec3{4, 4, 4}) -
         result.mesh.vertices.begin()] = 0; // a vertex of the second body is gone
  result.mesh.vertex_attributes = {make_attribute("source_index", source)};
  Figures wrong;
  measure_sharp_edges(scene, result, wrong);
  measure_clean_rows(scene, result, wrong);
  EXPECT_NEAR(*wrong.find("sharp_edges_kept"), 1 - 6.0 / 48, 1e-12); // three at either corner
  EXPECT_LT(*wrong.find("clean_rows_kept"), 1);
}

TEST(FieldParts, GoThroughEachOther) {
  const std::array<Block, 1> upright{Block{{0, 0, 0}, {2, 2, 8}}};
  const Part part = block_part(upright, 1), lying = laid_down(part);
  Box3 box;
  for (const Vec3& p : lying.samples) box.add(p);
  EXPECT_EQ(box.max, (Vec3{8, 2, 2}));
  EXPECT_DOUBLE_EQ(lying.truth.volume, 32);
  const Part both = through_each_other(part, moved(lying, {-3, 0, 3}), 8);
  EXPECT_EQ(both.samples.size(), 2 * part.samples.size());
  EXPECT_NEAR(both.truth.volume, 56, 1e-9);
  EXPECT_EQ(both.truth.components, 1u);
  EXPECT_EQ(both.truth.mesh, nullptr);
}

/// A case that fails in one way or another, and may say why.
Case excused_case(std::vector<Vec3> points, std::string word) {
  Case c;
  c.group = "field";
  c.name = "thin";
  c.make = [points](Sources& sources, std::uint64_t) { return clean_scene(points, {}, sources.threads()); };
  c.requirements = {equals("components", 17)};
  c.excuse = std::move(word);
  return c;
}

Outcome run(const Case& c) {
  Sources sources("/nowhere", 1);
  return run_case(c, sources, {}, [](const Outcome&, const Run&) {});
}

TEST(FieldCases, WordsMayDoInsteadOfTheRequirements) {
  const std::vector<Vec3> flat{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 1, 0}};
  const Outcome excused = run(excused_case(flat, "coplanar"));
  EXPECT_TRUE(excused.runs.at(0).good());
  EXPECT_THAT(excused.runs.at(0).excused, HasSubstr("coplanar"));
  EXPECT_THAT(to_markdown({excused}, {Preset::robust}, ""), HasSubstr("excused: "));
  EXPECT_FALSE(run(excused_case(flat, "thin")).runs.at(0).good());
  EXPECT_FALSE(run(excused_case(clouds::sphere(300), "thin")).runs.at(0).good()); // no warning at all
}

TEST(FieldCases, NeedFilesOfTheFieldFolder) {
  const TempDir data, field;
  write_bytes(field / "real_x.xyz", "0 0 0\n1 0 0\n0 1 0\n");
  Sources sources(data.path(), 1, field.path());
  EXPECT_TRUE(sources.has("field/real_x.xyz"));
  EXPECT_FALSE(sources.has("real_x.xyz"));
  EXPECT_EQ(sources.points("field/real_x.xyz").size(), 3u);
  std::size_t real = 0;
  for (const Case& c : select_cases(all_cases(), {"field/real"}, false)) {
    ++real;
    EXPECT_THAT(c.files.front(), HasSubstr("field/real_"));
    EXPECT_THAT(run(c).skipped, HasSubstr(c.files.front()));
  }
  EXPECT_GE(real, 7u);
}

TEST(FieldCases, ThinWallsAreAsThinAsTheirNames) {
  // Wall over spacing is what the method must cope with: volume over half the area is the wall.
  Sources sources("", 1);
  struct Row {
    const char* name;
    double ratio;
  };
  for (const auto& [name, ratio] :
       {Row{"field/cup-1.83", 1.83}, Row{"field/cup-1.37", 1.37}, Row{"field/cup-1.4", 1.4}, Row{"field/bowl-1.7", 1.7},
        Row{"field/pipe-bend-1.8", 1.8}, Row{"field/washer-1.3", 1.3}}) {
    const Case c = select_cases(all_cases(), {name}, false).front();
    const Scene scene = c.make(sources, c.seed);
    EXPECT_NEAR(2 * scene.truth.volume / scene.truth.area / scene.spacing, ratio, 0.2 * ratio) << name;
  }
}

TEST(FieldCases, AreTheSameCloudEveryTime) {
  for (const char* name : {"field/tray", "field/beside-noise1.7", "field/room-furnished", "field/cup-darts"}) {
    const Case c = select_cases(all_cases(), {name}, false).front();
    std::vector<std::uint64_t> prints;
    for (const unsigned threads : {1u, 3u}) {
      Sources sources("", threads);
      prints.push_back(fingerprint(c.make(sources, c.seed).cloud.points));
    }
    EXPECT_EQ(prints[0], prints[1]) << name;
  }
}

TEST(Hidden, HousesStandOnWhatTheirRoofsHide) {
  const PointCloud cloud = houses_from_the_air(0.5, 0.02, 1, 2).cloud;
  Options options;
  options.facade = Axis::plus_z;
  const Result result = reconstruct(cloud, options);
  EXPECT_GT(result.mesh.vertices.size(), 97 * cloud.points.size() / 100);
  EXPECT_EQ(result.report.mesh.boundary_loops, 1u);
}

} // namespace
} // namespace eigencrust::bench
