// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The options of a verb as text: what --help, the man page and the completions are made of.
#pragma once

#include "command.h"

namespace eigencrust::cli {

/// What is said of one option.
struct OptionText {
  std::vector<std::string> names; ///< with their dashes, the short one first; for a positional one its name
  std::string value;              ///< what stands behind it: FILE, N, or {a,b,c}; empty: a flag
  std::vector<std::string> choices;
  std::string meaning; ///< with the default in brackets at the end
  std::string chapter;
  bool everyday = false, positional = false;
};
/// In the order in which they were declared.
std::vector<OptionText> option_texts(const OptionTable& table);

/// \param all every option by chapter, not only those of every day
std::string help_text(const OptionTable& table, bool all);

/// Lines of at most `width` columns, what follows the first one indented. A bracket at the end is not broken.
std::string wrapped(const std::string& text, std::size_t width, std::size_t indent);

} // namespace eigencrust::cli
