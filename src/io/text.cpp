// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <system_error>

namespace eigencrust::io {
namespace {

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

std::string_view without_plus(std::string_view text) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-' && text[1] != '+') text.remove_prefix(1);
  return text;
}

/// from_chars leaves the value alone when it does not fit; then only the direction is of interest.
template <class Real>
Real beyond_range(std::string_view text) {
  const bool negative = text.front() == '-';
  if (negative) text.remove_prefix(1);
  const std::size_t e = text.find_first_of("eE");
  const bool tiny = e == std::string_view::npos ? text.front() == '0' || text.front() == '.'
                                                : e + 1 < text.size() && text[e + 1] == '-';
  const Real size = tiny ? Real{0} : std::numeric_limits<Real>::infinity();
  return negative ? -size : size;
}

template <class Real>
bool parse_real(std::string_view text, Real& value) {
  text = without_plus(text);
  Real parsed{}; // from_chars reads "1" of "1.#QNAN": the value must stay what it was
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), parsed);
  if (text.empty() || end != text.data() + text.size() || error == std::errc::invalid_argument) return false;
  value = error == std::errc::result_out_of_range ? beyond_range<Real>(text) : parsed;
  return true;
}

template <class Integer>
bool parse_integer(std::string_view text, Integer& value) {
  text = without_plus(text);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc() && end == text.data() + text.size()) return true;
  double real = 0;
  // Doubles hold the integers up to 2^53; anything larger was not meant as an integer.
  if (!parse_real(text, real) || real != std::floor(real) || std::abs(real) > 0x1p53) return false;
  if (std::is_unsigned_v<Integer> && real < 0) return false;
  value = static_cast<Integer>(real);
  return true;
}

template <class Number>
void append_any(std::string& out, Number value) {
  char digits[40];
  const auto result = std::to_chars(digits, digits + sizeof digits, value);
  out.append(digits, result.ptr);
}

char find_delimiter(std::string_view text) {
  const std::size_t end = text.find_first_of("\r\n");
  if (end == std::string_view::npos || text[end] == '\n') return '\n';
  const std::size_t after = text.find_first_not_of('\r', end);
  return after != std::string_view::npos && text[after] != '\n' ? '\r' : '\n';
}

} // namespace

std::string_view trim(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

std::string lower_case(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(), lower);
  return result;
}

bool equal_ignoring_case(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](char c, char d) { return lower(c) == lower(d); });
}

std::string shown(std::string_view text) {
  constexpr std::size_t longest = 40;
  std::string result = "'";
  result += plain(text.substr(0, longest));
  return result + (text.size() > longest ? "...'" : "'");
}

std::string plain(std::string_view text) {
  std::string result(text);
  for (char& c : result)
    if (c < 32 || c >= 127) c = '?';
  return result;
}

std::string plural(std::uint64_t count, const std::string& noun) {
  return std::to_string(count) + ' ' + noun + (count == 1 ? "" : "s");
}

bool parse(std::string_view text, double& value) { return parse_real(text, value); }
bool parse(std::string_view text, float& value) { return parse_real(text, value); }
bool parse(std::string_view text, std::int64_t& value) { return parse_integer(text, value); }
bool parse(std::string_view text, std::uint64_t& value) { return parse_integer(text, value); }

void append_number(std::string& out, double value) { append_any(out, value); }
void append_number(std::string& out, float value) { append_any(out, value); }
void append_number(std::string& out, std::int64_t value) { append_any(out, value); }

LineScanner::LineScanner(const FileContent& file, std::size_t offset, std::uint64_t lines_before)
    : file_(&file),
      text_(file.bytes()),
      position_(offset),
      number_(lines_before),
      delimiter_(find_delimiter(file.bytes())) {
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  if (offset == 0 && text_.starts_with(byte_order_mark)) position_ = byte_order_mark.size();
}

bool LineScanner::next_filled(char mark) {
  while (next()) {
    if (mark != '\0') line_ = line_.substr(0, line_.find(mark));
    line_ = trim(line_);
    if (!line_.empty()) return true;
  }
  return false;
}

void split_words(std::string_view text, Fields& fields) {
  fields.clear();
  for (std::string_view word = next_word(text); !word.empty(); word = next_word(text)) fields.push_back(word);
}

void split_fields(std::string_view text, Fields& fields) {
  fields.clear();
  const auto separates = [](char c) { return c == ',' || c == ';'; };
  const auto skip_blanks = [&] {
    while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  };
  bool expected = false; // a separator came last, so that another field must follow
  for (skip_blanks(); !text.empty() || expected; skip_blanks()) {
    std::size_t end = 0;
    if (!text.empty() && text.front() == '"') {
      text.remove_prefix(1);
      end = std::min(text.find('"'), text.size());
      fields.push_back(text.substr(0, end));
      text.remove_prefix(std::min(end + 1, text.size()));
    } else {
      while (end < text.size() && !is_blank(text[end]) && !separates(text[end])) ++end;
      fields.push_back(text.substr(0, end));
      text.remove_prefix(end);
    }
    skip_blanks();
    expected = !text.empty() && separates(text.front());
    if (expected) text.remove_prefix(1);
  }
}

} // namespace eigencrust::io
