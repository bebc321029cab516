// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Tables without names whose first three columns are no coordinates.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/row_format.h"

namespace eigencrust::io {

/// Why the first three columns are no coordinates, and what to type instead.
struct ColumnDoubt {
  std::string cause, remedy;
  std::vector<std::string> names{}; ///< of the columns, where the rest of the row leaves one reading only
};

/// Does the first column count the points (whole numbers, each larger than the one before), with three more columns of
/// numbers behind it?
bool first_column_counts(std::span<const TextLine> rows, const RowShape& shape);

/// Looks at some rows of a table without names: do the first columns count the points, are they the rows and columns
/// of a scanner's grid, words, or is all of it a matrix of heights?
/// \param total rows of the whole file, for the message
std::optional<ColumnDoubt> doubt_first_columns(std::span<const TextLine> rows, const RowShape& shape,
                                               std::uint64_t total);

} // namespace eigencrust::io
