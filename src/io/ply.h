// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The header of a PLY file (G. Turk, "The PLY Polygon File Format", 1994).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <eigencrust/types.h>

#include "io/file_content.h"

namespace eigencrust::io {

enum class PlyEncoding : std::uint8_t { ascii, little_endian, big_endian };

struct PlyProperty {
  std::string name;
  ScalarType type = ScalarType::float32;
  bool is_list = false;
  ScalarType count_type = ScalarType::uint8;
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0; ///< what the header claims
  std::vector<PlyProperty> properties;
  std::uint64_t line = 0; ///< of its declaration
};

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::ascii;
  std::vector<PlyElement> elements;
  std::size_t data_offset = 0;
  std::uint64_t lines = 0; ///< of the header
};

PlyHeader read_ply_header(const FileContent& file);
const char* ply_type_name(ScalarType type);

} // namespace eigencrust::io
