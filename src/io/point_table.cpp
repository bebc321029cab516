// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/point_table.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "io/attributes.h"
#include "io/colours.h"

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

/// Only hexadecimal digits, at most 13 of them: such numbers are exact.
bool parse_hexadecimal(std::string_view digits, double& value) {
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number, 16);
  if (error != std::errc() || end != digits.data() + digits.size() || digits.size() > 13) return false;
  value = static_cast<double>(number);
  return true;
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
                 "name the columns in order, for example --columns x,y,z,-,intensity");
}

double PointTable::read_coordinate(std::string_view field, std::size_t i, const LineScanner& lines) {
  double value = std::numeric_limits<double>::quiet_NaN();
  if (parse_field(field, format_, value)) return value;
  // A point must be known, so that a field left empty is a fault; but programs say in words that it is not.
  if (field.empty() || !is_missing(field))
    lines.fail(shown(field) + " in column " + std::to_string(i + 1) + " (" + field_names_[i] + ") is no number",
               "correct it, or say which columns hold the coordinates: --columns x,y,z, with - for those to skip");
  if (unknown_coordinates_++ == 0) unknown_word_ = shown(field);
  return value;
}

double PointTable::read_value(Column& column, std::string_view field, std::uint64_t line) const {
  double value = std::numeric_limits<double>::quiet_NaN();
  if (field.empty() || parse_field(field, format_, value)) return value;
  if (is_missing(field)) {
    if (column.missing++ == 0) column.missing_word = shown(field);
    return value;
  }
  if (field.size() > 2 && (field.starts_with("0x") || field.starts_with("0X")) &&
      parse_hexadecimal(field.substr(2), value))
    return value;
  if (field.size() == 7 && field.front() == '#' && parse_hexadecimal(field.substr(1), value)) {
    ++column.colours;
    return value;
  }
  if (equal_ignoring_case(field, "true") || equal_ignoring_case(field, "false")) {
    ++column.truths;
    return equal_ignoring_case(field, "true") ? 1 : 0;
  }
  if (column.words++ == 0) {
    column.word = shown(field);
    column.word_line = line;
  }
  return value;
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
    if (targets_[i] < 3) {
      point[targets_[i]] = read_coordinate(fields[i], i, lines);
      continue;
    }
    Column& column = columns_[targets_[i] - 3];
    if (column.values.size() < row) column.values.resize(row, std::numeric_limits<double>::quiet_NaN());
    column.values.push_back(read_value(column, fields[i], lines.number()));
  }
  points_.push_back({point[0], point[1], point[2]});
}

void PointTable::drop_last_row() {
  points_.pop_back();
  for (Column& column : columns_)
    if (column.values.size() > points_.size()) column.values.pop_back();
}

bool PointTable::is_left_out(const Column& column, std::size_t rows, ReadNotes& notes) {
  const std::string name = "column " + shown(column.name);
  if (column.missing > 0)
    notes.notes.push_back(name + ": " + plural(column.missing, "value") + " " + column.missing_word +
                          " read as not known");
  if (column.words == 0) return false;
  const std::string example = column.word + " (line " + std::to_string(column.word_line) + ") is no number";
  if (2 * column.words >= rows - std::min(rows, column.missing)) {
    notes.warnings.push_back(name + " left out: " + example);
    return true;
  }
  notes.warnings.push_back(name + ": " + plural(column.words, "value") + " read as not known: " + example);
  return false;
}

PointCloud PointTable::finish(bool integer_intensity, ReadNotes& notes) {
  PointCloud cloud;
  const std::size_t rows = points_.size();
  cloud.points = std::move(points_);
  if (unknown_coordinates_ > 0)
    notes.notes.push_back(plural(unknown_coordinates_, "coordinate") + " " + unknown_word_ + " read as not known");
  UniqueNames unique;
  for (const Column& column : columns_) unique(column.name);
  for (Column& column : columns_) {
    if (is_left_out(column, rows, notes)) continue;
    const std::size_t others = column.words + column.missing;
    ScalarType type = ScalarType::float64;
    if (is_colour(column.name) && all_integers(column.values, 0, 255)) type = ScalarType::uint8;
    if (column.truths > 0 && others == 0 && all_integers(column.values, 0, 1)) type = ScalarType::uint8;
    if (integer_intensity && column.name == "intensity" && all_integers(column.values, -2147483648.0, 2147483647.0))
      type = ScalarType::int32;
    column.values.resize(rows, std::numeric_limits<double>::quiet_NaN());
    if (column.colours > 0 && column.colours + others == rows) {
      notes.notes.push_back("column " + shown(column.name) + " read as colours #rrggbb");
      for (Attribute& channel : unpack_colours(column.values, false)) {
        channel.name = unique(channel.name);
        cloud.attributes.push_back(std::move(channel));
      }
    } else {
      cloud.attributes.push_back(make_attribute(column.name, type, column.values));
    }
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
