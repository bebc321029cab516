// SPDX-License-Identifier: GPL-3.0-or-later
#include "speed_runner.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

#include "child_process.h"

namespace eigencrust::bench {
namespace {

namespace fs = std::filesystem;
using Tell = std::function<void(const std::string&)>;

std::string line(const std::string& what, double seconds, std::uint64_t bytes) {
  char text[160];
  std::snprintf(text, sizeof text, "%s: %.3f s, %.0f MB", what.c_str(), seconds, static_cast<double>(bytes) / 1e6);
  return text;
}

void time_yardstick(const fs::path& cloud, const SpeedRunnerOptions& options, CgalTimes& times, const Tell& tell) {
  const ChildRun child = run_child({options.yardstick, "--cgal-only", cloud});
  const auto said = nlohmann::json::parse(child.output);
  times.seconds.push_back(said.at("seconds").get<double>());
  times.tetrahedra = said.at("tetrahedra").get<std::uint64_t>();
  times.peak_memory_bytes = std::max(times.peak_memory_bytes, child.peak_memory_bytes);
  tell(line("CGAL", times.seconds.back(), child.peak_memory_bytes));
}

/// Adds the run to the times of its stage; a stage that appears twice is one.
void add_stage(WholeTimes& times, const std::string& name, double seconds, std::size_t run) {
  auto found = std::find_if(times.stages.begin(), times.stages.end(), [&](const auto& s) { return s.first == name; });
  if (found == times.stages.end()) found = times.stages.insert(found, {name, {}});
  found->second.resize(run + 1, 0.0);
  found->second[run] += seconds;
}

void time_whole(const fs::path& cloud, const SpeedRunnerOptions& options, WholeTimes& times, SpeedOutcome& outcome,
                const Tell& tell) {
  const fs::path mesh = options.scratch / "mesh.ply", report_path = options.scratch / "report.json";
  const ChildRun child = run_child({options.program, cloud, "-o", mesh, "--threads", std::to_string(times.threads),
                                    "--report", report_path, "--quiet"});
  std::ifstream stream(report_path);
  const auto report = nlohmann::json::parse(stream);
  const std::size_t run = times.seconds.size();
  times.seconds.push_back(child.wall_seconds);
  times.user_seconds.push_back(child.user_seconds);
  times.peak_memory_bytes = std::max(times.peak_memory_bytes, child.peak_memory_bytes);
  double in_stages = 0;
  for (const auto& stage : report.at("stages")) {
    if (stage.value("beside", false)) continue; // its time is part of another stage's
    const double seconds = stage.at("seconds").get<double>();
    add_stage(times, stage.at("name").get<std::string>(), seconds, run);
    in_stages += seconds;
  }
  add_stage(times, "other", child.wall_seconds - in_stages, run);
  for (const auto& partition : report.at("partitions"))
    (partition.at("stage") == "poles" ? times.pole_steps : times.tetrahedron_steps) =
        partition.at("iterations").get<std::uint64_t>();
  outcome.points = report.at("input").at("points").get<std::uint64_t>();
  fs::remove(mesh);
  fs::remove(report_path);
  tell(line("eigencrust, " + std::to_string(times.threads) + (times.threads == 1 ? " thread" : " threads"),
            child.wall_seconds, child.peak_memory_bytes));
}

void time_runs(const fs::path& cloud, const SpeedRunnerOptions& options, SpeedOutcome& outcome, const Tell& tell) {
  for (const unsigned threads : options.threads) outcome.whole.emplace_back().threads = threads;
  // In turn, so that a machine that slows down slows down both.
  for (unsigned run = 0; run < options.runs; ++run) {
    time_yardstick(cloud, options, outcome.cgal, tell);
    for (WholeTimes& times : outcome.whole) time_whole(cloud, options, times, outcome, tell);
  }
}

} // namespace

SpeedOutcome time_cloud(const SpeedCase& item, const SpeedRunnerOptions& options, const Tell& tell) {
  SpeedOutcome outcome;
  outcome.item = item;
  const bool generated = item.file.empty();
  const fs::path cloud = generated ? options.scratch / (item.name + ".ply") : options.data / item.file;
  if (!generated && !fs::is_regular_file(cloud)) {
    outcome.skipped = "there is no " + item.file;
    return outcome;
  }
  try {
    if (generated) // in a process of its own: see run_child
      run_child({options.yardstick, "--generate-only", std::to_string(item.generated_points), cloud});
    time_runs(cloud, options, outcome, [&](const std::string& text) { tell(item.name + " " + text); });
  } catch (const std::exception& error) {
    outcome.error = error.what();
  }
  std::error_code ignored;
  if (generated) fs::remove(cloud, ignored);
  return outcome;
}

} // namespace eigencrust::bench
