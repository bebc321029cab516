// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The header of a PCD file (Point Cloud Library, "The PCD file format", version 0.7).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "io/file_content.h"

namespace eigencrust::io {

enum class PcdEncoding : std::uint8_t { ascii, binary, binary_compressed };

struct PcdField {
  std::string name;
  char type = 'F';         ///< I, U or F
  std::size_t size = 4;    ///< bytes of one value: 1, 2, 4 or 8
  std::uint64_t count = 1; ///< values per point, at least 1
};

struct PcdHeader {
  std::vector<PcdField> fields;
  std::uint64_t points = 0;                       ///< what the header claims
  std::uint64_t width = 0, height = 1;            ///< of the grid; height 1: there is none
  std::optional<std::array<double, 7>> viewpoint; ///< tx ty tz qw qx qy qz, all finite
  std::uint64_t viewpoint_line = 0;
  PcdEncoding encoding = PcdEncoding::ascii;
  std::size_t data_offset = 0;
  std::uint64_t lines = 0; ///< of the header

  /// Values per point, and their bytes in the binary encodings. Neither exceeds 2^32.
  [[nodiscard]] std::uint64_t row_values() const;
  [[nodiscard]] std::uint64_t row_bytes() const;
};

/// \throws Error{input} naming the line
PcdHeader read_pcd_header(const FileContent& file);

} // namespace eigencrust::io
