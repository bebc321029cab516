// SPDX-License-Identifier: GPL-3.0-or-later
#include "contest_main.h"

#include <fstream>
#include <iomanip>
#include <iostream>

#include <eigencrust/error.h>

#include "contest_page.h"
#include "contest_pictures.h"
#include "contest_runner.h"
#include "data_folder.h"

namespace eigencrust::bench {
namespace {

namespace fs = std::filesystem;

ContestCase only_case(const std::string& name) {
  for (const ContestCase& c : contest_cases())
    if (c.group + "/" + c.name == name) return c;
  throw Error(ErrorKind::usage, "--contest", "there is no case '" + name + "'", "see --list");
}

void run_step(const ContestArguments& a) {
  if (a.step == "make") {
    Sources sources(a.data, a.threads, a.field);
    write_contest_scene(only_case(a.contest), sources, a.folder);
  } else if (a.step == "measure") {
    const nlohmann::json figures = contest_figures(a.folder, a.mesh, a.other, a.threads);
    std::cout << figures.dump() << "\n";
  } else if (a.step == "draw") {
    draw_contest(only_case(a.contest), a.mesh, a.picture);
  } else {
    draw_curves(read_contest_scene(a.folder).cloud, a.picture, a.threads);
  }
}

/// One line per contestant, as soon as it is done.
void tell(const ContestCase& item, const ContestRun& run) {
  std::cerr << item.group << "/" << item.name << " " << run.name << ": " << std::fixed << std::setprecision(1)
            << run.seconds << " s, " << run.bytes / 1e6 << " MB";
  if (!run.note.empty())
    std::cerr << ", " << run.note;
  else
    std::cerr << ", " << std::setprecision(0) << run.figures.pieces << " pieces, genus " << run.figures.genus << ", "
              << run.figures.boundary << " boundary edges";
  std::cerr << std::endl;
}

void show(const ContestArguments& a, const std::vector<ContestOutcome>& outcomes) {
  const PageFiles files{a.work, a.pictures};
  if (a.table.empty()) std::cout << contest_markdown(outcomes, files);
  write_text(a.table, contest_markdown(outcomes, files));
  write_text(a.page, contest_html(outcomes, files));
}

} // namespace

void run_contests(const ContestArguments& a, const std::string& itself) {
  if (!a.step.empty()) return run_step(a);
  ContestSettings settings;
  settings.programs = {a.program, a.peers, a.python};
  settings.itself = {itself, "--data", a.data, "--field", a.field, "--threads", std::to_string(a.threads)};
  settings.work = a.work;
  settings.threads = a.threads;
  settings.keep_meshes = a.keep_meshes;
  const Sources sources(a.data, a.threads, a.field);
  std::vector<ContestOutcome> outcomes;
  for (const ContestCase& c : select_contest_cases(a.contest)) {
    if (a.list) {
      std::cout << c.group << "/" << c.name << "\n    " << c.description << "\n";
      continue;
    }
    const auto lacks = std::ranges::find_if(c.files, [&](const std::string& file) { return !sources.has(file); });
    if (lacks != c.files.end()) {
      std::cerr << c.group << "/" << c.name << " skipped: there is no " << *lacks << "\n";
      continue;
    }
    std::ifstream known(contest_folder(c, a.work) / "outcome.json");
    if (known && !a.again)
      outcomes.push_back(nlohmann::json::parse(known));
    else
      outcomes.push_back(run_contest(c, settings, [&](const ContestRun& run) { tell(c, run); }));
    if (!a.table.empty()) show(a, outcomes); // a run that is stopped leaves what it has
  }
  if (!a.list) show(a, outcomes);
}

} // namespace eigencrust::bench
