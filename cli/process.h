// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The command as one process, or as the first of several.
#pragma once

#include <eigencrust/ranks.h>

namespace eigencrust::cli {

/// Freed arrays stay with the process. Stage after stage takes arrays of the same size, and fresh pages are slow
/// (docs/decisions/0022). All threads share them: what one frees another may need.
void keep_freed_memory();

/// All of the command: every error becomes a line and a status.
/// \param ranks that take over parts of the work; none: this process does all
/// \return the exit status
int run_process(int argc, char** argv, Ranks* ranks = nullptr);

} // namespace eigencrust::cli
