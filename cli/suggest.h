// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What somebody who mistyped a word most likely meant.
#pragma once

#include <string>
#include <vector>

namespace eigencrust::cli {

/// The word that a slip or two of the finger make of `typed`, or that `typed` (three letters or more) begins; empty:
/// none is near. Upper and lower case count as the same.
std::string nearest_word(const std::string& typed, const std::vector<std::string>& words);

} // namespace eigencrust::cli
