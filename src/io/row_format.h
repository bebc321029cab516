// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// How the rows of a text file are split into fields, and which fields are numbers.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "io/text.h"

namespace eigencrust::io {

enum class Separator : std::uint8_t {
  any, ///< blanks, commas and semicolons alike
  tab, ///< so that fields may hold blanks
  semicolon,
  comma,
  blanks,     ///< runs of blanks and tabs
  wide_blanks ///< tabs, and runs of two blanks or more: "x    T (K)"
};

struct RowFormat {
  Separator separator = Separator::any;
  bool decimal_comma = false; ///< 1,5 is one and a half
};

/// The next line that is not blank, without its end. Blanks at both ends go; tabs there may stand for empty fields.
bool next_text_line(LineScanner& lines, std::string_view& text);

/// Splits into trimmed fields without their quotes. `fields` is a buffer to be used again.
void split_row(std::string_view text, const RowFormat& format, Fields& fields);

/// Reads all of the field, also "1,5" where the format says so.
bool parse_field(std::string_view field, const RowFormat& format, double& value);

/// What programs write where there is no value: nothing, -, NULL, N/A, 1.#QNAN ...
bool is_missing(std::string_view field);

/// A line of the beginning of a file.
struct TextLine {
  std::uint64_t number = 0;
  std::string_view text;
};

/// The rows of a table, as most of its first lines are.
struct RowShape {
  RowFormat format;
  std::size_t width = 0;     ///< fields of a row; 0: none of the formats makes rows of three numbers
  std::vector<bool> numeric; ///< columns that hold numbers in most rows
};

/// The format that finds the most columns of numbers in the lines.
/// \param needed columns that have to be numbers; empty: any three
RowShape find_row_shape(std::span<const TextLine> lines, std::span<const std::size_t> needed);

} // namespace eigencrust::io
