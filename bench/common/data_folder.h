// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Where the real data is, and writing results.
#pragma once

#include <string>

namespace eigencrust::bench {

/// $EIGENCRUST_DATA, else ../shared/data beside the source tree, where the tests look, too.
std::string default_data_folder();

/// $EIGENCRUST_FIELD, else ../shared/field beside the source tree: clouds of the kind that people bring.
std::string default_field_folder();

/// Writes `text` atomically; nothing when `path` is empty. \throws Error{input}
void write_text(const std::string& path, const std::string& text);

} // namespace eigencrust::bench
