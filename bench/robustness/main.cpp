// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// eigencrust-robustness: a table of hard clouds through the method, with figures.
#include <CLI/CLI.hpp>
#include <iomanip>
#include <iostream>

#include <eigencrust/error.h>

#include "command.h"
#include "data_folder.h"
#include "document.h"
#include "runner.h"
#include "table.h"

namespace {

using namespace eigencrust;
using namespace eigencrust::bench;

constexpr const char* about =
    "Runs a table of cases (clouds with outliers, noise, missing parts, uneven density, displaced scans) with\n"
    "fixed seeds and measures each result against the truth.\n"
    "\n"
    "Examples:\n"
    "  eigencrust-robustness --list\n"
    "  eigencrust-robustness --quick --table robustness.md\n"
    "  eigencrust-robustness --preset robust --preset paper --cases outliers/,torus-cut --json robustness.json";

struct Settings {
  std::string data, field, surface = to_string(RunnerOptions().surface), json, table, meshes, pictures;
  std::vector<std::string> patterns, presets;
  bool list = false, quick = false;
  unsigned threads = 0;
};

void list(const std::vector<Case>& cases) {
  for (const Case& c : cases) {
    std::cout << c.group << "/" << c.name << (c.large ? " (large)" : "") << "\n    " << c.description << "\n    ";
    for (const Requirement& r : c.requirements) std::cout << describe(r) << (&r == &c.requirements.back() ? "" : ", ");
    std::cout << (c.requirements.empty() ? "no requirement\n" : "\n");
  }
}

void make_folder(const std::string& folder) {
  std::error_code error;
  if (!folder.empty() && !std::filesystem::is_directory(folder) && !std::filesystem::create_directories(folder, error))
    throw Error(ErrorKind::usage, folder, "the folder cannot be created", "choose another one");
}

/// One line per run: as soon as it is known.
void tell(std::size_t number, std::size_t count, const Outcome& outcome, const Run& run) {
  std::cerr << "[" << number << "/" << count << "] " << outcome.item.name << " " << to_string(run.preset) << " ("
            << std::fixed << std::setprecision(1) << run.report.seconds << " s): ";
  if (!run.error.empty()) std::cerr << "error: " << run.error;
  for (const std::string& m : run.missed) std::cerr << (&m == &run.missed.front() ? "missed: " : ", ") << m;
  if (!run.excused.empty())
    std::cerr << "excused: " << run.excused;
  else if (run.good())
    std::cerr << (outcome.item.requirements.empty() ? "no requirement" : "met");
  std::cerr << std::endl;
}

void run(const Settings& s, const std::vector<std::string>& command) {
  const std::vector<Case> cases = select_cases(all_cases(), s.patterns, s.quick);
  if (s.list) return list(cases);
  RunnerOptions options;
  options.surface = parse_surface_kind(s.surface);
  options.meshes = s.meshes;
  options.pictures = s.pictures;
  if (!s.presets.empty()) options.presets.clear();
  for (const std::string& name : s.presets) options.presets.push_back(parse_preset(name));
  make_folder(s.meshes);
  make_folder(s.pictures);
  std::string selection = s.quick ? "--quick" : "";
  for (const std::string& pattern : s.patterns)
    selection.append(selection.empty() ? "--cases " : " --cases ").append(pattern);
  if (options.surface != RunnerOptions().surface)
    selection.append(selection.empty() ? "--surface " : " --surface ").append(s.surface);

  Sources sources(s.data, s.threads, s.field);
  std::vector<Outcome> outcomes;
  for (const Case& c : cases) {
    outcomes.push_back(run_case(c, sources, options, [&](const Outcome& outcome, const Run& done) {
      tell(outcomes.size() + 1, cases.size(), outcome, done);
    }));
    if (!outcomes.back().skipped.empty())
      std::cerr << "[" << outcomes.size() << "/" << cases.size() << "] " << c.name
                << " skipped: " << outcomes.back().skipped << std::endl;
    // After every case, so that a run that is stopped leaves what it has.
    write_text(s.json, to_json(outcomes, command));
    write_text(s.table, to_markdown(outcomes, options.presets, selection));
  }
  if (s.table.empty() && s.json.empty()) std::cout << to_markdown(outcomes, options.presets, selection);
}

} // namespace

int main(int argc, char** argv) {
  Settings s;
  s.data = default_data_folder();
  s.field = default_field_folder();
  CLI::App app(about, "eigencrust-robustness");
  app.add_option("--data", s.data, "Folder of the real data; cases whose files are not there are skipped")
      ->default_str("$EIGENCRUST_DATA or ../shared/data");
  app.add_option("--field", s.field, "Folder of the field data, likewise")
      ->default_str("$EIGENCRUST_FIELD or ../shared/field");
  app.add_option("--cases", s.patterns, "Cases whose group/name contains this text; several, or a comma list")
      ->allow_extra_args(false);
  app.add_flag("--quick", s.quick, "Only cases under 100,000 points");
  app.add_flag("--list", s.list, "List the cases and what they must show, run nothing");
  app.add_option("--preset", s.presets, "robust or paper; repeatable [robust]")->allow_extra_args(false);
  app.add_option("--surface", s.surface, "samples, auto, fitted or delaunay")->capture_default_str();
  app.add_option("--json", s.json, "File for every figure, seed and option");
  app.add_option("--table", s.table, "File for the table in Markdown; without any file it goes to stdout");
  app.add_option("--meshes", s.meshes, "Folder for the resulting meshes");
  app.add_option("--pictures", s.pictures, "Folder for pictures of them");
  app.add_option("--threads", s.threads, "0: all cores")->check(CLI::Range(0, 1024))->capture_default_str();
  const std::vector<std::string> command(argv + 1, argv + argc);
  return tools::run_command(app, argc, argv, [&] { run(s, command); });
}
