// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/row_format.h"

#include <algorithm>
#include <array>
#include <map>

#include "io/point_table.h"

namespace eigencrust::io {
namespace {

std::string_view without_quotes(std::string_view field) {
  field = trim(field);
  if (field.size() >= 2 && field.front() == '"' && field.back() == '"') return trim(field.substr(1, field.size() - 2));
  return field;
}

/// Splits at every `mark` outside of quotes; two of them hold an empty field between them.
void split_at(std::string_view text, char mark, Fields& fields) {
  std::size_t begin = 0;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '"') quoted = !quoted;
    if (text[i] != mark || quoted) continue;
    fields.push_back(without_quotes(text.substr(begin, i - begin)));
    begin = i + 1;
  }
  fields.push_back(without_quotes(text.substr(begin)));
}

void split_at_wide_blanks(std::string_view text, Fields& fields) {
  text = trim(text);
  while (!text.empty()) {
    std::size_t end = 0;
    while (end < text.size() && text[end] != '\t' &&
           !(text[end] == ' ' && end + 1 < text.size() && is_blank(text[end + 1])))
      ++end;
    fields.push_back(without_quotes(text.substr(0, end)));
    text = trim(text.substr(end));
  }
}

/// Is the mark between two digits somewhere?
bool is_between_digits(std::string_view text, char mark) {
  for (std::size_t i = 1; i + 1 < text.size(); ++i)
    if (text[i] == mark && is_digit(text[i - 1]) && is_digit(text[i + 1])) return true;
  return false;
}

/// Commas between digits in most lines, and no decimal point in a line that begins as numbers do.
bool may_have_decimal_commas(std::span<const TextLine> lines) {
  std::size_t commas = 0;
  for (const TextLine& line : lines) {
    const bool is_number =
        !line.text.empty() && (is_digit(line.text[0]) || std::string_view("+-.,").find(line.text[0]) < 4);
    if (is_number && is_between_digits(line.text, '.')) return false;
    commas += is_between_digits(line.text, ',') ? 1 : 0;
  }
  return commas > 0 && 2 * commas >= lines.size();
}

/// The number of fields of most lines, from three on; the earliest of equals.
std::size_t usual_width(const std::vector<Fields>& rows) {
  std::map<std::size_t, std::size_t> times;
  std::size_t width = 0;
  for (const Fields& row : rows)
    if (row.size() >= 3) ++times[row.size()];
  for (const Fields& row : rows)
    if (row.size() >= 3 && (width == 0 || times[row.size()] > times[width])) width = row.size();
  return width;
}

/// Rows that all end in a separator have no empty last field.
bool ends_empty(const std::vector<Fields>& rows, std::size_t width) {
  return std::all_of(rows.begin(), rows.end(),
                     [&](const Fields& row) { return row.size() != width || row.back().empty(); });
}

/// \param counted gets the number of rows of the usual width
RowShape shape_of(std::span<const TextLine> lines, const RowFormat& format, std::size_t& counted) {
  std::vector<Fields> rows(lines.size());
  for (std::size_t i = 0; i < rows.size(); ++i) split_row(lines[i].text, format, rows[i]);
  RowShape shape{format, usual_width(rows), {}};
  if (shape.width == 0) return shape;
  if (ends_empty(rows, shape.width)) --shape.width;
  std::vector<std::size_t> numbers(shape.width, 0);
  for (Fields& row : rows) {
    drop_empty_end(row, shape.width);
    if (row.size() != shape.width) continue;
    ++counted;
    for (std::size_t k = 0; k < row.size(); ++k) {
      double value = 0;
      numbers[k] += parse_field(row[k], format, value) || is_missing(row[k]) ? 1 : 0;
    }
  }
  for (const std::size_t n : numbers) shape.numeric.push_back(2 * n >= counted);
  return shape;
}

} // namespace

bool next_text_line(LineScanner& lines, std::string_view& text) {
  while (lines.next()) {
    text = lines.line();
    while (!text.empty() && (text.back() == '\r' || text.back() == ' ')) text.remove_suffix(1);
    while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
    if (!trim(text).empty()) return true;
  }
  return false;
}

void split_row(std::string_view text, const RowFormat& format, Fields& fields) {
  fields.clear();
  switch (format.separator) {
    case Separator::any:
      return split_fields(text, fields);
    case Separator::tab:
      return split_at(text, '\t', fields);
    case Separator::semicolon:
      return split_at(text, ';', fields);
    case Separator::comma:
      return split_at(text, ',', fields);
    case Separator::blanks:
      split_words(text, fields);
      for (std::string_view& field : fields) field = without_quotes(field);
      return;
    case Separator::wide_blanks:
      return split_at_wide_blanks(text, fields);
  }
}

bool parse_field(std::string_view field, const RowFormat& format, double& value) {
  if (parse(field, value)) return true;
  constexpr std::size_t longest = 60; // digits of a number that someone wrote
  const std::size_t comma = format.decimal_comma ? field.find(',') : std::string_view::npos;
  if (comma == std::string_view::npos || field.size() > longest || field.find('.') != std::string_view::npos)
    return false;
  std::array<char, longest> text{};
  std::copy(field.begin(), field.end(), text.begin());
  text[comma] = '.';
  return parse(std::string_view(text.data(), field.size()), value);
}

bool is_missing(std::string_view field) {
  if (field.size() > 12) return false;
  constexpr std::array<std::string_view, 20> words = {
      "",    "-",    "--",   "?",        ".",         "*",       "null",     "none",   "nil",     "na",
      "n/a", "#n/a", "n.a.", "nan(ind)", "-nan(ind)", "1.#qnan", "-1.#qnan", "1.#ind", "-1.#ind", "1.#snan"};
  const std::string lower = lower_case(field);
  if (std::find(words.begin(), words.end(), lower) != words.end()) return true;
  // Older Windows programs fill up with zeros: 1.#QNAN0, -1.#IND00.
  return lower.find("1.#qnan") < 2 || lower.find("1.#ind") < 2;
}

RowShape find_row_shape(std::span<const TextLine> lines, std::span<const std::size_t> needed) {
  constexpr std::array<Separator, 5> separators = {Separator::tab, Separator::semicolon, Separator::comma,
                                                   Separator::blanks, Separator::any};
  RowShape best;
  std::size_t most = 0;
  const auto consider = [&](const RowFormat& format) {
    std::size_t rows = 0;
    RowShape shape = shape_of(lines, format, rows);
    for (const std::size_t column : needed)
      if (column >= shape.width || !shape.numeric[column]) return;
    const auto columns = static_cast<std::size_t>(std::count(shape.numeric.begin(), shape.numeric.end(), true));
    if (columns < 3 || columns * rows <= most) return;
    most = columns * rows;
    best = std::move(shape);
  };
  // One of these is the only sensible reading of such commas: each would else make two columns.
  if (may_have_decimal_commas(lines))
    for (const Separator separator : {Separator::tab, Separator::semicolon, Separator::blanks})
      consider({separator, true});
  if (best.width > 0) return best;
  for (const Separator separator : separators) consider({separator, false});
  return best;
}

} // namespace eigencrust::io
