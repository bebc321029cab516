// SPDX-License-Identifier: GPL-3.0-or-later
#include "contest_runner.h"

#include <algorithm>
#include <charconv>

#include <eigencrust/error.h>
#include <eigencrust/io.h>
#include <eigencrust/render.h>

#include "child_process.h"
#include "data_folder.h"

namespace eigencrust::bench {
namespace {

namespace fs = std::filesystem;

/// A peer gets that much of our processor time, but never less than the seconds that programs take to start; and as
/// much again of wall time on a machine where it gets a tenth of a core.
constexpr double patience = 20, least_patience = 20, wall_patience = 10;
constexpr std::uint64_t most_memory = 20'000'000'000; // of address space, so that one peer cannot end the machine

std::string step_output(const ContestSettings& settings, std::vector<std::string> words) {
  std::vector<std::string> command = settings.itself;
  command.insert(command.end(), words.begin(), words.end());
  return run_child(command).output;
}

/// Runs the commands of a contestant. \return whether it was in time
bool run_commands(const Contestant& who, double limit, ContestRun& run) {
  for (const auto& command : who.commands) {
    const bool last = &command == &who.commands.back();
    const ChildRun child =
        run_child(command, who.peer ? ChildLimits{wall_patience * limit, limit, most_memory} : ChildLimits{});
    double seconds = child.user_seconds + child.system_seconds;
    const std::string& said = child.output;
    if (who.says_time && last) std::from_chars(said.data(), said.data() + said.size(), seconds);
    run.seconds += seconds;
    run.bytes = std::max(run.bytes, static_cast<double>(child.peak_memory_bytes));
    if (child.stopped) return false;
  }
  return true;
}

/// Measures and draws the mesh of a run. \param other the mesh to compare it with; may be empty
void look_at(const ContestCase& item, const ContestSettings& settings, const fs::path& mesh, const fs::path& other,
             ContestRun& run) {
  const std::string folder = mesh.parent_path().string();
  const std::string figures = step_output(
      settings, {"--step", "measure", "--folder", folder, "--mesh", mesh.string(), "--other", other.string()});
  run.figures = nlohmann::json::parse(figures);
  if (!item.pictures) return;
  run.picture = mesh.stem().string() + ".png";
  step_output(settings, {"--step", "draw", "--contest", item.group + "/" + item.name, "--mesh", mesh.string(),
                         "--picture", (mesh.parent_path() / run.picture).string()});
}

void run_one(const ContestCase& item, const ContestSettings& settings, const Contestant& who, const fs::path& mesh,
             const fs::path& other, double limit, ContestRun& run) {
  run.note = who.missing;
  if (!run.note.empty()) return;
  try {
    if (!run_commands(who, limit, run))
      run.note = "stopped after " + std::to_string(static_cast<int>(patience)) + " times our time";
    else if (!fs::exists(mesh))
      run.note = "no surface";
    else
      look_at(item, settings, mesh, other, run);
  } catch (const Error& error) {
    run.note = error.cause();
  } catch (const std::exception& error) {
    run.note = error.what();
  }
}

/// Runs one contestant with a file of its own. \param first that its commands name \param other to compare with; may be
/// empty \param limit of seconds for peers
ContestRun contend(const ContestCase& item, const ContestSettings& settings, Contestant who, const fs::path& mesh,
                   const fs::path& first, const fs::path& other, double limit) {
  for (auto& command : who.commands) std::replace(command.begin(), command.end(), first.string(), mesh.string());
  ContestRun run{who.name, who.peer, {}, 0, 0, {}, {}};
  fs::remove(mesh);
  run_one(item, settings, who, mesh, other, limit, run);
  return run;
}

void draw_panel(const ContestCase& item, const ContestSettings& settings, const fs::path& folder,
                const ContestScene& scene, ContestOutcome& outcome) {
  std::string meshes;
  for (const std::string& name : item.panel) {
    const auto run = std::ranges::find(outcome.runs, name, &ContestRun::name);
    fs::path file = scene.cloud;
    if (run != outcome.runs.end()) file = folder / (std::to_string(run - outcome.runs.begin()) + ".ply");
    if (name != "cloud" && (run == outcome.runs.end() || !run->note.empty())) continue;
    meshes.append(meshes.empty() ? "" : ",").append(file.string());
    outcome.panel.push_back(name);
  }
  if (!meshes.empty())
    step_output(settings, {"--step", "draw", "--contest", item.group + "/" + item.name, "--mesh", meshes, "--picture",
                           (folder / "panel.png").string()});
}

} // namespace

fs::path contest_folder(const ContestCase& item, const fs::path& work) { return work / (item.group + "-" + item.name); }

ContestOutcome run_contest(const ContestCase& item, const ContestSettings& settings,
                           const std::function<void(const ContestRun&)>& tell) {
  const fs::path folder = contest_folder(item, settings.work), first = folder / "0.ply";
  step_output(settings, {"--step", "make", "--contest", item.group + "/" + item.name, "--folder", folder.string()});
  const ContestScene scene = read_contest_scene(folder);
  ContestOutcome outcome;
  outcome.group = item.group;
  outcome.name = item.name;
  outcome.description = item.description;
  outcome.points = scene.points;
  outcome.genus = scene.genus;
  outcome.components = scene.components;
  outcome.volume = scene.volume;
  double limit = 0;
  fs::path faces; // their mesh, once it is there
  for (const Contestant& who : contestants(item, settings.programs, scene.cloud, first, settings.threads)) {
    const fs::path mesh = folder / (std::to_string(outcome.runs.size()) + ".ply");
    outcome.runs.push_back(contend(item, settings, who, mesh, first, faces, limit));
    if (who.name == faces_only) faces = mesh;
    if (who.name == ourselves) limit = std::max(least_patience, patience * outcome.runs.back().seconds);
    const bool shown = std::ranges::find(item.panel, who.name) != item.panel.end();
    if (!settings.keep_meshes && mesh != first && mesh != faces && !shown) fs::remove(mesh);
    tell(outcome.runs.back());
  }
  draw_panel(item, settings, folder, scene, outcome);
  if (item.curves) {
    outcome.curves = "curves.svg";
    step_output(settings,
                {"--step", "curves", "--folder", folder.string(), "--picture", (folder / outcome.curves).string()});
  }
  for (std::size_t i = 0; i < outcome.runs.size() && !settings.keep_meshes; ++i)
    fs::remove(folder / (std::to_string(i) + ".ply"));
  const nlohmann::json json = outcome;
  write_text((folder / "outcome.json").string(), json.dump(1) + "\n");
  return outcome;
}

} // namespace eigencrust::bench
