// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Options that went with the rules they set.
#pragma once

#include "command.h"

namespace eigencrust::cli {

/// \throws Error{usage} for the first of them, saying what replaced it
void reject_removed_options(const Arguments& arguments);

} // namespace eigencrust::cli
