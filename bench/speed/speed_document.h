// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Times as JSON.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "speed_figures.h"

namespace eigencrust::bench {

/// The machine that measured.
struct Machine {
  std::string processor;
  unsigned processors = 0;
  std::vector<std::pair<unsigned, double>> bandwidth; ///< threads, bytes per second of the triad
};

/// JSON, schema 1, indented by two blanks: every single time, medians and ratios. `command` is what was typed
/// after the program's name.
std::string to_json(const std::vector<SpeedOutcome>& outcomes, const Machine& machine, unsigned runs,
                    const std::vector<std::string>& command);

} // namespace eigencrust::bench
