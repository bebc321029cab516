// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/first_columns.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "io/column_names.h"

namespace eigencrust::io {
namespace {

using Columns = std::vector<std::vector<double>>;

constexpr std::size_t fewest_rows = 5; ///< fewer prove nothing

Columns read_columns(std::span<const TextLine> rows, const RowShape& shape) {
  Columns columns(shape.width);
  Fields fields;
  for (const TextLine& row : rows) {
    split_row(row.text, shape.format, fields);
    if (fields.size() < shape.width) continue;
    for (std::size_t k = 0; k < shape.width; ++k) {
      double value = 0;
      columns[k].push_back(parse_field(fields[k], shape.format, value) ? value
                                                                       : std::numeric_limits<double>::quiet_NaN());
    }
  }
  return columns;
}

bool all_whole(const std::vector<double>& column) {
  return std::all_of(column.begin(), column.end(), [](double v) { return v == std::floor(v); });
}

bool is_increasing(const std::vector<double>& column) {
  return std::adjacent_find(column.begin(), column.end(), [](double a, double b) { return !(a < b); }) == column.end();
}

std::string number(double value) {
  std::string text;
  append_number(text, value);
  return text;
}

bool counts_points(const Columns& columns, const RowShape& shape) {
  if (shape.width < 4 || columns[0].size() < fewest_rows) return false;
  const bool four_numbers = shape.numeric[0] && shape.numeric[1] && shape.numeric[2] && shape.numeric[3];
  return four_numbers && all_whole(columns[0]) && is_increasing(columns[0]);
}

/// "column 1 counts 1, 2, 3 ...": no surface has a point for each whole x and none between.
std::optional<ColumnDoubt> doubt_counter(const Columns& columns, const RowShape& shape) {
  if (!counts_points(columns, shape)) return std::nullopt;
  const std::vector<double>& first = columns[0];
  ColumnDoubt doubt;
  doubt.cause = "column 1 counts " + number(first[0]) + ", " + number(first[1]) + ", " + number(first[2]) +
                " ...: these are numbers of the points rather than their x";
  doubt.remedy = "say which columns are x, y and z: --columns id,x,y,z or, where they are, --columns x,y,z";
  // Number, coordinates, code: the order of the surveyors, and no other has words behind four numbers.
  const bool has_code =
      shape.width > 4 && std::find(shape.numeric.begin() + 4, shape.numeric.end(), false) != shape.numeric.end();
  if (has_code) doubt.names = {"id", "x", "y", "z"};
  return doubt;
}

/// Rows and columns of a grid before the coordinates: whole numbers, of which one counts within the other.
std::optional<ColumnDoubt> doubt_grid(const Columns& columns, const RowShape& shape) {
  if (shape.width < 5) return std::nullopt;
  for (std::size_t k = 0; k < 5; ++k) {
    const bool whole = all_whole(columns[k]);
    if (!shape.numeric[k] || whole != (k < 2)) return std::nullopt;
    if (k < 2 && std::any_of(columns[k].begin(), columns[k].end(), [](double v) { return v < 0; })) return std::nullopt;
  }
  // x y z and a unit normal, of points on whole coordinates.
  bool unit = shape.width >= 6;
  for (std::size_t i = 0; unit && i < columns[0].size(); ++i)
    unit = std::abs(std::hypot(columns[3][i], columns[4][i], columns[5][i]) - 1) < 0.01;
  if (unit) return std::nullopt;
  for (const std::size_t slow : {0u, 1u}) {
    const std::vector<double>&outer = columns[slow], &inner = columns[1 - slow];
    bool counts = true;
    for (std::size_t i = 1; counts && i < outer.size(); ++i)
      counts = outer[i] == outer[i - 1] ? inner[i] > inner[i - 1] : outer[i] > outer[i - 1];
    if (!counts) continue;
    ColumnDoubt doubt;
    doubt.cause = "columns 1 and 2 count " + number(columns[0][0]) + " " + number(columns[1][0]) + ", " +
                  number(columns[0][1]) + " " + number(columns[1][1]) +
                  " ...: these are rows and columns of a grid rather than x and y";
    const bool coloured = shape.width == 8 && all_whole(columns[5]) && all_whole(columns[6]) && all_whole(columns[7]);
    doubt.remedy = std::string("say which columns are x, y and z: --columns row,column,x,y,z") +
                   (coloured ? ",red,green,blue" : "") + " or, where they are, --columns x,y,z";
    return doubt;
  }
  return std::nullopt;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Heights: everywhere the numbers of a row are much nearer to their neighbours than to those in other places.
std::optional<ColumnDoubt> doubt_matrix(const Columns& columns, const RowShape& shape, std::uint64_t rows) {
  constexpr std::size_t fewest_columns = 10; // lists of points with so many nameless columns are rare
  constexpr double alike = 0.5;
  if (shape.width < fewest_columns ||
      std::find(shape.numeric.begin(), shape.numeric.end(), false) != shape.numeric.end())
    return std::nullopt;
  std::vector<double> far;
  std::vector<std::vector<double>> near(shape.width - 1);
  const std::size_t count = columns[0].size();
  for (std::size_t k = 0; k + 1 < shape.width; ++k)
    for (std::size_t i = 0; i < count; ++i) {
      // A place far off in both directions, another one for each.
      const double other = columns[(k + shape.width / 2 + i) % shape.width][(i + count / 2 + 7 * k) % count];
      const double step = std::abs(columns[k + 1][i] - columns[k][i]), jump = std::abs(other - columns[k][i]);
      if (!std::isfinite(step) || !std::isfinite(jump)) continue;
      near[k].push_back(step);
      far.push_back(jump);
    }
  if (far.empty()) return std::nullopt;
  const double limit = alike * median(far);
  const bool whole = all_whole(columns[0]);
  for (std::size_t k = 0; k + 1 < shape.width; ++k)
    if (near[k].empty() || !(median(near[k]) < limit) || all_whole(columns[k + 1]) != whole) return std::nullopt;
  const std::string across = std::to_string(shape.width), down = std::to_string(rows);
  return ColumnDoubt{"a matrix of " + across + " x " + down + " heights is no list of points",
                     "put the lines ncols " + across + ", nrows " + down +
                         ", xllcorner 0, yllcorner 0, cellsize 1 before it, with the size of its cells (an ESRI "
                         "grid); or, where the first columns are x, y and z, type --columns x,y,z",
                     {}};
}

/// Words first: "P1001 512359.0 5412345.0 345.0".
std::optional<ColumnDoubt> doubt_words(const RowShape& shape) {
  if (shape.numeric[0] && shape.numeric[1] && shape.numeric[2]) return std::nullopt;
  const auto word = std::find(shape.numeric.begin(), shape.numeric.end(), false) - shape.numeric.begin();
  return ColumnDoubt{"column " + std::to_string(word + 1) + " holds words, and nothing names the columns",
                     "say which are x, y and z: --columns " + columns_to_type({}, shape.numeric, 0),
                     {}};
}

} // namespace

bool first_column_counts(std::span<const TextLine> rows, const RowShape& shape) {
  return counts_points(read_columns(rows, shape), shape);
}

std::optional<ColumnDoubt> doubt_first_columns(std::span<const TextLine> rows, const RowShape& shape,
                                               std::uint64_t total) {
  if (shape.width < 3) return std::nullopt;
  if (auto doubt = doubt_words(shape)) return doubt;
  const Columns columns = read_columns(rows, shape);
  if (columns[0].size() < fewest_rows) return std::nullopt;
  if (auto doubt = doubt_counter(columns, shape)) return doubt;
  if (auto doubt = doubt_grid(columns, shape)) return doubt;
  return doubt_matrix(columns, shape, total);
}

} // namespace eigencrust::io
