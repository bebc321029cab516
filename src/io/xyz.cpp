// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <memory>

#include "io/attributes.h"
#include "io/colours.h"
#include "io/formats.h"
#include "io/point_table.h"
#include "io/table_plan.h"
#include "io/text_output.h"
#include "surface/scalar.h"

namespace eigencrust::io {
namespace {

class RowReader {
 public:
  RowReader(const FileContent& file, const ReadOptions& options, bool lettered, ReadNotes& notes)
      : lines_(file),
        lettered_(lettered),
        notes_(notes),
        plan_(plan_table(file, options, lettered, notes)),
        table_(plan_.format) {}

  PointCloud read() {
    std::string_view row;
    while (next_text_line(lines_, row)) {
      if (lines_.number() < plan_.first_row || comment_text(row)) continue;
      if (lettered_ && !is_point_row(row)) continue;
      split_row(row, plan_.format, fields_);
      drop_empty_end(fields_, plan_.width);
      if (fields_.size() != plan_.width && plan_.has_blocks && begins_block(row)) continue;
      if (!plan_.header.empty() && row == plan_.header) continue; // tables put behind one another
      if (table_.fields() == 0) begin_table();
      if (plan_.format.separator == Separator::any) check_decimal_commas(lines_);
      table_.add_row(fields_, lines_);
    }
    check_count();
    PointCloud cloud = table_.finish(false, notes_);
    if (plan_.format.decimal_comma) notes_.notes.emplace_back("commas read as decimal points");
    if (!block_ends_.empty()) set_scans(cloud);
    return cloud;
  }

 private:
  /// A title or a count between rows.
  bool begins_block(std::string_view row) {
    std::uint64_t count = 0;
    if (!is_count(row, count) && !is_title(row, plan_)) return false;
    if (table_.rows() > (block_ends_.empty() ? 0 : block_ends_.back())) block_ends_.push_back(table_.rows());
    return true;
  }

  void begin_table() {
    if (!plan_.names.empty()) return table_.set_layout(plan_.names, lines_);
    if (fields_.size() < 3)
      lines_.fail("the row has " + plural(fields_.size(), "field") + ": a point needs three",
                  "give x, y and z in each row (a file that begins with the number of points is a .pts file)");
    table_.set_layout(complete_names({"x", "y", "z"}, fields_.size()), lines_);
  }

  void check_count() {
    const std::size_t rows = block_ends_.empty() ? table_.rows() : block_ends_.front();
    if (plan_.count && *plan_.count != rows)
      notes_.warnings.push_back("the file says " + plural(*plan_.count, "point") + " in its beginning, but " +
                                std::to_string(rows) + " follow: it may be cut off");
  }

  void set_scans(PointCloud& cloud) const {
    for (std::size_t scan = 0; scan < block_ends_.size(); ++scan)
      cloud.scan_index.resize(block_ends_[scan], static_cast<std::uint32_t>(scan));
    cloud.scan_index.resize(cloud.points.size(), static_cast<std::uint32_t>(block_ends_.size()));
    if (cloud.scan_index.back() == 0)
      cloud.scan_index.clear();
    else
      notes_.notes.push_back(std::to_string(cloud.scan_index.back() + 1) + " blocks of rows read as scans");
  }

  LineScanner lines_;
  bool lettered_;
  ReadNotes& notes_;
  TablePlan plan_;
  PointTable table_;
  Fields fields_;
  std::vector<std::size_t> block_ends_; ///< rows of the table up to each title or count between them
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

PointCloud read_xyz(const FileContent& file, const ReadOptions& options, ReadNotes& notes) {
  return RowReader(file, options, false, notes).read();
}

PointCloud read_lettered_xyz(const FileContent& file, const ReadOptions& options, ReadNotes& notes) {
  return RowReader(file, options, true, notes).read();
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
  // Colours in another form than viewers know are repeated in theirs; whose names they take gets a suffix.
  const auto found = find_colours(cloud.attributes);
  const auto colours = std::make_shared<const std::vector<Attribute>>(
      found && !found->plain ? found->attributes() : std::vector<Attribute>());
  for (const Attribute& colour : *colours) {
    columns.push_back(&colour);
    names += separator + unique(colour.name);
  }
  for (const Attribute& attribute : cloud.attributes) {
    if (attribute.is_list) {
      result.warnings.push_back("text has no room for the list attribute " + attribute.name);
      continue;
    }
    columns.push_back(&attribute);
    const bool is_taken = find_attribute(*colours, attribute.name) != nullptr;
    const std::string name = unique(field_name(attribute.name) + (is_taken ? "_original" : ""));
    if (name != attribute.name)
      result.warnings.push_back("attribute '" + attribute.name + "' is written as '" + name + "'");
    names += separator + name;
  }
  if (bare || !columns.empty()) head += names + '\n';
  return [&cloud, colours, columns, head, separator, as_float](std::ostream& out) {
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
