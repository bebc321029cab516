// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What the first lines of a file of rows say about all of it: separator, header, counts, titles.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <eigencrust/io.h>

#include "io/row_format.h"

namespace eigencrust::io {

struct TablePlan {
  RowFormat format;
  std::size_t width = 0;            ///< fields of a row; 0: the first row tells
  std::vector<std::string> names{}; ///< of the fields, with x, y and z among them; empty: the first row is x y z ...
  std::uint64_t first_row = 1;      ///< line; what stands before it has been understood
  std::string_view header{};        ///< that line, for it may come again
  bool has_blocks = false;          ///< titles or counts may stand between rows: they begin a new scan
  std::optional<std::uint64_t> count{}; ///< of the rows (of the first block), as the file says
};

/// Lines that begin with # or //, or with % as COMSOL and Matlab write. \return the text behind the mark
std::optional<std::string_view> comment_text(std::string_view line);

/// Takes the letter p off a row of Hoppe's format; false for its header rows.
bool is_point_row(std::string_view& row);

/// A line that holds the number of rows that follow it.
bool is_count(std::string_view text, std::uint64_t& count);
/// A title of a block: words, and not as many as a row has fields.
bool is_title(std::string_view text, const TablePlan& plan);

/// \param lettered rows may begin with p, as in Hoppe's format
/// \throws Error{input} where the columns of x, y and z cannot be told; names the option and the words to type
TablePlan plan_table(const FileContent& file, const ReadOptions& options, bool lettered, ReadNotes& notes);

} // namespace eigencrust::io
