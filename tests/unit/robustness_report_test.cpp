// SPDX-License-Identifier: GPL-3.0-or-later
// Requirements, runs and what is written about them.
#include <eigencrust/error.h>
#include <gmock/gmock.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "clouds.h"
#include "document.h"
#include "runner.h"
#include "shapes.h"
#include "support.h"
#include "table.h"

namespace eigencrust::bench {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

TEST(RobustnessFigures, RequirementsNameWhatIsMissed) {
  Figures figures;
  figures.set("components", 3);
  figures.set("true_samples_kept", 0.985);
  figures.set("volume_error", std::numeric_limits<double>::quiet_NaN());
  const std::vector<Requirement> requirements{equals("components", 1), at_least("true_samples_kept", 0.98),
                                              at_least("true_samples_kept", 0.99), at_most("volume_error", 0.02),
                                              at_most("genus", 2)};
  EXPECT_THAT(missed(requirements, figures),
              ElementsAre("components = 1 (is 3)", "true_samples_kept >= 0.99 (is 0.985)",
                          "volume_error <= 0.02 (is nan)", "genus <= 2 (not measured)"));
}

TEST(RobustnessFigures, ShortNumbers) {
  EXPECT_EQ(short_number(20), "20");
  EXPECT_EQ(short_number(0.005), "0.005");
  EXPECT_EQ(short_number(1.0 / 3), "0.3333");
  EXPECT_EQ(short_number(1'000'000), "1000000");
}

Case sphere_case() {
  Case c;
  c.group = "bodies";
  c.name = "ball";
  c.make = [](Sources& sources, std::uint64_t) {
    return clean_scene(clouds::sphere(500), truth_of(shapes::icosphere(4)), sources.threads());
  };
  c.requirements = {equals("components", 1), at_most("hausdorff", 0.001)};
  return c;
}

Outcome run(const Case& c, const RunnerOptions& options = {}) {
  Sources sources("/nowhere", 1);
  return run_case(c, sources, options, [](const Outcome&, const Run&) {});
}

TEST(RobustnessRunner, MeasuresEveryPreset) {
  RunnerOptions options;
  options.presets = {Preset::robust, Preset::paper};
  const Outcome outcome = run(sphere_case(), options);
  ASSERT_EQ(outcome.runs.size(), 2u);
  EXPECT_EQ(outcome.points, 500u);
  for (const auto& r : outcome.runs) {
    EXPECT_EQ(r.error, "");
    EXPECT_EQ(r.figures.find("components"), 1.0);
    EXPECT_THAT(r.missed, ElementsAre(HasSubstr("hausdorff <= 0.001 (is 0.")));
    EXPECT_GT(r.time_ratio(), 1);
  }
  EXPECT_EQ(outcome.runs[1].report.options.preset, Preset::paper);
}

TEST(RobustnessRunner, TheSurfaceIsThatOfTheOptions) {
  RunnerOptions options;
  EXPECT_EQ(run(sphere_case(), options).runs.at(0).report.options.surface, SurfaceKind::samples);
  options.surface = SurfaceKind::automatic;
  EXPECT_EQ(run(sphere_case(), options).runs.at(0).report.options.surface, SurfaceKind::automatic);
}

TEST(RobustnessRunner, WhatThrowsIsARow) {
  Case no_cloud = sphere_case(), no_volume = sphere_case();
  no_cloud.make = [](Sources&, std::uint64_t) -> Scene { throw std::runtime_error("the dog ate it"); };
  no_volume.make = [](Sources& sources, std::uint64_t) {
    return clean_scene({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 1, 0}}, {}, sources.threads()); // flat
  };
  EXPECT_EQ(run(no_cloud).runs.at(0).error, "the dog ate it");
  EXPECT_THAT(run(no_volume).runs.at(0).error, HasSubstr("coplanar"));
  EXPECT_FALSE(run(no_volume).runs.at(0).good());
}

TEST(RobustnessRunner, SkipsWithoutItsFiles) {
  Case c = sphere_case();
  c.files = {"meshes/unicorn.obj"};
  const Outcome outcome = run(c);
  EXPECT_THAT(outcome.skipped, HasSubstr("meshes/unicorn.obj"));
  EXPECT_THAT(outcome.runs, IsEmpty());
}

TEST(RobustnessRunner, KeepsMeshAndPicture) {
  const TempDir folder;
  RunnerOptions options;
  options.meshes = options.pictures = folder.path();
  Case c = sphere_case();
  c.name = "ball1:10";
  run(c, options);
  EXPECT_TRUE(std::filesystem::exists(folder / "ball1_10-robust.ply"));
  EXPECT_TRUE(std::filesystem::exists(folder / "ball1_10-robust.png"));
}

std::vector<Outcome> three_outcomes() {
  Case skipped = sphere_case(), failing = sphere_case();
  skipped.name = "gone";
  skipped.files = {"unicorn.obj"};
  failing.name = "failing";
  failing.make = [](Sources&, std::uint64_t) -> Scene { throw std::runtime_error("two|lines\nof it"); };
  Case met = sphere_case();
  met.requirements.pop_back();
  return {run(met), run(skipped), run(failing)};
}

TEST(RobustnessReport, JsonHoldsEverything) {
  const auto json = nlohmann::json::parse(to_json(three_outcomes(), {"--cases", "ball"}));
  EXPECT_EQ(json["command"][1], "ball");
  const auto& ball = json["cases"][0];
  EXPECT_EQ(ball["name"], "ball");
  EXPECT_EQ(ball["seed"], 1);
  EXPECT_EQ(ball["cloud_fingerprint"].get<std::string>().size(), 16u);
  EXPECT_EQ(ball["requirements"][0], "components = 1");
  EXPECT_EQ(ball["runs"][0]["met"], true);
  EXPECT_EQ(ball["runs"][0]["figures"]["components"], 1);
  EXPECT_EQ(ball["runs"][0]["report"]["options"]["preset"], "robust");
  EXPECT_EQ(ball["runs"][0]["stages_per_delaunay"]["delaunay"], 1);
  EXPECT_THAT(json["cases"][1]["skipped"].get<std::string>(), HasSubstr("unicorn"));
  EXPECT_EQ(json["cases"][2]["runs"][0]["met"], false);
  EXPECT_EQ(json["cases"][2]["runs"][0]["error"], "two|lines\nof it");
}

TEST(RobustnessReport, TableHasARowPerCaseAndNoSeconds) {
  const std::string text = to_markdown(three_outcomes(), {Preset::robust}, "--quick");
  EXPECT_THAT(text, HasSubstr("eigencrust-robustness --preset robust --quick --json"));
  EXPECT_THAT(text, HasSubstr("`robust` meets its requirement in 1 of 2 cases"));
  EXPECT_THAT(text, HasSubstr("| ball | 500 | 1 | 0 | 100 |"));
  EXPECT_THAT(text, HasSubstr("| met |"));
  EXPECT_THAT(text, HasSubstr("skipped: there is no unicorn.obj |"));
  EXPECT_THAT(text, HasSubstr("error: two\\|lines of it |"));
  EXPECT_THAT(text, Not(HasSubstr("seconds")));
  // Every row of a table has as many cells as its head.
  std::size_t bars = 0;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || line[0] != '|') continue;
    std::size_t count = 0;
    for (std::size_t i = 0; i < line.size(); ++i) count += line[i] == '|' && (i == 0 || line[i - 1] != '\\');
    if (bars == 0) bars = count;
    EXPECT_EQ(count, bars) << line;
  }
}

} // namespace
} // namespace eigencrust::bench
