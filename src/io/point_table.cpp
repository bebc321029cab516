// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/point_table.h"

#include <algorithm>
#include <cmath>

#include <eigencrust/io.h>

#include "io/attributes.h"

namespace eigencrust::io {
namespace {

constexpr std::array<std::string_view, 3> axis_names = {"x", "y", "z"};

bool is_colour(const std::string& name) {
  const std::string lower = lower_case(name);
  for (const char* colour : {"red", "green", "blue", "r", "g", "b"})
    if (lower == colour) return true;
  return false;
}

/// NaN stands for a missing value here.
bool all_integers(const std::vector<double>& values, double lowest, double largest) {
  return std::all_of(values.begin(), values.end(),
                     [&](double v) { return std::isnan(v) || (v >= lowest && v <= largest && v == std::floor(v)); });
}

} // namespace

void PointTable::set_layout(const std::vector<std::string>& names, const LineScanner& lines) {
  targets_.clear();
  field_names_ = names;
  std::array<int, 3> found{};
  UniqueNames unique;
  for (const std::string& name : names) {
    const auto axis = std::find_if(axis_names.begin(), axis_names.end(),
                                   [&](std::string_view a) { return equal_ignoring_case(a, name); });
    if (axis != axis_names.end()) {
      const auto k = static_cast<std::size_t>(axis - axis_names.begin());
      ++found[k];
      targets_.push_back(k);
    } else if (name == "-") {
      targets_.push_back(skipped);
    } else {
      const std::string column_name = unique(name.empty() ? "column" + std::to_string(targets_.size() + 1) : name);
      const auto [column, is_new] = column_of_name_.try_emplace(column_name, columns_.size());
      targets_.push_back(3 + column->second);
      if (is_new) columns_.push_back({column_name, {}});
    }
  }
  for (std::size_t k = 0; k < 3; ++k)
    if (found[k] != 1)
      lines.fail((found[k] == 0 ? "no column is named " : "more than one column is named ") + shown(axis_names[k]),
                 "name the columns in order, for example x,y,z,-,intensity");
}

void PointTable::add_row(const Fields& fields, const LineScanner& lines) {
  if (fields.size() != targets_.size())
    lines.fail(
        "the row has " + plural(fields.size(), "field") + " where " + std::to_string(targets_.size()) + " are expected",
        "correct the row; the first row or the header says how many fields there are");
  const std::size_t row = points_.size();
  std::array<double, 3> point{};
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (targets_[i] == skipped) continue;
    double value = std::numeric_limits<double>::quiet_NaN();
    const bool is_coordinate = targets_[i] < 3;
    // An empty field of a table is an unknown value; a point must be known.
    if (!(fields[i].empty() && !is_coordinate) && !parse(fields[i], value))
      lines.fail(shown(fields[i]) + " in column " + std::to_string(i + 1) + " (" + field_names_[i] + ") is no number",
                 "correct it, or skip the column by naming it '-'");
    if (is_coordinate) {
      point[targets_[i]] = value;
    } else {
      std::vector<double>& values = columns_[targets_[i] - 3].values;
      if (values.size() < row) values.resize(row, std::numeric_limits<double>::quiet_NaN());
      values.push_back(value);
    }
  }
  points_.push_back({point[0], point[1], point[2]});
}

void PointTable::drop_last_row() {
  points_.pop_back();
  for (Column& column : columns_)
    if (column.values.size() > points_.size()) column.values.pop_back();
}

PointCloud PointTable::finish(bool integer_intensity) {
  PointCloud cloud;
  const std::size_t rows = points_.size();
  cloud.points = std::move(points_);
  for (Column& column : columns_) {
    ScalarType type = ScalarType::float64;
    if (is_colour(column.name) && all_integers(column.values, 0, 255)) type = ScalarType::uint8;
    if (integer_intensity && column.name == "intensity" && all_integers(column.values, -2147483648.0, 2147483647.0))
      type = ScalarType::int32;
    column.values.resize(rows, std::numeric_limits<double>::quiet_NaN());
    cloud.attributes.push_back(make_attribute(column.name, type, column.values));
    column.values = {};
  }
  return cloud;
}

std::vector<std::string> complete_names(std::vector<std::string> names, std::size_t count) {
  while (names.size() < count) names.push_back("column" + std::to_string(names.size() + 1));
  return names;
}

void drop_empty_end(Fields& fields, std::size_t expected) {
  if (fields.size() > 1 && fields.back().empty() && fields.size() != expected) fields.pop_back();
}

void check_decimal_commas(const LineScanner& lines) {
  const std::string_view line = lines.line();
  std::size_t comma = line.find(',');
  if (comma == std::string_view::npos || line.find('.') != std::string_view::npos) return;
  bool between_digits = false, other_separator = false;
  for (; comma != std::string_view::npos; comma = line.find(',', comma + 1))
    between_digits = between_digits ||
                     (comma > 0 && comma + 1 < line.size() && is_digit(line[comma - 1]) && is_digit(line[comma + 1]));
  char last = ','; // the character before the blanks
  for (std::size_t i = 0; i < line.size(); ++i) {
    const bool after_blank = i > 0 && is_blank(line[i - 1]);
    if (is_blank(line[i])) continue;
    if (line[i] == ';' || (after_blank && last != ',' && line[i] != ',')) other_separator = true;
    last = line[i];
  }
  if (between_digits && other_separator)
    lines.fail("the commas may separate columns or decimals", "write decimal points, and one separator only");
}

} // namespace eigencrust::io
