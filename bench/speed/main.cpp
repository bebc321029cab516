// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// eigencrust-speed: time and memory of the command against CGAL's Delaunay triangulation.
#include <stdlib.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <system_error>
#include <thread>

#include <eigencrust/error.h>

#include "cgal_triangulation.h"
#include "command.h"
#include "data_folder.h"
#include "memory_bandwidth.h"
#include "speed_runner.h"
#include "speed_table.h"

namespace {

using namespace eigencrust;
using namespace eigencrust::bench;
namespace fs = std::filesystem;

constexpr const char* text_about =
    "Times the command with default options, each stage and the whole, against CGAL's sequential Delaunay\n"
    "triangulation of the same points in the same run. Every measurement is a process of its own.\n"
    "\n"
    "Examples:\n"
    "  eigencrust-speed --clouds bunny --runs 3\n"
    "  eigencrust-speed --json speed.json --table speed.md";

struct Settings {
  std::string data = default_data_folder(), program, json, table, cgal_only;
  std::vector<std::string> clouds, generate_only;
  std::vector<std::size_t> sizes{10'000, 100'000, 1'000'000, 4'000'000};
  std::vector<unsigned> threads{1, 2};
  unsigned runs = 5;
};

/// A fresh temporary folder, removed with all it holds.
class Scratch {
 public:
  Scratch() {
    std::string name = (fs::temp_directory_path() / "eigencrust-speed-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::system_error(errno, std::generic_category(), name);
    path_ = name;
  }
  ~Scratch() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  [[nodiscard]] const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

fs::path own_program() { return fs::read_symlink("/proc/self/exe"); }

/// The command to be timed. \throws Error{usage}
fs::path program_of(const Settings& s) {
  fs::path program = s.program.empty() ? own_program().parent_path() / "eigencrust" : fs::absolute(s.program);
  if (!fs::is_regular_file(program))
    throw Error(ErrorKind::usage, program, "the command to be timed is not there",
                "build it or name it with --program");
  return program;
}

std::string processor() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.starts_with("model name")) return line.substr(std::min(line.find(':') + 2, line.size()));
  return "unknown processor";
}

Machine describe_machine(const Settings& s) {
  Machine machine{processor(), std::thread::hardware_concurrency(), {}};
  for (const unsigned threads : s.threads) machine.bandwidth.emplace_back(threads, triad_bandwidth(threads));
  return machine;
}

void run(const Settings& s, const std::vector<std::string>& command) {
  const std::vector<SpeedCase> cases = speed_cases(s.sizes, s.clouds);
  const Scratch scratch;
  const SpeedRunnerOptions options{program_of(s), own_program(), s.data, scratch.path(), s.runs, s.threads};
  const Machine machine = describe_machine(s);
  std::vector<SpeedOutcome> outcomes;
  std::size_t failed = 0;
  for (const SpeedCase& c : cases) {
    outcomes.push_back(time_cloud(c, options, [](const std::string& line) { std::cerr << line << std::endl; }));
    const SpeedOutcome& outcome = outcomes.back();
    if (!outcome.skipped.empty()) std::cerr << c.name << " skipped: " << outcome.skipped << std::endl;
    if (!outcome.error.empty()) std::cerr << c.name << " failed: " << outcome.error << std::endl;
    failed += !outcome.error.empty();
    // After every cloud, so that a run that is stopped leaves what it has.
    write_text(s.json, to_json(outcomes, machine, s.runs, command));
    write_text(s.table, to_markdown(outcomes, machine, s.runs));
  }
  if (s.table.empty() && s.json.empty()) std::cout << to_markdown(outcomes, machine, s.runs);
  if (failed > 0)
    throw Error(ErrorKind::guarantee, "clouds", std::to_string(failed) + " failed", "see the messages above");
}

void generate(const std::vector<std::string>& words) {
  write_noisy_sphere(static_cast<std::size_t>(std::stoull(words[0])), words[1]);
}

} // namespace

int main(int argc, char** argv) {
  Settings s;
  CLI::App app(text_about, "eigencrust-speed");
  app.add_option("--data", s.data, "Folder of the real data; clouds that are not there are skipped")
      ->default_str("$EIGENCRUST_DATA or ../shared/data");
  app.add_option("--clouds", s.clouds,
                 "Clouds whose name contains this text; several, or a comma list: bunny, dragon, "
                 "happy, sphere, sphere-SIZE [all]")
      ->allow_extra_args(false);
  app.add_option("--sizes", s.sizes, "Points of the generated noisy bumpy spheres, a comma list")
      ->delimiter(',')
      ->check(CLI::Range(100, 100'000'000))
      ->capture_default_str();
  app.add_option("--runs", s.runs, "Runs of each; medians are shown")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option("--threads", s.threads, "Numbers of threads of the command, a comma list")
      ->delimiter(',')
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  app.add_option("--program", s.program, "The command to be timed [eigencrust beside this program]");
  app.add_option("--json", s.json, "File for every time");
  app.add_option("--table", s.table, "File for the tables in Markdown; without any file they go to stdout");
  // What this program calls itself with: CGAL's memory and the generator's must be seen apart.
  app.add_option("--cgal-only", s.cgal_only, "Only triangulate this cloud with CGAL, print the time")->group("");
  app.add_option("--generate-only", s.generate_only, "Only write a sphere: points, file")->expected(2)->group("");
  const std::vector<std::string> command(argv + 1, argv + argc);
  return tools::run_command(app, argc, argv, [&] {
    if (!s.cgal_only.empty())
      std::cout << time_cgal(s.cgal_only) << "\n";
    else if (!s.generate_only.empty())
      generate(s.generate_only);
    else
      run(s, command);
  });
}
