// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What the XML section of an E57 file says of its scans.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "io/e57_pages.h"
#include "io/pose.h"

namespace eigencrust::io {

/// One column of a scan's points.
struct E57Field {
  enum class Kind : std::uint8_t { integer, scaled, float32, float64, text };
  std::string name; ///< with its namespace prefix
  Kind kind = Kind::float64;
  std::int64_t minimum = 0, maximum = 0; ///< of the whole numbers that are stored
  double scale = 1, offset = 0;          ///< of scaled whole numbers
  std::uint64_t xml = 0;                 ///< logical offset of its declaration

  /// Bits of one value, 0 for a constant and for text.
  [[nodiscard]] unsigned bits() const;
};

/// One entry of data3D.
struct E57Scan {
  std::optional<Pose> pose;      ///< from the scan's frame into that of the file
  bool has_bad_rotation = false; ///< a quaternion of length zero was read as no rotation
  std::uint64_t file_offset = 0; ///< physical, of the binary section
  std::uint64_t records = 0;     ///< as claimed, below 2^32
  std::vector<E57Field> fields;  ///< of different names
  std::uint64_t xml = 0;         ///< logical offset of its declaration
};

/// \throws Error{input} naming the byte
std::vector<E57Scan> read_e57_header(const E57Pages& pages);

} // namespace eigencrust::io
