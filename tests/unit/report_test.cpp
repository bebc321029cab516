// SPDX-License-Identifier: GPL-3.0-or-later
#include <eigencrust/eigencrust.h>
#include <eigencrust/report.h>
#include <gmock/gmock.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "report/describe.h"
#include "report/run.h"
#include "shapes.h"

namespace eigencrust {
namespace {

using nlohmann::json;
using testing::IsSupersetOf;

std::vector<std::string> keys(const json& object) {
  std::vector<std::string> names;
  for (const auto& [key, value] : object.items()) names.push_back(key);
  return names;
}

Report sample_report() {
  Report report;
  report.command = {"eigencrust", "in.ply", "-o", "out \"quoted\".ply"};
  report.files = {{"in.ply", "abc", 100, {}, 0}, {"seen.ply", "def", 7, {{{1, 2, 3}, false}, {{0, 0, 1}, true}}, 5}};
  report.points = 100;
  report.duplicates = 3;
  report.nonfinite = 2;
  report.spacing = 0.25;
  report.bounds.add({0, 0, 0});
  report.bounds.add({1, 2, 3});
  report.options.facade = Axis::minus_y;
  report.options.inside_points = {{1, 2, 3}};
  report.stages = {{"delaunay", 1.5, 4096, {{"tetrahedra", 600}, {"share", 0.5}}}};
  PartitionReport partition;
  partition.stage = "poles";
  partition.nodes = 7;
  partition.sign_changes = {5, 1, 0};
  partition.status = SolverStatus::signs_stable;
  report.partitions = {partition};
  report.mesh = validate(shapes::hollow_sphere(1, 2, 1));
  report.dropped_components = {{5, 6, 3.5, {1, 1, 1}}};
  report.warnings = {"look here"};
  return report;
}

TEST(Report, HasTheSchemaOfTheDocumentation) {
  const json j = json::parse(to_json(sample_report()));
  EXPECT_EQ(j["schema"], 1);
  EXPECT_EQ(j["version"], version());
  EXPECT_THAT(keys(j), IsSupersetOf({"schema", "version", "command", "input", "options", "stages", "partitions", "mesh",
                                     "grid_spacing", "dropped_components", "undecided_nodes", "sight_lines",
                                     "contradicting_rays", "one_sided", "unsupported_area", "seconds",
                                     "peak_memory_bytes", "warnings", "broken_guarantees"}));
  EXPECT_THAT(keys(j["bridged"]), IsSupersetOf({"places", "widest", "at"}));
  EXPECT_THAT(keys(j["input"]), IsSupersetOf({"files", "points", "duplicates", "nonfinite", "spacing", "bounds"}));
  EXPECT_THAT(keys(j["input"]["files"][0]), IsSupersetOf({"path", "sha256", "points"}));
  EXPECT_THAT(keys(j["stages"][0]), IsSupersetOf({"name", "seconds", "peak_memory_bytes", "tetrahedra"}));
  EXPECT_THAT(keys(j["partitions"][0]), IsSupersetOf({"stage", "nodes", "edges", "eigenvalue", "residual", "iterations",
                                                      "sign_changes", "status"}));
  EXPECT_THAT(keys(j["mesh"]), IsSupersetOf({"vertices", "triangles", "boundary_edges", "nonmanifold_edges",
                                             "nonmanifold_vertices", "inconsistent_edges", "degenerate_triangles",
                                             "self_intersections", "all_self_intersections", "components", "genus",
                                             "euler", "volume", "area", "component_list"}));
}

TEST(Report, HoldsWhatItWasGiven) {
  const json j = json::parse(to_json(sample_report()));
  EXPECT_EQ(j["command"][3], "out \"quoted\".ply");
  EXPECT_EQ(j["input"]["duplicates"], 3);
  EXPECT_EQ(j["input"]["bounds"]["max"], json({1.0, 2.0, 3.0}));
  EXPECT_TRUE(j["input"]["files"][0]["sensor"].is_null());
  EXPECT_EQ(j["input"]["files"][1]["sensor"],
            json::parse(R"({"count":2,"points":5,"places":[{"position":[1.0,2.0,3.0]},{"direction":[0.0,0.0,1.0]}]})"));
  EXPECT_EQ(j["stages"][0]["tetrahedra"], 600);
  EXPECT_TRUE(j["stages"][0]["tetrahedra"].is_number_integer());
  EXPECT_EQ(j["stages"][0]["share"], 0.5);
  EXPECT_EQ(j["partitions"][0]["status"], "signs_stable");
  EXPECT_EQ(j["partitions"][0]["sign_changes"], json({5, 1, 0}));
  EXPECT_EQ(j["mesh"]["components"], 2);
  EXPECT_EQ(j["mesh"]["component_list"].size(), 2u);
  EXPECT_EQ(j["dropped_components"][0]["vertices"], 5);
  EXPECT_EQ(j["warnings"][0], "look here");
}

TEST(Report, HoldsEveryEffectiveOption) {
  const json o = json::parse(to_json(sample_report()))["options"];
  EXPECT_THAT(keys(o), testing::UnorderedElementsAre(
                           "preset", "eigensolver", "stop_on_stable_signs", "stable_share", "tolerance", "max_steps",
                           "method", "base", "second_stage", "grid_spacing", "questionable", "global_sign", "noise",
                           "weights", "manifold", "manifold_rule", "components", "surface", "smooth", "smoothing",
                           "triangles", "max_error", "edge", "outside_points", "inside_points", "facade", "threads",
                           "max_memory", "point_results", "crossing_depth", "trim"));
  EXPECT_EQ(o["facade"], "-y");
  EXPECT_EQ(o["inside_points"], json::array({json({1.0, 2.0, 3.0})}));
  EXPECT_EQ(json::parse(to_json(Report{}))["options"]["facade"], "auto");
}

TEST(Report, OfNothingStillParses) {
  const json j = json::parse(to_json(Report{}));
  EXPECT_EQ(j["mesh"]["triangles"], 0);
  EXPECT_TRUE(j["mesh"]["self_intersections"].is_null()); // not computed
  EXPECT_TRUE(j["mesh"]["all_self_intersections"].is_null());
}

TEST(Report, SaysWhetherAllCrossingsWereCounted) {
  MeshSummary summary;
  summary.self_intersections = 7;
  EXPECT_EQ(json::parse(to_json(summary))["all_self_intersections"], true);
  summary.all_self_intersections = false;
  EXPECT_EQ(json::parse(to_json(summary))["all_self_intersections"], false);
  EXPECT_EQ(json::parse(to_json(summary))["self_intersections"], 7);
}

TEST(Report, PathsThatAreNoUtf8AndNumbersThatAreNoneStillParse) {
  Report report = sample_report();
  report.files[0].path = "scan\xff\xfe.ply";
  report.spacing = std::numeric_limits<double>::quiet_NaN();
  report.partitions[0].residual = std::numeric_limits<double>::infinity();
  report.stages[0].counts = {{"odd", std::numeric_limits<double>::infinity()}, {"huge", 1e300}};
  const json j = json::parse(to_json(report));
  EXPECT_TRUE(j["input"]["spacing"].is_null());
  EXPECT_EQ(j["stages"][0]["huge"], 1e300);
}

TEST(Report, ListsAtMostAHundredComponents) {
  MeshSummary mesh;
  mesh.component_list.resize(250);
  EXPECT_EQ(json::parse(to_json(mesh))["component_list"].size(), 100u);
}

TEST(Report, PeakMemoryIsPlausible) {
  EXPECT_GT(peak_memory_bytes(), 1u << 20);
  EXPECT_LT(peak_memory_bytes(), 1ull << 42);
}

TEST(Report, EveryStatusHasAName) {
  using enum SolverStatus;
  std::vector<std::string> names;
  for (const SolverStatus status : {converged, signs_stable, consistent, not_converged, trivial})
    names.emplace_back(to_string(status));
  EXPECT_THAT(names, testing::ElementsAre("converged", "signs_stable", "consistent", "not_converged", "trivial"));
}

/// Of 1000 points.
std::vector<std::string> warnings_of_a_piece_left_out(std::uint32_t vertices, Report report) {
  report.points = 1000;
  Observer observer;
  Run run(report, observer);
  describe(std::vector<DroppedComponent>{{vertices, 2 * vertices, 0.1, {}}}, run);
  EXPECT_EQ(report.dropped_components.size(), 1u);
  return report.warnings;
}

TEST(Report, WhatALargePieceLeftOutMayBeIsTold) {
  using testing::AllOf, testing::ElementsAre, testing::HasSubstr, testing::IsEmpty, testing::Not;
  const auto leaves_out = HasSubstr("was left out");
  const auto may_be_ground = HasSubstr("--facade +z"), was_amid = HasSubstr("--sensor");
  EXPECT_THAT(warnings_of_a_piece_left_out(10, {}), IsEmpty());
  EXPECT_THAT(warnings_of_a_piece_left_out(90, {}), ElementsAre(AllOf(leaves_out, Not(was_amid))));
  EXPECT_THAT(warnings_of_a_piece_left_out(300, {}), ElementsAre(AllOf(leaves_out, may_be_ground, was_amid)));
  Report seen;
  seen.sight_lines = 1000;
  EXPECT_THAT(warnings_of_a_piece_left_out(300, seen), ElementsAre(AllOf(leaves_out, Not(may_be_ground))));
  Report lies_like_ground;
  lies_like_ground.surroundings.likely_facade = Axis::plus_z;
  EXPECT_THAT(warnings_of_a_piece_left_out(300, lies_like_ground),
              ElementsAre(AllOf(leaves_out, may_be_ground, HasSubstr("--base"), Not(was_amid))));
}

} // namespace
} // namespace eigencrust
