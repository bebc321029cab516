// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What the verbs that reconstruct share: their options, checks, the run and its report.
#pragma once

#include <chrono>
#include <optional>

#include "command.h"

namespace eigencrust::cli {

/// What the command line said; empty strings leave the preset's choice.
struct Request {
  InputOptions input;
  std::string output, report, progress = "auto", dump_stages;
  std::string preset = to_string(Preset::robust);
  std::string weights, second_stage, eigensolver, questionable, grid_spacing, noise, components, surface, smoothing,
      facade;
  bool manifold = Options{}.manifold; // on in both presets
  bool trim = Options{}.trim;
  std::optional<std::uint32_t> smooth;
  std::optional<double> tolerance;
  std::string crossing_depth;
  std::optional<std::uint32_t> max_steps;
  std::vector<std::string> outside_points, inside_points, outside_files, inside_files;
  unsigned threads = Options{}.threads;
  std::string max_memory;
  bool quiet = false;
};

/// All that changes the labels or which pieces are kept.
void add_method_options(CLI::App& app, Request& request);
/// Smoothing of the mesh.
void add_smoothing_options(CLI::App& app, Request& request);
/// Threads, report, progress, products, silence.
void add_run_options(CLI::App& app, Request& request);

/// \throws Error{usage}
Options effective_options(const Request& request);

enum class OutputKind { mesh, cloud };
/// Refuses what cannot end well before any work is done. \throws Error{usage}
void check_outputs(const Request& request, OutputKind kind);

/// One run from the first byte read to the last byte written.
class MethodRun {
 public:
  /// Checks the outputs, then reads. \throws Error
  MethodRun(const Request& request, const Arguments& arguments, OutputKind kind);

  PointCloud cloud;
  Result result; ///< after reconstruct()
  /// Warns at once of what need not wait for the end.
  void reconstruct(const Options& options);
  /// How the output is to be written. \throws Error{cancelled}
  [[nodiscard]] WriteOptions write_options() const;
  /// Notes what the writer said, writes the report and prints the warnings.
  void finish(const WriteResult& written);
  /// Seconds and memory for the line of summary.
  [[nodiscard]] std::string cost() const;
  /// 0, or the status of a broken guarantee, which is told.
  [[nodiscard]] int status() const;

 private:
  const Request& request_;
  const Arguments& arguments_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::unique_ptr<Observer> observer_;
  std::vector<InputFile> files_;
  std::vector<std::string> told_; ///< warnings printed before the work
  void warn_at_once(const std::string& text);
};

} // namespace eigencrust::cli
