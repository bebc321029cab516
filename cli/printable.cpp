// SPDX-License-Identifier: GPL-3.0-or-later
#include "printable.h"

#include <algorithm>

namespace eigencrust::cli {

namespace clean {
namespace {

unsigned byte_at(std::string_view text, std::size_t i) { return static_cast<unsigned char>(text[i]); }

/// Of well-formed UTF-8.
unsigned code_of(std::string_view character) {
  const unsigned first = byte_at(character, 0);
  if (character.size() == 1) return first;
  unsigned code = first & (0x7fu >> character.size());
  for (std::size_t i = 1; i < character.size(); ++i) code = code << 6 | (byte_at(character, i) & 0x3fu);
  return code;
}

} // namespace

std::size_t length(std::string_view text) {
  const unsigned first = byte_at(text, 0);
  if (first < 0x80) return 1;
  const std::size_t size = first >= 0xc2 && first < 0xe0 ? 2 : first >= 0xe0 && first < 0xf0 ? 3 : 4;
  if (first < 0xc2 || first > 0xf4 || text.size() < size) return 0;
  for (std::size_t i = 1; i < size; ++i)
    if ((byte_at(text, i) & 0xc0u) != 0x80) return 0;
  constexpr unsigned least[] = {0, 0, 0x80, 0x800, 0x10000}; // shorter forms exist for what is below
  const unsigned code = code_of(text.substr(0, size));
  return code < least[size] || code > 0x10ffff || (code >= 0xd800 && code < 0xe000) ? 0 : size;
}

bool is_harmless(std::string_view character) {
  const unsigned code = code_of(character);
  if (code < 0x20 || (code >= 0x7f && code < 0xa0)) return false;
  // Marks, embeddings and isolates that turn the direction of writing; line and paragraph separators.
  return code != 0x200e && code != 0x200f && !(code >= 0x2028 && code <= 0x202e) && !(code >= 0x2066 && code <= 0x2069);
}

std::string_view escape(std::string_view character, char* out) {
  constexpr char digits[] = "0123456789abcdef";
  const unsigned code = code_of(character);
  out[0] = '\\';
  out[1] = 'u';
  for (unsigned i = 0; i < 4; ++i) out[2 + i] = digits[code >> (12 - 4 * i) & 15u];
  return {out, 6};
}

} // namespace clean

std::string printable(std::string_view text) {
  std::string line;
  print_clean(text, [&](std::string_view piece) { line += piece; });
  return line;
}

CleanBuffer::int_type CleanBuffer::overflow(int_type c) {
  if (traits_type::eq_int_type(c, traits_type::eof())) return traits_type::not_eof(c);
  const char text[2] = {'\xc2', traits_type::to_char_type(c)};
  const auto byte = static_cast<unsigned char>(text[1]);
  char buffer[8];
  if (after_c2_) {
    after_c2_ = false;
    if (byte >= 0x80 && byte < 0xa0) return put(clean::escape({text, 2}, buffer)) ? c : traits_type::eof();
    if (!put({text, 1})) return traits_type::eof();
  }
  if (byte == 0xc2) {
    after_c2_ = true;
    return c;
  }
  const bool control = (byte < 0x20 && byte != '\n' && byte != '\t') || byte == 0x7f;
  return put(control ? clean::escape({text + 1, 1}, buffer) : std::string_view(text + 1, 1)) ? c : traits_type::eof();
}

} // namespace eigencrust::cli
