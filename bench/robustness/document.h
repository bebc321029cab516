// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Outcomes as JSON: every figure, seed, option and time.
#pragma once

#include <string>
#include <vector>

#include "runner.h"

namespace eigencrust::bench {

/// JSON, schema 1, indented by two blanks. `command` is what was typed after the program's name.
std::string to_json(const std::vector<Outcome>& outcomes, const std::vector<std::string>& command);

} // namespace eigencrust::bench
