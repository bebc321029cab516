// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What the verbs of the command share.
#pragma once

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <eigencrust/eigencrust.h>
#include <eigencrust/io.h>
#include <eigencrust/validate.h>

namespace eigencrust::cli {

/// Arguments after the verb, and the whole line for the report.
struct Arguments {
  std::vector<std::string> words, command;
};

// One function per verb. \return the exit status; errors are thrown
int reconstruct_verb(const Arguments& arguments);
int orient_verb(const Arguments& arguments);
int classify_verb(const Arguments& arguments);
int info_verb(const Arguments& arguments);
int check_verb(const Arguments& arguments);
int compare_verb(const Arguments& arguments);
int render_verb(const Arguments& arguments);
int demo_verb(const Arguments& arguments);

/// The outcome of parsing: go on, or end with this status (help was printed).
struct Parsed {
  bool done = false;
  int status = 0;
};
/// \throws Error{usage} with CLI11's explanation
Parsed parse(CLI::App& app, const Arguments& arguments);

/// Several inputs are several scans of one scene.
struct InputOptions {
  std::vector<std::string> paths;
  std::string columns, scan_index, sensors, pcd_viewpoint = "auto";
  std::vector<std::string> sensor, sensor_direction; ///< one per input
};
void add_input_options(CLI::App& app, InputOptions& options);
/// Reads and merges; fills files with path, hash and count. Sensors that the options name take the place of
/// those that the files hold.
/// \param notes if given, gets what each file's reader had to say
PointCloud read_inputs(const InputOptions& options, std::vector<InputFile>& files,
                       std::vector<std::vector<std::string>>* notes = nullptr);

/// Progress on stderr. `mode` is auto, bar, jsonl or off; auto shows a bar on a terminal.
std::unique_ptr<Observer> make_observer(const std::string& mode, const std::filesystem::path& dump_folder, bool quiet);
/// Takes the bar off the terminal before anything else is printed.
void clear_progress();

/// Ctrl-C asks the running stage to stop; a second one ends the program at once.
void catch_interrupts();
bool interrupted();

void print_warning(const std::string& text);
/// A few lines for people: counts, guarantees, size. An open mesh has rims, and neither a volume nor a side.
std::string describe(const MeshSummary& mesh);
/// The same with what the run knows of it.
std::string describe(const Report& report);
/// 12345678 -> 12,345,678
std::string grouped(std::uint64_t value);
/// Three or four digits that matter.
std::string rounded(double value);

} // namespace eigencrust::cli
