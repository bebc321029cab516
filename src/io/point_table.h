// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Rows of numbers that become a point cloud: what the text formats of points share.
#pragma once

#include <array>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include <eigencrust/io.h>

#include "io/row_format.h"
#include "io/text.h"

namespace eigencrust::io {

/// Collects rows. Columns are named by layouts: x, y and z (any case) become the coordinates, "-" is
/// skipped, any other name is an attribute.
class PointTable {
 public:
  explicit PointTable(const RowFormat& format = {}) : format_(format) {}

  /// The fields of the rows that follow. Columns of an earlier layout with the same name go on.
  /// \throws Error{input} at the current line when x, y or z is missing or named twice
  void set_layout(const std::vector<std::string>& names, const LineScanner& lines);
  /// \throws Error{input} at the current line when a field is missing or surplus, or a coordinate no number. In
  /// other columns words are unknown values; finish() tells of them.
  void add_row(const Fields& fields, const LineScanner& lines);

  /// Takes the row added last away again: it turned out to be none.
  void drop_last_row();
  [[nodiscard]] const Vec3& last_point() const { return points_.back(); }

  [[nodiscard]] std::size_t rows() const { return points_.size(); }
  /// Number of fields of a row; 0 before the first layout.
  [[nodiscard]] std::size_t fields() const { return targets_.size(); }
  /// The points and attributes; colours, truth values and, if asked for, intensities are whole numbers where all
  /// values are such; all else is float64. Columns of words are left out, with a warning for each.
  PointCloud finish(bool integer_intensity, ReadNotes& notes);

 private:
  static constexpr std::size_t skipped = std::numeric_limits<std::size_t>::max();
  struct Column {
    std::string name;
    std::vector<double> values{};                                ///< may end early: the rest is missing
    std::size_t missing = 0, words = 0, truths = 0, colours = 0; ///< values that are no numbers, by their kind
    std::string missing_word{}, word{};                          ///< the first ones
    std::uint64_t word_line = 0;
  };

  double read_coordinate(std::string_view field, std::size_t i, const LineScanner& lines);
  double read_value(Column& column, std::string_view field, std::uint64_t line) const;
  static bool is_left_out(const Column& column, std::size_t rows, ReadNotes& notes);

  RowFormat format_;
  std::vector<std::size_t> targets_; ///< per field: 0..2 coordinate, 3 + column, or skipped
  std::vector<std::string> field_names_;
  std::vector<Vec3> points_;
  std::vector<Column> columns_;
  std::map<std::string, std::size_t> column_of_name_;
  std::size_t unknown_coordinates_ = 0;
  std::string unknown_word_;
};

/// Names from the options or, without any, `usual`; completed to `count` by column4, column5, ...
std::vector<std::string> complete_names(std::vector<std::string> names, std::size_t count);

/// Drops the empty field after a separator that ends the line, unless a column is left for it.
void drop_empty_end(Fields& fields, std::size_t expected);

/// \throws Error{input} when commas in the line may be decimal commas ("1,5 2,5 3,5")
void check_decimal_commas(const LineScanner& lines);

} // namespace eigencrust::io
