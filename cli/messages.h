// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// All that is said on stderr: a line for people, or with --progress jsonl an object for programs.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace eigencrust::cli {

/// From here on each message is a line of JSON. docs/report.md
void speak_json();
[[nodiscard]] bool speaks_json();

/// Takes the bar off the terminal before anything else is printed.
void clear_progress();
/// \param line without its end; takes the place of the bar that was shown before
void show_progress(const std::string& line);

void print_warning(const std::string& text);
/// The line for people, whatever is spoken; allocates nothing.
void print_warning_of(const char* text);
/// Allocates nothing unless JSON is spoken, for there may be nothing left.
void print_error(const char* text);
/// The last line of a stream of JSON; nothing else.
void print_end(int status);
/// One object: `members` are the inside of its braces.
void print_json(std::string_view members);
/// A text between quotation marks; bytes that are no UTF-8 are replaced.
std::string json_text(std::string_view text);

} // namespace eigencrust::cli
