// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Clouds and options by number: tiny, degenerate, cospherical, of huge and tiny scale, with every option.
#pragma once

#include <cstdint>
#include <string>

#include <eigencrust/options.h>
#include <eigencrust/types.h>

namespace eigencrust::fuzz {

struct RandomRun {
  PointCloud cloud;
  Options options;
  std::string shape; ///< for people
};

/// The same for the same seed on every machine, but for rounding in the mathematical library.
RandomRun random_run(std::uint64_t seed);

/// What the options are, in words of the command line where it has them.
std::string describe(const Options& options);

} // namespace eigencrust::fuzz
