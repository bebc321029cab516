// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/lzf.h"

namespace eigencrust::io {

bool lzf_unpack(std::string_view packed, std::size_t size, std::string& result, std::size_t& bad) {
  result.clear();
  bad = 0;
  if (size / lzf_largest_ratio > packed.size()) return false;
  result.reserve(size);
  const auto byte = [&](std::size_t k) { return static_cast<std::size_t>(static_cast<unsigned char>(packed[k])); };
  std::size_t i = 0;
  while (i < packed.size()) {
    bad = i;
    const std::size_t control = byte(i++);
    if (control < 32) {
      const std::size_t length = control + 1;
      if (length > packed.size() - i || length > size - result.size()) return false;
      result.append(packed, i, length);
      i += length;
      continue;
    }
    std::size_t length = control >> 5;
    if (length == 7) {
      if (i == packed.size()) return false;
      length += byte(i++);
    }
    length += 2;
    if (i == packed.size()) return false;
    const std::size_t distance = ((control & 31) << 8) + byte(i++) + 1;
    if (distance > result.size() || length > size - result.size()) return false;
    // Byte by byte: a copy may read what it wrote itself.
    for (std::size_t from = result.size() - distance; length > 0; --length) result.push_back(result[from++]);
  }
  bad = packed.size();
  return result.size() == size;
}

} // namespace eigencrust::io
