// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "io/formats.h"
#include "io/point_table.h"
#include "io/text.h"

namespace eigencrust::io {
namespace {

constexpr const char* wrong_count = "correct the count, or fetch the file again if it is cut off";

bool is_comment(std::string_view line) { return line.starts_with('#') || line.starts_with("//"); }

bool next_row(LineScanner& lines, Fields& fields) {
  while (lines.next_filled()) {
    if (is_comment(lines.line())) continue;
    split_fields(lines.line(), fields);
    return true;
  }
  return false;
}

bool is_count(const Fields& fields, std::uint64_t& count) {
  return fields.size() == 1 && !fields[0].empty() && is_digit(fields[0][0]) && parse(fields[0], count);
}

/// x y z [intensity] [red green blue]
std::vector<std::string> usual_names(std::size_t count) {
  std::vector<std::string> names = {"x", "y", "z"};
  if (count == 4 || count == 7) names.emplace_back("intensity");
  if (count == 6 || count == 7) names.insert(names.end(), {"red", "green", "blue"});
  return complete_names(std::move(names), count);
}

void set_layout(PointTable& table, const Fields& fields, const ReadOptions& options, const LineScanner& lines) {
  const std::size_t count = fields.size();
  if (count == table.fields()) return;
  const auto usual = [](std::size_t n) { return n == 3 || n == 4 || n == 6 || n == 7; };
  // Blocks may differ, but not arbitrarily: a column of one block is a column of all points.
  const bool may_change = options.columns.empty() && usual(count) && usual(table.fields());
  if (count < 3 || (table.fields() != 0 && !may_change))
    lines.fail("the row has " + plural(count, "field"), "write x y z [intensity] [red green blue]");
  table.set_layout(options.columns.empty() ? usual_names(count) : complete_names(options.columns, count), lines);
}

PointCloud read_blocks(const FileContent& file, const ReadOptions& options, ReadNotes& notes) {
  LineScanner lines(file);
  PointTable table;
  Fields fields;
  std::vector<std::uint32_t> scan_index;
  std::uint32_t scans = 0;
  while (next_row(lines, fields)) {
    std::uint64_t count = 0, unused = 0;
    if (!is_count(fields, count))
      lines.fail("a row where the number of points of the next scan is expected: the count before was too small",
                 wrong_count);
    for (std::uint64_t i = 0; i < count; ++i) {
      const bool there = next_row(lines, fields);
      if (!there || is_count(fields, unused))
        lines.fail("the count says " + plural(count, "point") + ", but only " + std::to_string(i) + " follow",
                   wrong_count);
      if (i == 0) set_layout(table, fields, options, lines);
      check_decimal_commas(lines);
      table.add_row(fields, lines);
    }
    scan_index.resize(table.rows(), scans++);
  }
  PointCloud cloud = table.finish(true, notes);
  if (scans > 1) cloud.scan_index = std::move(scan_index);
  return cloud;
}

} // namespace

PointCloud read_pts(const FileContent& file, const ReadOptions& options, ReadNotes& notes) {
  LineScanner lines(file);
  Fields fields;
  std::uint64_t count = 0;
  // Some .pts files are mere rows of coordinates without a count.
  if (next_row(lines, fields) && is_count(fields, count)) return read_blocks(file, options, notes);
  return read_lettered_xyz(file, options, notes);
}

} // namespace eigencrust::io
