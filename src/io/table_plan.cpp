// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/table_plan.h"

#include <algorithm>

#include "io/column_names.h"
#include "io/first_columns.h"
#include "io/point_table.h"

namespace eigencrust::io {
namespace {

// What is looked at before anything is decided.
constexpr std::size_t most_lines = 500;
constexpr std::size_t most_bytes = 1 << 20; ///< of very long lines

struct Beginning {
  std::vector<TextLine> comments, lines;
};

Beginning read_beginning(const FileContent& file, bool lettered) {
  Beginning beginning;
  LineScanner lines(file);
  std::string_view text;
  while (beginning.lines.size() < most_lines && (lines.offset() < most_bytes || beginning.lines.size() < 3) &&
         next_text_line(lines, text)) {
    if (const auto comment = comment_text(text)) {
      if (beginning.comments.size() < most_lines) beginning.comments.push_back({lines.number(), *comment});
      continue;
    }
    if (lettered && !is_point_row(text)) continue;
    beginning.lines.push_back({lines.number(), text});
  }
  return beginning;
}

std::uint64_t count_rows(const FileContent& file, std::uint64_t first_row) {
  LineScanner lines(file);
  std::string_view text;
  std::uint64_t rows = 0;
  while (next_text_line(lines, text)) rows += lines.number() >= first_row && !comment_text(text) ? 1 : 0;
  return rows;
}

bool has_extension(const FileContent& file, std::string_view extension) {
  return equal_ignoring_case(std::filesystem::path(file.name()).extension().string(), extension);
}

bool is_axis(const std::string& name, char axis) { return equal_ignoring_case(name, std::string(1, axis)); }

/// Columns that --columns names x, y and z.
std::vector<std::size_t> named_axes(const std::vector<std::string>& columns) {
  std::vector<std::size_t> axes;
  for (std::size_t i = 0; i < columns.size(); ++i)
    for (const char axis : {'x', 'y', 'z'})
      if (is_axis(columns[i], axis)) axes.push_back(i);
  return axes;
}

/// As many names as there are columns, by whichever separator makes them; empty where none does.
std::vector<std::string> split_names(std::string_view text, const TablePlan& plan) {
  Fields fields;
  for (const Separator separator : {plan.format.separator, Separator::tab, Separator::semicolon, Separator::comma,
                                    Separator::wide_blanks, Separator::blanks, Separator::any}) {
    split_row(text, {separator, false}, fields);
    if (fields.size() > 1 && fields.back().empty() && fields.size() == plan.width + 1) fields.pop_back();
    if (fields.size() == plan.width) return {fields.begin(), fields.end()};
  }
  return {};
}

class Planner {
 public:
  Planner(const FileContent& file, const ReadOptions& options, bool lettered, ReadNotes& notes)
      : file_(file), options_(options), notes_(notes), beginning_(read_beginning(file, lettered)) {}

  TablePlan plan() {
    const std::vector<std::size_t> axes = named_axes(options_.columns);
    shape_ = find_row_shape(beginning_.lines, axes);
    plan_.format = shape_.format;
    plan_.width = shape_.width;
    key_columns_ = axes;
    for (std::size_t k = 0; k < shape_.width && key_columns_.size() < 3; ++k)
      if (shape_.numeric[k]) key_columns_.push_back(k);
    if (plan_.width == 0) guess_width();
    read_preface();
    choose_names();
    return std::move(plan_);
  }

 private:
  /// No separator makes rows of numbers: the rows themselves will tell what is wrong.
  void guess_width() {
    Fields fields;
    for (const TextLine& line : beginning_.lines) {
      split_row(line.text, plan_.format, fields);
      double number = 0;
      if (!fields.empty() && parse(fields[0], number) && fields.size() > 1) break;
    }
    shape_.width = plan_.width = fields.size();
    shape_.numeric.assign(plan_.width, true);
    if (key_columns_.empty()) key_columns_ = {0};
  }

  /// A row has a number in one of the columns that matter.
  [[nodiscard]] bool is_row(std::string_view text) {
    split_row(text, plan_.format, fields_);
    drop_empty_end(fields_, plan_.width);
    if (fields_.size() != plan_.width) return false;
    double number = 0;
    return std::any_of(key_columns_.begin(), key_columns_.end(), [&](std::size_t k) {
      return k < fields_.size() && parse_field(fields_[k], plan_.format, number);
    });
  }

  /// Goes through the lines before the first row.
  void read_preface() {
    std::uint64_t unknown_from = 0, unknown_to = 0;
    bool found = false;
    for (const TextLine& line : beginning_.lines) {
      plan_.first_row = line.number;
      // "8 3 0 0" of a .node file has as many fields as the rows behind it.
      const bool is_first_node = line.number == beginning_.lines.front().number && has_extension(file_, ".node");
      const bool has_counts = is_first_node && take_counts(line.text);
      found = !has_counts && is_row(line.text);
      if (found) break;
      std::uint64_t count = 0;
      if (is_count(line.text, count)) {
        plan_.count = count;
        plan_.has_blocks = true;
      } else if (has_counts || take_counts(line.text)) {
        known_preface_ = true;
      } else if (is_header(line)) {
        continue;
      } else {
        if (unknown_from == 0) unknown_from = line.number;
        unknown_to = line.number;
        plan_.has_blocks = true;
      }
    }
    if (!found) file_.fail("the file holds no points", "use a file with a row of numbers for each point");
    if (unknown_from > 0)
      notes_.notes.push_back((unknown_from == unknown_to
                                  ? "line " + std::to_string(unknown_from)
                                  : "lines " + std::to_string(unknown_from) + " to " + std::to_string(unknown_to)) +
                             " before the first row left out");
  }

  bool is_header(const TextLine& line) {
    std::vector<std::string> names = split_names(line.text, plan_);
    double number = 0;
    if (names.empty()) { // perhaps names, but not as many as there are columns
      split_fields(line.text, fields_);
      const std::vector<std::string> words(fields_.begin(), fields_.end());
      if (find_axes(words)) misnamed_ = {line.number, words.size()};
      return false;
    }
    if (header_line_ > 0 || parse(names[0], number)) return false;
    header_ = std::move(names);
    header_line_ = line.number;
    plan_.header = line.text;
    return true;
  }

  /// Numbers that some programs write before the rows: those of TetGen's nodes and of MSMS's vertices.
  bool take_counts(std::string_view text) {
    Fields fields;
    split_fields(text, fields);
    std::array<double, 4> n{};
    if (fields.size() != 4 || plan_.width < 4) return false;
    for (std::size_t k = 0; k < 4; ++k)
      if (!parse(fields[k], n[k]) || n[k] < 0) return false;
    const bool is_msms = std::any_of(beginning_.comments.begin(), beginning_.comments.end(),
                                     [](const TextLine& c) { return c.text.find("MSMS") != std::string_view::npos; });
    if (n[1] == 3 && n[0] == std::floor(n[0]) && 4 + n[2] + n[3] == static_cast<double>(plan_.width)) {
      known_names_ = {"id", "x", "y", "z"};
      for (int k = 1; k <= static_cast<int>(n[2]); ++k) known_names_.push_back("attribute" + std::to_string(k));
      if (n[3] > 0) known_names_.emplace_back("marker");
      notes_.notes.emplace_back("read as nodes of TetGen");
    } else if (is_msms && plan_.width >= 9) {
      known_names_ = complete_names({"x", "y", "z", "nx", "ny", "nz", "face", "sphere", "type"}, plan_.width);
      notes_.notes.emplace_back("read as vertices of MSMS");
    } else {
      return false;
    }
    plan_.count = static_cast<std::uint64_t>(std::min(n[0], 1e18));
    return true;
  }

  void choose_names() {
    if (!options_.columns.empty()) {
      plan_.names = complete_names(options_.columns, plan_.width);
      doubt_given_columns();
      return;
    }
    if (known_preface_ && header_.empty()) {
      plan_.names = known_names_;
      return;
    }
    if (!header_.empty()) {
      if (!use_names(header_)) fail_header();
      return;
    }
    if (misnamed_.first > 0)
      file_.fail_at_line(misnamed_.first,
                         "the header names " + plural(misnamed_.second, "column") + ", but the rows have " +
                             std::to_string(plan_.width),
                         "say what the columns are: --columns " + columns_to_type({}, shape_.numeric, 0));
    for (auto comment = beginning_.comments.rbegin(); comment != beginning_.comments.rend(); ++comment)
      if (comment->number < plan_.first_row && use_names(split_names(comment->text, plan_))) return;
    doubt_columns();
  }

  /// False where x, y and z are not among them.
  bool use_names(std::vector<std::string> names) {
    const auto axes = find_axes(names);
    if (!axes) return false;
    std::string meant;
    bool plain = true;
    for (std::size_t k = 0; k < 3; ++k) {
      std::string& name = names[(*axes)[k]];
      plain = plain && is_axis(name, static_cast<char>('x' + k));
      meant += (k > 0 ? ", " : "") + shown(name);
    }
    if (!plain) notes_.notes.push_back("columns " + meant + " read as x, y, z");
    for (std::size_t i = 0; i < names.size(); ++i)
      for (std::size_t k = 0; k < 3; ++k) {
        const char axis = static_cast<char>('x' + k);
        if ((*axes)[k] == i)
          names[i] = axis;
        else if (is_axis(names[i], axis))
          names[i] += "_2";
      }
    for (std::string& name : names)
      if (name == "-") name.clear(); // which would skip it
    plan_.names = std::move(names);
    return true;
  }

  [[noreturn]] void fail_header() {
    constexpr std::size_t most_shown = 8;
    std::string names;
    for (std::size_t i = 0; i < std::min(most_shown, header_.size()); ++i)
      names += (i > 0 ? ", " : "") + shown(header_[i]);
    if (header_.size() > most_shown) names += ", ...";
    const std::size_t first = first_column_counts(rows_of_beginning(), shape_) ? 1 : 0;
    const std::string words = "--columns " + columns_to_type(header_, shape_.numeric, first);
    if (names_degrees(header_))
      file_.fail_at_line(header_line_, "longitude and latitude in degrees are no lengths: " + names,
                         "project the points to metres first; to take them as they are type " + words);
    file_.fail_at_line(header_line_, "the header names no columns x, y and z: " + names,
                       "say which they are: " + words);
  }

  std::vector<TextLine> rows_of_beginning() {
    std::vector<TextLine> rows;
    for (const TextLine& line : beginning_.lines)
      if (line.number >= plan_.first_row && is_row(line.text)) rows.push_back(line);
    return rows;
  }

  /// Who types x,y,z for a table whose rows are numbered forgot that column.
  void doubt_given_columns() {
    if (!is_axis(plan_.names.front(), 'x') || shape_.numeric.size() != plan_.width ||
        !first_column_counts(rows_of_beginning(), shape_))
      return;
    notes_.notes.push_back(
        "column 1, x by --columns, counts like numbers of the points; to leave it out type --columns " +
        columns_to_type({}, shape_.numeric, 1));
  }

  void doubt_columns() {
    const std::vector<TextLine> rows = rows_of_beginning();
    if (shape_.numeric.size() != plan_.width || rows.empty()) return;
    const auto doubt = doubt_first_columns(rows, shape_, count_rows(file_, plan_.first_row));
    if (!doubt) return;
    if (doubt->names.empty()) file_.fail_at_line(plan_.first_row, doubt->cause, doubt->remedy);
    plan_.names = complete_names(doubt->names, plan_.width);
    notes_.warnings.push_back(doubt->cause +
                              "; columns 2, 3 and 4 are read as x, y and z; where northing comes first, type "
                              "--columns id,y,x,z");
  }

  const FileContent& file_;
  const ReadOptions& options_;
  ReadNotes& notes_;
  Beginning beginning_;
  RowShape shape_;
  TablePlan plan_;
  std::vector<std::size_t> key_columns_;
  std::vector<std::string> header_, known_names_;
  std::uint64_t header_line_ = 0;
  std::pair<std::uint64_t, std::size_t> misnamed_{0, 0};
  bool known_preface_ = false;
  Fields fields_;
};

} // namespace

std::optional<std::string_view> comment_text(std::string_view line) {
  if (line.starts_with("//")) return line.substr(2);
  if (line.starts_with('%')) return line.substr(std::min(line.find_first_not_of('%'), line.size()));
  if (!line.starts_with('#')) return std::nullopt;
  return line.substr(std::min(line.find_first_not_of('#'), line.size()));
}

bool is_point_row(std::string_view& row) {
  if (row.size() < 2 || !is_blank(row[1])) return true;
  if (row[0] == 'd' || row[0] == 's' || row[0] == 'g') return false;
  if (row[0] == 'p') row = trim(row.substr(1));
  return true;
}

bool is_count(std::string_view text, std::uint64_t& count) {
  text = trim(text);
  while (!text.empty() && (text.back() == ',' || text.back() == ';')) text.remove_suffix(1); // of a table's export
  return !text.empty() && std::all_of(text.begin(), text.end(), is_digit) && parse(text, count);
}

bool is_title(std::string_view text, const TablePlan& plan) {
  Fields fields;
  split_row(text, plan.format, fields);
  drop_empty_end(fields, plan.width);
  double number = 0;
  return fields.size() != plan.width && !fields.empty() && !parse_field(fields[0], plan.format, number);
}

TablePlan plan_table(const FileContent& file, const ReadOptions& options, bool lettered, ReadNotes& notes) {
  return Planner(file, options, lettered, notes).plan();
}

} // namespace eigencrust::io
