// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// eigencrust-quality: how near the meshes are to the truth, beside those of another program.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>

#include <eigencrust/error.h>

#include "command.h"
#include "data_folder.h"
#include "fit_cases.h"

namespace {

using namespace eigencrust;
using namespace eigencrust::bench;

constexpr const char* about =
    "Samples known shapes with noise, reconstructs them and measures the error; beside it that of Open3D's screened\n"
    "Poisson with normals oriented by the truth (Debian's python3-open3d; left out where it is not installed).\n"
    "Lengths are in spacings; distances are means, mesh to truth / truth to mesh, then the error of the normals.\n"
    "\n"
    "Example:\n"
    "  eigencrust-quality --cases fit --shapes horse,gear --sigma 0.5,1 --table fit.md";

struct Settings {
  std::string cases = "fit", data = default_data_folder(), work = "quality", table, shapes = "horse,armadillo,gear",
              sigma = "0,0.25,0.5,1,2", python = "/usr/bin/python3";
  std::size_t samples = 60'000;
  std::uint64_t seed = 1;
  unsigned threads = 0;
};

FitShape shape_named(const std::string& name) {
  const auto& shapes = fit_shapes();
  const auto found = std::find_if(shapes.begin(), shapes.end(), [&](const FitShape& s) { return s.name == name; });
  if (found != shapes.end()) return *found;
  std::string names;
  for (const FitShape& s : shapes) names += (names.empty() ? "" : ", ") + s.name;
  throw Error(ErrorKind::usage, "--shapes", "'" + name + "' is no shape", "use some of " + names);
}

void run(const Settings& s) {
  const FitBenchOptions options{s.data, s.work, s.python, s.samples, s.seed, s.threads};
  std::filesystem::create_directories(s.work);
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
      write_text(s.table, to_markdown(outcomes)); // a run that is stopped leaves what it has
    }
  }
  if (s.table.empty()) std::cout << to_markdown(outcomes);
}

} // namespace

int main(int argc, char** argv) {
  Settings s;
  CLI::App app(about, "eigencrust-quality");
  app.add_option("--cases", s.cases, "What to measure: fit")->check(CLI::IsMember({"fit"}))->capture_default_str();
  app.add_option("--shapes", s.shapes, "Of horse, armadillo, gear, angel, fandisk, cube")->capture_default_str();
  app.add_option("--sigma", s.sigma, "Standard deviations of the noise, in spacings")->capture_default_str();
  app.add_option("--samples", s.samples, "On each shape")->check(CLI::Range(100, 10'000'000))->capture_default_str();
  app.add_option("--seed", s.seed, "Of samples and noise")->capture_default_str();
  app.add_option("--data", s.data, "Folder of the real data")->default_str("$EIGENCRUST_DATA or ../shared/data");
  app.add_option("--work", s.work, "Folder for clouds and meshes")->capture_default_str();
  app.add_option("--python", s.python, "Python that has Open3D")->capture_default_str();
  app.add_option("--table", s.table, "File for the table in Markdown [stdout]");
  app.add_option("--threads", s.threads, "0: all cores")->check(CLI::Range(0, 1024))->capture_default_str();
  return tools::run_command(app, argc, argv, [&] { run(s); });
}
