// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What the writers of binary files share.
#pragma once

#include <array>
#include <bit>
#include <cstring>
#include <ostream>
#include <span>
#include <vector>

#include "surface/scalar.h"

namespace eigencrust::io {

/// Little-endian bytes that go to the stream in large pieces, the last one at the end of the scope.
class BinaryBuffer {
 public:
  explicit BinaryBuffer(std::ostream& out) : out_(out) { bytes_.reserve(full + 4096); }
  ~BinaryBuffer() { flush(); }
  BinaryBuffer(const BinaryBuffer&) = delete;
  BinaryBuffer& operator=(const BinaryBuffer&) = delete;

  template <class T>
  void append(T value) {
    append_values(reinterpret_cast<const std::byte*>(&value), 1, sizeof value);
  }
  /// `count` values of `size` bytes each in the machine's byte order.
  void append_values(const std::byte* values, std::size_t count, std::size_t size) {
    const std::size_t begin = bytes_.size();
    bytes_.resize(begin + count * size);
    if (count > 0) std::memcpy(bytes_.data() + begin, values, count * size);
    if constexpr (std::endian::native == std::endian::big) swap_bytes(std::span(bytes_).subspan(begin), size);
    if (bytes_.size() >= full) flush();
  }

 private:
  static constexpr std::size_t full = 1 << 18;

  void flush() {
    out_.write(reinterpret_cast<const char*>(bytes_.data()), static_cast<std::streamsize>(bytes_.size()));
    bytes_.clear();
  }

  std::ostream& out_;
  std::vector<std::byte> bytes_;
};

} // namespace eigencrust::io
