// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/text_encoding.h"

#include <cstdint>

namespace eigencrust::io {
namespace {

void append_utf8(std::string& out, std::uint32_t code) {
  const auto tail = [&](int shift) { out += static_cast<char>(0x80 | (code >> shift & 0x3f)); };
  if (code < 0x80) {
    out += static_cast<char>(code);
  } else if (code < 0x800) {
    out += static_cast<char>(0xc0 | code >> 6);
    tail(0);
  } else if (code < 0x10000) {
    out += static_cast<char>(0xe0 | code >> 12);
    tail(6);
    tail(0);
  } else {
    out += static_cast<char>(0xf0 | code >> 18);
    tail(12);
    tail(6);
    tail(0);
  }
}

} // namespace

std::optional<std::string> decode_utf16(std::string_view bytes) {
  if (bytes.size() < 4) return std::nullopt;
  const auto unit = [&](std::size_t i, bool big) {
    const auto first = static_cast<unsigned char>(bytes[i]), second = static_cast<unsigned char>(bytes[i + 1]);
    return static_cast<std::uint32_t>(big ? first << 8 | second : second << 8 | first);
  };
  const bool has_mark = unit(0, false) == 0xfeff || unit(0, true) == 0xfeff;
  const bool big = has_mark ? unit(0, true) == 0xfeff : bytes[0] == 0;
  std::string text;
  text.reserve(bytes.size() / 2);
  for (std::size_t i = has_mark ? 2 : 0; i + 1 < bytes.size(); i += 2) {
    std::uint32_t code = unit(i, big);
    if (code == 0 || (!has_mark && code > 0x7f)) return std::nullopt; // no text
    if (code >= 0xd800 && code < 0xdc00 && i + 3 < bytes.size()) {
      const std::uint32_t low = unit(i + 2, big);
      if (low < 0xdc00 || low > 0xdfff) return std::nullopt;
      code = 0x10000 + ((code - 0xd800) << 10) + (low - 0xdc00);
      i += 2;
    }
    append_utf8(text, code);
  }
  return text;
}

} // namespace eigencrust::io
