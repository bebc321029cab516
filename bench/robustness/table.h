// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Outcomes as a table in Markdown.
#pragma once

#include <string>
#include <vector>

#include "runner.h"

namespace eigencrust::bench {

/// One table per group of cases, the presets side by side in each cell. Holds nothing that depends on the
/// machine but the ratios of times.
/// \param selection the options that chose the cases, for the sentence on how to make the table again
std::string to_markdown(const std::vector<Outcome>& outcomes, const std::vector<Preset>& presets,
                        const std::string& selection);

} // namespace eigencrust::bench
