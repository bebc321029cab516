// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The command as one process, or as the first of several.
#pragma once

#include <eigencrust/ranks.h>

namespace eigencrust::cli {

/// All of the command: every error becomes a line and a status.
/// \param ranks that take over parts of the work; none: this process does all
/// \return the exit status
int run_process(int argc, char** argv, Ranks* ranks = nullptr);

} // namespace eigencrust::cli
