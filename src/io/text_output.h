// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What the writers of text share.
#pragma once

#include <ostream>
#include <string>
#include <vector>

#include <eigencrust/types.h>

#include "io/text.h"

namespace eigencrust::io {

/// Text that goes to the stream in large pieces, the last one at the end of the scope.
class TextBuffer {
 public:
  explicit TextBuffer(std::ostream& out) : out_(out) {}
  ~TextBuffer() { flush(); }
  TextBuffer(const TextBuffer&) = delete;
  TextBuffer& operator=(const TextBuffer&) = delete;

  std::string& text() { return text_; }
  void flush_if_full() {
    if (text_.size() >= full) flush();
  }

 private:
  static constexpr std::size_t full = 1 << 18;

  void flush() {
    out_.write(text_.data(), static_cast<std::streamsize>(text_.size()));
    text_.clear();
  }

  std::ostream& out_;
  std::string text_;
};

inline void append_coordinate(std::string& out, double value, bool as_float) {
  if (as_float)
    append_number(out, static_cast<float>(value));
  else
    append_number(out, value);
}

inline void append_point(std::string& out, const Vec3& p, char separator, bool as_float) {
  append_coordinate(out, p.x, as_float);
  out += separator;
  append_coordinate(out, p.y, as_float);
  out += separator;
  append_coordinate(out, p.z, as_float);
}

/// Each line of each comment behind `mark`.
void append_comments(std::string& out, const std::string& mark, const std::vector<std::string>& comments);

} // namespace eigencrust::io
