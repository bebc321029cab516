// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Scanning and printing of text, independent of the locale, shared by the text formats.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include "io/file_content.h"

namespace eigencrust::io {

constexpr bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }
constexpr bool is_digit(char c) { return c >= '0' && c <= '9'; }

std::string_view trim(std::string_view text);
std::string lower_case(std::string_view text);
bool equal_ignoring_case(std::string_view a, std::string_view b);
/// For messages: in quotes, at most 40 characters, without control characters.
std::string shown(std::string_view text);
/// Without what is no printable ASCII: question marks instead.
std::string plain(std::string_view text);
std::string plural(std::uint64_t count, const std::string& noun);

/// Each reads all of `text` or returns false. A leading plus is allowed; nan and inf in any case are
/// numbers; what is too large for the type becomes infinite, what is too small zero.
bool parse(std::string_view text, double& value);
bool parse(std::string_view text, float& value);
/// Also "12.0": some programs print integers as reals. False beyond 64 bits.
bool parse(std::string_view text, std::int64_t& value);
bool parse(std::string_view text, std::uint64_t& value);

/// Appends the shortest digits that read back as the same value.
void append_number(std::string& out, double value);
void append_number(std::string& out, float value);
void append_number(std::string& out, std::int64_t value);

/// Walks through a text line by line; line ends are LF, CR LF or CR (whichever comes first decides).
class LineScanner {
 public:
  explicit LineScanner(const FileContent& file, std::size_t offset = 0, std::uint64_t lines_before = 0);

  /// Advances to the next line; false at the end.
  bool next() {
    if (position_ >= text_.size()) return false;
    const char* begin = text_.data() + position_;
    const std::size_t left = text_.size() - position_;
    const void* end = std::memchr(begin, delimiter_, left);
    const std::size_t length = end == nullptr ? left : static_cast<std::size_t>(static_cast<const char*>(end) - begin);
    line_ = {begin, length};
    position_ += length + (end == nullptr ? 0 : 1);
    ++number_;
    return true;
  }
  /// Advances to the next line that is neither blank nor a comment; line() is then trimmed, and cut at
  /// the comment mark. `mark` 0: there are no comments.
  bool next_filled(char mark = '\0');

  /// Without the line's end, but perhaps with a CR.
  [[nodiscard]] std::string_view line() const { return line_; }
  [[nodiscard]] std::uint64_t number() const { return number_; }
  /// Bytes up to the end of the file, not counting the current line.
  [[nodiscard]] std::size_t remaining() const { return text_.size() - position_; }
  [[nodiscard]] std::size_t offset() const { return position_; }
  [[nodiscard]] const FileContent& file() const { return *file_; }

  /// \throws Error{input} at the current line
  [[noreturn]] void fail(const std::string& cause, const std::string& remedy) const {
    file_->fail_at_line(number_, cause, remedy);
  }

 private:
  const FileContent* file_;
  std::string_view text_, line_;
  std::size_t position_;
  std::uint64_t number_;
  char delimiter_;
};

/// Takes the next blank-separated word off the front of `text`; empty when there is none.
inline std::string_view next_word(std::string_view& text) {
  std::size_t begin = 0;
  while (begin < text.size() && is_blank(text[begin])) ++begin;
  std::size_t end = begin;
  while (end < text.size() && !is_blank(text[end])) ++end;
  const std::string_view word = text.substr(begin, end - begin);
  text.remove_prefix(end);
  return word;
}

using Fields = std::vector<std::string_view>;

/// Splits at blanks. `fields` is a buffer to be used again.
void split_words(std::string_view text, Fields& fields);
/// Splits at blanks, commas and semicolons; two commas in a row hold an empty field between them, and so
/// does one at the end. Quotes around a field are taken off.
void split_fields(std::string_view text, Fields& fields);

} // namespace eigencrust::io
