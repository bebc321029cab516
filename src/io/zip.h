// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Members of a zip archive (PKWARE, "APPNOTE.TXT", 6.3): stored and deflated ones, also of more than 4 GB.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "io/file_content.h"

namespace eigencrust::io {

struct ZipMember {
  std::string name;
  unsigned flags = 0, method = 0; ///< 0: stored, 8: deflated
  std::uint32_t crc = 0;
  std::uint64_t packed = 0, size = 0; ///< bytes in the file, and unpacked
  std::uint64_t header = 0;           ///< where its local header begins
};

/// Bytes that the members of one archive may unpack to: small files shall not fill the memory.
constexpr std::uint64_t zip_budget(std::uint64_t file_size) { return (1u << 20) + 100 * file_size; }

/// The central directory. \throws Error{input} naming the byte
std::vector<ZipMember> read_zip_directory(const FileContent& file);

/// The member's bytes, whose checksum is right.
/// \param budget is lessened by their number
/// \throws Error{input} when they are damaged, compressed in another way, encrypted, or more than the budget
std::string unpack_zip_member(const FileContent& file, const ZipMember& member, std::uint64_t& budget);

} // namespace eigencrust::io
