// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Options from a file: `--config FILE.toml`.
#pragma once

#include "command.h"

namespace eigencrust::cli {

/// The words with `--config FILE` replaced by the options that the file holds; those that the words name themselves
/// stay as they are. The file holds `option = value` lines of TOML: texts, numbers, true and false, arrays for options
/// that may be repeated; `input` and `output` are the names of the files. Options under [VERB] are for that verb,
/// others for all that know them. \throws Error{input} for what is no TOML, Error{usage} for options that the table
/// does not know
std::vector<std::string> with_config(const OptionTable& table, const std::vector<std::string>& words);

} // namespace eigencrust::cli
