// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Names and messages can come from files of strangers. What a terminal would obey, or what hides other text, is
/// printed as \u001b: within a line of text and within a string of JSON alike.
#pragma once

#include <streambuf>
#include <string>
#include <string_view>

namespace eigencrust::cli {

/// Passes the characters of a UTF-8 text on, one piece of 1 to 4 bytes after the other, control characters,
/// characters that turn the direction of writing, and bytes that are no UTF-8 as escapes. Allocates nothing.
template <class Put>
void print_clean(std::string_view text, Put&& put);

/// The whole text in one line.
std::string printable(std::string_view text);

/// Stands between a stream and its buffer and keeps control characters out of it, line feeds and tabs excepted:
/// whatever is printed, it does not reach the terminal.
class CleanBuffer : public std::streambuf {
 public:
  explicit CleanBuffer(std::streambuf* target) : target_(target) {}

 protected:
  int_type overflow(int_type c) override;
  int sync() override { return target_->pubsync(); }

 private:
  bool put(std::string_view text) {
    return target_->sputn(text.data(), static_cast<std::streamsize>(text.size())) ==
           static_cast<std::streamsize>(text.size());
  }
  std::streambuf* target_;
  bool after_c2_ = false; ///< the first byte of a control character of two bytes is held back
};

namespace clean {
/// How many bytes the character at the front takes; 0: it is none.
std::size_t length(std::string_view text);
/// Is the character to be passed on as it is?
bool is_harmless(std::string_view character);
/// "\u001b"; of a byte that is no character "\u00ff". \param out 7 bytes
std::string_view escape(std::string_view character, char* out);
} // namespace clean

template <class Put>
void print_clean(std::string_view text, Put&& put) {
  char buffer[8];
  while (!text.empty()) {
    const std::size_t size = clean::length(text);
    const std::string_view character = text.substr(0, size > 0 ? size : 1);
    put(size > 0 && clean::is_harmless(character) ? character : clean::escape(character, buffer));
    text.remove_prefix(character.size());
  }
}

} // namespace eigencrust::cli
