// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Outcomes as one page, in Markdown for the documentation and in HTML with every picture inside.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "contest_runner.h"

namespace eigencrust::bench {

struct PageFiles {
  std::filesystem::path work;     ///< where the pictures are
  std::filesystem::path pictures; ///< folder to copy those into that the Markdown shows; empty: it shows none
};

/// Holds nothing that depends on the machine but ratios of times and of memory.
std::string contest_markdown(const std::vector<ContestOutcome>& outcomes, const PageFiles& files);
std::string contest_html(const std::vector<ContestOutcome>& outcomes, const PageFiles& files);

} // namespace eigencrust::bench
