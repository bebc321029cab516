// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The binary sections of an E57 file: packets that hold pieces of one stream of bits per column.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "io/e57_header.h"
#include "io/e57_pages.h"

namespace eigencrust::io {

/// How much the scans of one file may still ask for, so that neither scans that share their bytes nor
/// constant columns, which take none, make much of little.
struct E57Budget {
  std::uint64_t bytes;   ///< of sections to be read
  std::uint64_t records; ///< of scans all columns of which are constant
};

/// The packed values of each field.
/// \throws Error{input} naming the byte when the streams do not hold scan.records values each
std::vector<std::string> read_e57_streams(const E57Pages& pages, const E57Scan& scan, E57Budget& budget);

/// The values of a field with the meaning of its kind. \param stream at least `records` values of it
std::vector<double> unpack_e57(const E57Field& field, const std::string& stream, std::uint64_t records);

} // namespace eigencrust::io
