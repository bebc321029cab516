// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// eigencrust-quality: how good the meshes are, beside those of other methods and programs.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>

#include <eigencrust/error.h>

#include "command.h"
#include "contest_main.h"
#include "data_folder.h"
#include "fit_cases.h"

namespace {

using namespace eigencrust;
using namespace eigencrust::bench;

constexpr const char* about =
    "--cases fit samples known shapes with noise, reconstructs them and measures the error; beside it that of "
    "Open3D's\n"
    "screened Poisson with normals oriented by the truth (Debian's python3-open3d; left out where it is not "
    "installed).\n"
    "Lengths are in spacings; distances are means, mesh to truth / truth to mesh, then the error of the normals.\n"
    "\n"
    "--cases contest runs the clouds of the figures of the 2004 paper, raw and simulated scans through all methods of\n"
    "this program and, where they are installed, those of Open3D, CGAL and MeshLab, and writes a page of tables and "
    "pictures.\n"
    "Outcomes are kept in the work folder: what was run is not run again. scripts/quality.sh does all of it.\n"
    "\n"
    "Examples:\n"
    "  eigencrust-quality --cases fit --shapes horse,gear --sigma 0.5,1 --table fit.md\n"
    "  eigencrust-quality --cases contest --contest fig9/,raw/bunny --table quality.md --page quality.html";

struct Settings {
  std::string cases = "fit", shapes = "horse,armadillo,gear", sigma = "0,0.25,0.5,1,2";
  std::size_t samples = 60'000;
  std::uint64_t seed = 1;
  ContestArguments contest;
};

FitShape shape_named(const std::string& name) {
  const auto& shapes = fit_shapes();
  const auto found = std::find_if(shapes.begin(), shapes.end(), [&](const FitShape& s) { return s.name == name; });
  if (found != shapes.end()) return *found;
  std::string names;
  for (const FitShape& s : shapes) names += (names.empty() ? "" : ", ") + s.name;
  throw Error(ErrorKind::usage, "--shapes", "'" + name + "' is no shape", "use some of " + names);
}

void run_fits(const Settings& s) {
  const ContestArguments& c = s.contest;
  const FitBenchOptions options{c.data, c.work, c.python, s.samples, s.seed, c.threads};
  std::filesystem::create_directories(c.work);
  std::vector<FitOutcome> outcomes;
  for (const std::string& name : CLI::detail::split(s.shapes, ',')) {
    const FitShape shape = shape_named(name);
    if (!shape.file.empty() && !std::filesystem::is_regular_file(options.data / shape.file)) {
      std::cerr << name << " skipped: there is no " << shape.file << "\n";
      continue;
    }
    for (const double sigma : tools::parse_numbers(s.sigma, ',', 1, 100, "--sigma")) {
      outcomes.push_back(run_fit_case(shape, sigma, options));
      std::cerr << to_markdown({outcomes.back()}).substr(to_markdown({}).size());
      write_text(c.table, to_markdown(outcomes)); // a run that is stopped leaves what it has
    }
  }
  if (c.table.empty()) std::cout << to_markdown(outcomes);
}

void add_fit_options(CLI::App& app, Settings& s) {
  app.add_option("--shapes", s.shapes, "fit: of horse, armadillo, gear, angel, fandisk, cube")->capture_default_str();
  app.add_option("--sigma", s.sigma, "fit: standard deviations of the noise, in spacings")->capture_default_str();
  app.add_option("--samples", s.samples, "fit: on each shape")
      ->check(CLI::Range(100, 10'000'000))
      ->capture_default_str();
  app.add_option("--seed", s.seed, "fit: of samples and noise")->capture_default_str();
}

void add_contest_options(CLI::App& app, ContestArguments& c) {
  app.add_option("--contest", c.contest, "contest: cases whose group/name contains one of these words");
  app.add_flag("--list", c.list, "contest: list the cases, run nothing");
  app.add_flag("--again", c.again, "contest: run also what the work folder has the outcome of");
  app.add_flag("--keep-meshes", c.keep_meshes, "contest: keep the meshes in the work folder");
  app.add_option("--program", c.program, "contest: the command [beside this one]");
  app.add_option("--peers", c.peers, "contest: the drivers of CGAL's methods [beside this one]");
  app.add_option("--field", c.field, "contest: folder of the field data")
      ->default_str("$EIGENCRUST_FIELD or ../shared/field");
  app.add_option("--page", c.page, "contest: file for the page in HTML, with all pictures");
  app.add_option("--pictures", c.pictures, "contest: folder beside the table for the pictures it shows");
  for (const auto& [name, value] : {std::pair{"--step", &c.step},
                                    {"--folder", &c.folder},
                                    {"--mesh", &c.mesh},
                                    {"--other", &c.other},
                                    {"--picture", &c.picture}})
    app.add_option(name, *value)->group(""); // hidden: of its own children
}

} // namespace

int main(int argc, char** argv) {
  Settings s;
  ContestArguments& c = s.contest;
  c.data = default_data_folder();
  c.field = default_field_folder();
  c.work = "quality";
  c.python = "/usr/bin/python3";
  const std::filesystem::path itself = std::filesystem::canonical("/proc/self/exe");
  c.program = itself.parent_path() / "eigencrust";
  c.peers = itself.parent_path() / "eigencrust-peers";
  CLI::App app(about, "eigencrust-quality");
  app.add_option("--cases", s.cases, "What to measure: fit or contest")
      ->check(CLI::IsMember({"fit", "contest"}))
      ->capture_default_str();
  app.add_option("--data", c.data, "Folder of the real data")->default_str("$EIGENCRUST_DATA or ../shared/data");
  app.add_option("--work", c.work, "Folder for clouds, meshes and outcomes")->capture_default_str();
  app.add_option("--python", c.python, "Python that has Open3D")->capture_default_str();
  app.add_option("--table", c.table, "File for the table in Markdown [stdout]");
  app.add_option("--threads", c.threads, "0: all cores")->check(CLI::Range(0, 1024))->capture_default_str();
  add_fit_options(app, s);
  add_contest_options(app, c);
  return tools::run_command(app, argc, argv, [&] {
    if (s.cases == "fit" && c.step.empty())
      run_fits(s);
    else
      run_contests(c, itself.string());
  });
}
