// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Runs the command and CGAL on a cloud, in turn, each in a process of its own.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "speed_figures.h"

namespace eigencrust::bench {

struct SpeedRunnerOptions {
  std::filesystem::path program;   ///< the command `eigencrust`
  std::filesystem::path yardstick; ///< eigencrust-speed itself
  std::filesystem::path data, scratch;
  unsigned runs = 5;
  std::vector<unsigned> threads{1, 2};
};

/// What goes wrong with the cloud is in the outcome.
/// \param tell gets one line per finished process
SpeedOutcome time_cloud(const SpeedCase& item, const SpeedRunnerOptions& options,
                        const std::function<void(const std::string&)>& tell);

} // namespace eigencrust::bench
