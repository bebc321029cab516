// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Times as tables in Markdown.
#pragma once

#include <string>
#include <vector>

#include "speed_document.h"

namespace eigencrust::bench {

/// One table of the clouds, one of the stages, one of the growth.
std::string to_markdown(const std::vector<SpeedOutcome>& outcomes, const Machine& machine, unsigned runs);

} // namespace eigencrust::bench
