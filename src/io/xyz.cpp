// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "io/attributes.h"
#include "io/formats.h"
#include "io/point_table.h"
#include "io/text_output.h"
#include "surface/scalar.h"

namespace eigencrust::io {
namespace {

/// The text behind the comment mark, or nothing.
std::optional<std::string_view> comment_text(std::string_view line) {
  if (line.starts_with("//")) return line.substr(2);
  if (!line.starts_with('#')) return std::nullopt;
  return line.substr(std::min(line.find_first_not_of('#'), line.size()));
}

bool names_axes(const std::vector<std::string>& names) {
  for (const char* axis : {"x", "y", "z"}) {
    bool found = false;
    for (const std::string& name : names) found = found || equal_ignoring_case(name, axis);
    if (!found) return false;
  }
  return true;
}

/// Takes the letter p off a row of Hoppe's format; false for its header rows.
bool is_point_row(std::string_view& row) {
  if (row.size() < 2 || !is_blank(row[1])) return true;
  if (row[0] == 'd' || row[0] == 's' || row[0] == 'g') return false;
  if (row[0] == 'p') row = trim(row.substr(1));
  return true;
}

/// Reads rows; keeps the header until the first row tells how many columns there are.
class RowReader {
 public:
  RowReader(const FileContent& file, const ReadOptions& options, bool lettered)
      : lines_(file), options_(options), lettered_(lettered) {}

  PointCloud read() {
    while (lines_.next_filled()) {
      std::string_view row = lines_.line();
      if (const auto comment = comment_text(row)) {
        if (table_.fields() == 0) keep_comment(*comment);
        continue;
      }
      if (lettered_ && !is_point_row(row)) continue;
      split_fields(row, fields_);
      if (table_.fields() == 0 && !begin_table()) continue;
      drop_empty_end(fields_, table_.fields());
      check_decimal_commas(lines_);
      table_.add_row(fields_, lines_);
    }
    if (table_.rows() == 0)
      lines_.file().fail("the file holds no points", "use a file with a row of numbers for each point");
    return table_.finish(false);
  }

 private:
  void keep_comment(std::string_view comment) {
    split_fields(comment, fields_);
    const std::vector<std::string> names(fields_.begin(), fields_.end());
    if (names_axes(names)) comment_names_ = names;
  }

  /// Does the row name things? Where columns are known, the one of x decides: others may hold words.
  [[nodiscard]] bool is_header() const {
    const auto names_x = [](const std::string& name) { return equal_ignoring_case(name, "x"); };
    const auto named = std::find_if(options_.columns.begin(), options_.columns.end(), names_x);
    const auto column = static_cast<std::size_t>(named - options_.columns.begin());
    const auto filled = std::find_if(fields_.begin(), fields_.end(), [](std::string_view f) { return !f.empty(); });
    if (filled == fields_.end()) return false;
    double number = 0;
    const bool known = named != options_.columns.end() && column < fields_.size();
    return !parse(known ? fields_[column] : *filled, number);
  }

  /// Names the columns at the first row; false when this is the header line.
  bool begin_table() {
    if (header_.empty() && is_header()) {
      header_.assign(fields_.begin(), fields_.end());
      header_line_ = lines_.number();
      return false;
    }
    drop_empty_end(fields_, header_.size()); // an empty last value is one where the header has a name for it
    if (!options_.columns.empty()) {
      table_.set_layout(complete_names(options_.columns, fields_.size()), lines_);
    } else if (!header_.empty()) {
      if (!names_axes(header_))
        lines_.file().fail_at_line(header_line_, "the header names no columns x, y and z",
                                   "name the columns in order, for example x,y,z,-,intensity");
      if (header_.back().empty() && header_.size() > fields_.size()) header_.pop_back();
      table_.set_layout(header_, lines_);
    } else if (comment_names_.size() == fields_.size()) {
      table_.set_layout(comment_names_, lines_);
    } else {
      if (fields_.size() < 3)
        lines_.fail("the row has " + plural(fields_.size(), "field") + ": a point needs three",
                    "give x, y and z in each row (a file that begins with the number of points is a .pts file)");
      table_.set_layout(complete_names({"x", "y", "z"}, fields_.size()), lines_);
    }
    return true;
  }

  LineScanner lines_;
  const ReadOptions& options_;
  bool lettered_;
  PointTable table_;
  Fields fields_;
  std::vector<std::string> header_, comment_names_;
  std::uint64_t header_line_ = 0;
};

void append_value(std::string& out, const Attribute& attribute, std::size_t row) {
  with_scalar(attribute.type, [&]<class T>(std::type_identity<T>) {
    const T value = load<T>(attribute.values.data(), row);
    if constexpr (std::is_integral_v<T>)
      append_number(out, static_cast<std::int64_t>(value));
    else
      append_number(out, value);
  });
}

/// A name that reads back as one field.
std::string field_name(const std::string& name) {
  std::string result;
  for (const char c : name)
    result += static_cast<unsigned char>(c) <= ' ' || c == ',' || c == ';' || c == '"' || c == '\x7f' ? '_' : c;
  return result.empty() || result == "-" ? "column" : result;
}

} // namespace

PointCloud read_xyz(const FileContent& file, const ReadOptions& options) {
  return RowReader(file, options, false).read();
}

PointCloud read_lettered_xyz(const FileContent& file, const ReadOptions& options) {
  return RowReader(file, options, true).read();
}

Body prepare_xyz(const PointCloud& cloud, const WriteOptions& options, char separator, WriteResult& result) {
  const bool as_float = options.coordinates == CoordinateType::float32;
  result.coordinates = as_float ? CoordinateType::float32 : CoordinateType::float64;
  // The header begins with a comment mark, except in a CSV, where every reader expects bare names.
  const bool bare = separator == ',';
  std::string head;
  if (!bare) append_comments(head, "# ", options.comments);
  std::vector<const Attribute*> columns;
  UniqueNames unique{"x", "y", "z", "X", "Y", "Z"};
  std::string names = std::string(bare ? "x" : "# x") + separator + "y" + separator + "z";
  for (const Attribute& attribute : cloud.attributes) {
    if (attribute.is_list) {
      result.warnings.push_back("text has no room for the list attribute " + attribute.name);
      continue;
    }
    columns.push_back(&attribute);
    const std::string name = unique(field_name(attribute.name));
    if (name != attribute.name)
      result.warnings.push_back("attribute '" + attribute.name + "' is written as '" + name + "'");
    names += separator + name;
  }
  if (bare || !columns.empty()) head += names + '\n';
  return [&cloud, columns, head, separator, as_float](std::ostream& out) {
    TextBuffer buffer(out);
    buffer.text() += head;
    for (std::size_t i = 0; i < cloud.points.size(); ++i) {
      append_point(buffer.text(), cloud.points[i], separator, as_float);
      for (const Attribute* column : columns) {
        buffer.text() += separator;
        append_value(buffer.text(), *column, i);
      }
      buffer.text() += '\n';
      buffer.flush_if_full();
    }
  };
}

} // namespace eigencrust::io
