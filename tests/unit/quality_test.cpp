// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "child_process.h"
#include "contest_pictures.h"
#include "contest_scene.h"
#include "contest_verdict.h"
#include "page_blocks.h"
#include "shapes.h"

namespace eigencrust::bench {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

TEST(QualityChild, IsStoppedWhenItsTimeIsUp) {
  const ChildRun late = run_child({"/bin/sleep", "20"}, {.seconds = 0.2});
  EXPECT_TRUE(late.stopped);
  EXPECT_LT(late.wall_seconds, 10);
  const ChildRun quiet = run_child({"/bin/sh", "-c", "exec >&-; sleep 20"}, {.seconds = 0.2});
  EXPECT_TRUE(quiet.stopped); // its output has ended, it has not
  EXPECT_LT(quiet.wall_seconds, 10);
  const ChildRun busy = run_child({"/bin/sh", "-c", "while :; do :; done"}, {.seconds = 100, .processor_seconds = 1});
  EXPECT_TRUE(busy.stopped);
  EXPECT_LT(busy.user_seconds + busy.system_seconds, 5);
  const ChildRun early = run_child({"/bin/echo", "done"}, {.seconds = 20});
  EXPECT_FALSE(early.stopped);
  EXPECT_EQ(early.output, "done\n");
}

ContestRun run_of(const std::string& name, double genus, double to_truth) {
  ContestRun run{name, true, {}, 1, 1, {}, {}};
  run.figures.pieces = 1;
  run.figures.genus = genus;
  run.figures.boundary = run.figures.nonmanifold = run.figures.crossings = run.figures.outliers = 0;
  run.figures.to_truth = to_truth;
  run.figures.volume = 10;
  return run;
}

const ContestColumn& column(const std::string& title) {
  for (const ContestColumn& c : contest_columns())
    if (c.title == title) return c;
  throw std::logic_error("no column " + title);
}

TEST(QualityVerdict, SmallerIsBetterButNotByChance) {
  ContestOutcome outcome;
  outcome.genus = 2;
  outcome.runs = {run_of(ourselves, 1, 1), run_of("right", 2, 0.99), run_of("more", 3, 0.9),
                  run_of("one-sided", -1, 2)};
  EXPECT_TRUE(wins(column("genus"), outcome.runs[1], outcome));
  EXPECT_FALSE(wins(column("genus"), outcome.runs[2], outcome)); // as far off as ours
  EXPECT_FALSE(wins(column("genus"), outcome.runs[3], outcome));
  EXPECT_FALSE(wins(column("to truth"), outcome.runs[1], outcome)); // 1 % is chance
  EXPECT_TRUE(wins(column("to truth"), outcome.runs[2], outcome));
  EXPECT_FALSE(wins(column("edges"), outcome.runs[2], outcome)); // not known
  EXPECT_FALSE(wins(column("genus"), outcome.runs[0], outcome));
  outcome.runs[1].figures.missed = 0.2; // a scrap
  EXPECT_FALSE(wins(column("genus"), outcome.runs[1], outcome));
}

TEST(QualityVerdict, NamesTheFirstFault) {
  ContestOutcome outcome;
  outcome.genus = 0;
  ContestRun run = run_of("other", 0, 1);
  EXPECT_EQ(fault(run, outcome, 10, 0.05), "");
  EXPECT_EQ(fault(run, outcome, 0, 0.05), "");
  EXPECT_EQ(fault(run, outcome, 9, 0.05), "volume +11 %");
  EXPECT_EQ(fault(run, outcome, 9, 0.2), "");
  run.figures.missing = 0.2;
  EXPECT_EQ(fault(run, outcome, 10, 0.05), "20 % missing");
  run.figures.genus = 1234;
  EXPECT_EQ(fault(run, outcome, 10, 0.05), "genus 1,234");
  outcome.genus = 1234;
  EXPECT_EQ(fault(run, outcome, 10, 0.05), "20 % missing");
  run.figures.pieces = 3;
  EXPECT_EQ(fault(run, outcome, 10, 0.05), "3 pieces");
  run.figures.boundary = 5;
  EXPECT_EQ(fault(run, outcome, 10, 0.05), "open");
  run.note = "not installed";
  EXPECT_EQ(fault(run, outcome, 10, 0.05), "not installed");
}

TEST(QualityScene, StraysAreThoseFarFromTheirEighthNeighbour) {
  std::vector<Vec3> points = shapes::icosphere(4, 1, {}).vertices;
  const auto last = static_cast<std::uint32_t>(points.size());
  points.push_back({4, 0, 0});
  points.push_back({4.001, 0, 0}); // two together are strays, too
  EXPECT_THAT(outlier_rows(points, 0, 1), ElementsAre(last, last + 1));
  EXPECT_THAT(outlier_rows(points, last + 1, 1), ElementsAre(last + 1)); // known
}

TEST(QualityScene, TrianglesAgreeWhateverTheirOrder) {
  const TriangleMesh mesh = shapes::icosphere(2, 1, {});
  TriangleMesh other = mesh;
  std::reverse(other.triangles.begin(), other.triangles.end());
  for (auto& t : other.triangles) std::swap(t[0], t[2]);
  EXPECT_EQ(triangle_agreement(mesh, other).same, 1);
  EXPECT_EQ(triangle_agreement(mesh, other).but_for_turned, 1);
  other.triangles.resize(other.triangles.size() / 2);
  EXPECT_EQ(triangle_agreement(mesh, other).same, 0.5);
  EXPECT_EQ(triangle_agreement(mesh, other).but_for_turned, 0.5); // what is missing is no turned edge
  EXPECT_EQ(triangle_agreement({}, {}).same, 0);
}

TEST(QualityScene, TurnedEdgesAreTold) {
  TriangleMesh square, turned, moved;
  square.vertices = turned.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 5}, {1, 0, 5}, {0, 1, 5}};
  square.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}};
  turned.triangles = {{0, 1, 3}, {1, 2, 3}, {4, 5, 6}};
  EXPECT_DOUBLE_EQ(triangle_agreement(square, turned).same, 1.0 / 3);
  EXPECT_EQ(triangle_agreement(square, turned).but_for_turned, 1);
  moved = turned;
  moved.vertices[2] = {1, 1, 1}; // other corners: another surface
  EXPECT_DOUBLE_EQ(triangle_agreement(square, moved).but_for_turned, 1.0 / 3);
}

TEST(QualityPage, IsTheSameInMarkdownAndHtml) {
  const Blocks blocks{Heading{2, "Two"}, Paragraph{"a < b, *so* `x**y` **bold**"},
                      PageTable{{"method", "n"}, {{"★ a|b", "**1**"}, {"c", "2"}}}};
  EXPECT_EQ(blocks_as_markdown(blocks, {}),
            "## Two\n\na < b, *so* `x**y` **bold**\n\n| method | n |\n|---|---:|\n| ★ a\\|b | **1** |\n| c | 2 |\n");
  const std::string html = blocks_as_html(blocks, "T & U");
  EXPECT_THAT(html, HasSubstr("<h2>Two</h2>"));
  EXPECT_THAT(html, HasSubstr("a &lt; b, <em>so</em> <code>x**y</code> <strong>bold</strong>"));
  EXPECT_THAT(html, HasSubstr("<tr class=\"marked\"><td>★ a|b</td><td><strong>1</strong></td></tr>"));
  EXPECT_THAT(html, HasSubstr("<tr><td>c</td><td>2</td></tr>"));
  EXPECT_THAT(html, HasSubstr("<title>T &amp; U</title>"));
}

TEST(QualityPage, CurvesRunFromLeastToGreatest) {
  const SortedValues values{{-2, -1, 1}, 3, 2};
  const std::string svg = curves_svg(values, {});
  // Zero at 85; -2 is the farthest from it, half of 110 below.
  EXPECT_THAT(svg, HasSubstr("M56.7 140.0L150.0 112.5L243.3 57.5"));
  EXPECT_THAT(svg, Not(HasSubstr("second")));
}

} // namespace
} // namespace eigencrust::bench
