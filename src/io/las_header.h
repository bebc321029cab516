// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The header of a LAS file (ASPRS, "LAS Specification", 1.0 to 1.4) and what it says of a point's bytes.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <eigencrust/types.h>

#include "io/file_content.h"

namespace eigencrust::io {

/// A column of the points that the format itself knows.
struct LasField {
  const char* name;
  ScalarType type;
  std::size_t offset;           ///< within the record
  unsigned shift = 0, bits = 0; ///< bits > 0: only these of one byte
};

/// A column that the file describes (the "extra bytes").
struct LasExtra {
  std::string name;
  unsigned type = 1;      ///< 1 to 10: the integers of 8, 16, 32, 64 bits, each unsigned and signed, float, double
  std::size_t count = 1;  ///< values per point: 1, 2 or 3
  std::size_t offset = 0; ///< within the record
  bool scaled = false;    ///< value -> scale * value + shift
  std::array<double, 3> scale{1, 1, 1}, shift{};
};

/// Bytes of one value of that type.
std::size_t las_type_size(unsigned type);

/// The columns of a format of points, 0 to 10, in version 1.minor.
std::vector<LasField> las_fields(unsigned format, unsigned minor);
/// Bytes of one point without extra ones.
std::size_t las_record_bytes(unsigned format);

struct LasHeader {
  unsigned minor = 0;  ///< version 1.minor
  unsigned format = 0; ///< of the points, 0 to 10
  std::size_t data_offset = 0, record_bytes = 0;
  std::uint64_t points = 0; ///< all of them are there
  Vec3 scale, offset;
  std::vector<LasField> fields;
  std::vector<LasExtra> extras;
};

/// \throws Error{input} naming the byte; also for compressed points (LAZ, COPC)
LasHeader read_las_header(const FileContent& file, std::vector<std::string>& notes);

} // namespace eigencrust::io
