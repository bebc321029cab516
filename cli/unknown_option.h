// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What was meant by an option that a verb does not know.
#pragma once

#include <string>

namespace eigencrust::cli {

class OptionTable;

/// "did you mean --noise?", the verb that knows the option, or where all of them are listed.
std::string remedy_for_unknown(const OptionTable& table, const std::string& name);

/// The verb that has an option of that name; empty: none.
std::string verb_that_knows(const std::string& name);

} // namespace eigencrust::cli
