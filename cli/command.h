// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What the verbs of the command share.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <eigencrust/eigencrust.h>
#include <eigencrust/io.h>
#include <eigencrust/ranks.h>
#include <eigencrust/validate.h>

#include "files.h"
#include "option_table.h"
#include "printable.h"
#include "signals.h"

namespace eigencrust::cli {

/// Arguments after the verb, and the whole line for the report.
struct Arguments {
  std::vector<std::string> words, command;
  /// If given, a verb hands its options to it and does nothing else.
  std::function<void(const OptionTable&)> describe{};
  Ranks* ranks = nullptr; ///< that take over parts of the work
};

// One function per verb. \return the exit status; errors are thrown
int reconstruct_verb(const Arguments& arguments);
int orient_verb(const Arguments& arguments);
int outliers_verb(const Arguments& arguments);
int info_verb(const Arguments& arguments);
int check_verb(const Arguments& arguments);
int compare_verb(const Arguments& arguments);
int render_verb(const Arguments& arguments);
int demo_verb(const Arguments& arguments);
int rerun_verb(const Arguments& arguments);
int completion_verb(const Arguments& arguments);
int man_verb(const Arguments& arguments);

/// The outcome of parsing: go on, or end with this status (help was printed).
struct Parsed {
  bool done = false;
  int status = 0;
  std::vector<std::string> command; ///< the whole line for the report, options from --config written out
};
/// Adds --help, --help-all and --config to what the verb declared. \throws Error{usage} saying what was meant, and
/// where an output would overwrite what is read
Parsed parse(OptionTable& app, const Arguments& arguments);

inline constexpr const char* help_chapter = "Help";

/// Several inputs are several scans of one scene.
struct InputOptions {
  std::vector<std::string> paths;
  std::string columns, scan_index, sensors, pcd_viewpoint = "auto", crop, thin;
  std::vector<std::string> sensor, sensor_direction; ///< one per input
  std::vector<std::string> unit, scale;              ///< one per input, or one for all
  std::string shift;
};
void add_input_options(OptionTable& app, InputOptions& options);
/// Unit, scale and shift of the inputs.
void add_frame_options(OptionTable& app, InputOptions& options);
/// \throws Error{usage}
double scale_of_input(const InputOptions& options, std::size_t input);
/// \throws Error{usage}
Vec3 shift_of_inputs(const InputOptions& options);
/// Length of "mm" and its like in metres. \throws Error{usage}
double parse_unit(const std::string& text);
/// Length of the result's unit in metres; 0: not known.
double metres_of_result(const InputOptions& options);
/// What was done to the coordinates, for the files that are written; empty: nothing but a shift.
std::vector<std::string> frame_comments(const InputOptions& options);

/// What read_inputs has to say beside the cloud.
struct ReadReport {
  std::vector<InputFile> files;      ///< with path, hash and count
  std::vector<ReadNotes> notes;      ///< what each file's reader had to say
  std::vector<Box3> bounds;          ///< of each file's finite points
  std::vector<std::string> together; ///< what is odd about several inputs
  std::vector<std::uint32_t> rows;   ///< of the files, one per point, where --crop or --thin left some out
  std::size_t rows_read = 0;
};
/// Reads and merges, then leaves out what --crop and --thin say. Sensors that the options name take the place of those
/// that the files hold. \param progress gets the fraction done
PointCloud read_inputs(const InputOptions& options, ReadReport& report,
                       const std::function<void(double)>& progress = {});

/// A few lines for people: counts, guarantees, size. An open mesh has rims, and neither a volume nor a side.
std::string describe(const MeshSummary& mesh);
/// The same with what the run knows of it.
std::string describe(const Report& report);
/// 12345678 -> 12,345,678
std::string grouped(std::uint64_t value);
/// Three or four digits that matter.
std::string rounded(double value);
/// (x, y, z) with the digits that tell such a point from others `extent` away.
std::string show_point(const Vec3& point, double extent);

} // namespace eigencrust::cli
