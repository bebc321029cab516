// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Numbers out of little-endian bytes.
#pragma once

#include <bit>
#include <cstddef>
#include <cstring>
#include <string_view>

namespace eigencrust::io {

static_assert(std::endian::native == std::endian::little, "the binary formats are little-endian");

/// The value that begins at byte `at`; the caller makes sure that it is there.
template <class T>
T value_at(std::string_view bytes, std::size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof(T));
  return value;
}

} // namespace eigencrust::io
