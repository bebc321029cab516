// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Runs cases through presets.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <eigencrust/options.h>
#include <eigencrust/report.h>

#include "cases.h"
#include "figures.h"

namespace eigencrust::bench {

struct Run {
  Preset preset = Preset::robust;
  Report report;
  Figures figures;
  std::vector<std::string> missed; ///< requirements that are not met; empty: all are
  std::string error;               ///< what was thrown; empty: nothing
  std::string excused;             ///< the words that did instead of the requirements; empty: none were needed

  [[nodiscard]] bool good() const { return !excused.empty() || (error.empty() && missed.empty()); }
  /// Seconds of that stage; 0 when it was not run.
  [[nodiscard]] double stage_seconds(const std::string& stage) const;
  /// Seconds of the whole run per second of its Delaunay stage, a figure that hardly depends on the machine.
  [[nodiscard]] double time_ratio() const;
};

struct Outcome {
  Case item;
  std::string skipped; ///< why; empty: it was run
  std::size_t points = 0, true_samples = 0;
  double spacing = 0;
  std::uint64_t fingerprint = 0; ///< of the points
  std::uint32_t true_components = 1;
  std::int64_t true_genus = 0;
  std::vector<Run> runs; ///< one per preset
};

struct RunnerOptions {
  std::vector<Preset> presets{Preset::robust};
  SurfaceKind surface = SurfaceKind::samples; ///< what is kept of the samples is what the table is about
  std::filesystem::path meshes, pictures;     ///< folders; empty: not kept
};

/// Runs one case. What goes wrong is in the outcome, nothing is thrown.
/// \param progress told of each run as soon as it is done
Outcome run_case(const Case& item, Sources& sources, const RunnerOptions& options,
                 const std::function<void(const Outcome&, const Run&)>& progress);

} // namespace eigencrust::bench
