// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What the verbs that reconstruct share: their options, checks, the run and its report.
#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <optional>

#include <eigencrust/page.h>

#include "command.h"
#include "kept_tetrahedra.h"
#include "progress.h"

namespace eigencrust::cli {

/// What was said of one option of the library's table.
struct MethodValue {
  // Nothing: the preset's choice stays.
  std::optional<std::string> text;
  std::optional<std::uint32_t> count; ///< where the kind is count
  std::vector<std::string> points;    ///< where the kind is points
  bool flag = false;                  ///< where the kind is flag
};

/// What the command line said.
struct Request {
  InputOptions input;
  std::string output, format, report, progress = "auto", dump_stages;
  bool each = false;
  std::map<std::string, MethodValue, std::less<>> method; ///< by the option's name in the library's table
  std::vector<std::string> outside_files, inside_files;
  std::string temp_dir; ///< empty: nothing is kept
  bool resume = false;
  bool quiet = false;
  Ranks* ranks = nullptr; ///< see Arguments
};

/// -o, --format, --report, --each. \param what "Mesh to write (ply obj off stl glb 3mf)"
void add_output_options(OptionTable& app, Request& request, const std::string& what);
/// All that changes the labels or which pieces are kept.
void add_method_options(OptionTable& app, Request& request);
/// Smoothing of the mesh.
void add_smoothing_options(OptionTable& app, Request& request);
/// Threads, memory, progress, products, silence.
void add_run_options(OptionTable& app, Request& request);

/// \throws Error{usage}
Options effective_options(const Request& request);

enum class OutputKind { mesh, cloud };
/// Refuses what cannot end well before any work is done. \throws Error{usage}, Error{input} for what cannot be written
void check_outputs(const Request& request, OutputKind kind);

/// Calls `job` for the request or, with --each, for every input by itself: {} in the names of its results stands for
/// the input's name without folder and extension. A job that fails is told and does not stop the others.
/// \return the first status that is not 0. \throws Error{usage}, what cannot be written, or cancelled
int for_each_job(const Request& request, OutputKind kind, const std::function<int(const Request&)>& job);

/// One run from the first byte read to the last byte written.
class MethodRun {
 public:
  /// Checks the outputs, then reads. \param command the whole line, for the report. \throws Error
  MethodRun(const Request& request, std::vector<std::string> command, OutputKind kind);

  PointCloud cloud;
  Result result; ///< after reconstruct()
  /// Warns at once of what need not wait for the end.
  void reconstruct(const Options& options);
  /// Lets `write` prepare the output, notes what it said, adds the report, puts both in their places and prints the
  /// warnings. Whatever fails before, no file appears. \throws Error{cancelled}
  void finish(const std::function<WriteResult(OutputFiles&, const std::string&, const WriteOptions&)>& write);
  /// Where the summary goes: not where the result goes, nor among lines of JSON.
  [[nodiscard]] std::ostream& summary() const;
  /// Seconds and memory for the line of summary.
  [[nodiscard]] std::string cost() const;
  /// "  1,000 of 5,000 points kept by --crop\n"; empty: all.
  [[nodiscard]] std::string selection() const;
  /// 0, or the status of a broken guarantee, which is told.
  [[nodiscard]] int status() const;

 private:
  const Request& request_;
  std::vector<std::string> command_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::unique_ptr<Observer> observer_;
  std::unique_ptr<PageObserver> page_; ///< where the report is a page
  std::unique_ptr<KeptTetrahedra> kept_;
  ReadReport read_;
  std::vector<std::string> told_; ///< warnings printed before the work
  void warn_at_once(const std::string& text);
  void name_rows_of_files();
  bool goes_out_of_core(const Options& options);
};

} // namespace eigencrust::cli
