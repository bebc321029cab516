// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Small arrays of NumPy and zip archives made by hand, so that the readers are tested against the formats
/// and not against a library.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "e57_bytes.h"

namespace eigencrust {

/// CRC-32 of zip bit by bit, for the reflected polynomial.
inline std::uint32_t zip_crc(const std::string& bytes) {
  std::uint32_t crc = 0xffffffff;
  for (const char c : bytes) {
    crc ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1) != 0 ? 0xedb88320u : 0u);
  }
  return ~crc;
}

/// A deflate stream of one block that is not compressed (type 0), up to 65535 bytes.
inline std::string deflate_stored(const std::string& bytes) {
  const auto size = static_cast<std::uint16_t>(bytes.size());
  return std::string("\1") + raw_bytes<std::uint16_t>({size, static_cast<std::uint16_t>(~size)}) + bytes;
}

struct ZipTestMember {
  std::string name, content;
  std::string packed{};     ///< if not empty: what stands in the archive
  std::uint16_t method = 0; ///< 8: deflated
  std::uint16_t flags = 0;
  std::uint32_t crc_change = 0;  ///< what the checksum is wrong by
  std::uint64_t size_change = 0; ///< what the unpacked size is wrong by
  bool large = false;            ///< sizes and place stand in 64 bits
};

/// \param comment behind the archive
inline std::string zip_file(const std::vector<ZipTestMember>& members, const std::string& comment = "") {
  using u16 = std::uint16_t;
  using u32 = std::uint32_t;
  std::string bytes, directory;
  for (const ZipTestMember& m : members) {
    const std::string& data = m.packed.empty() ? m.content : m.packed;
    const std::uint64_t size = m.content.size() + m.size_change, packed = data.size(), place = bytes.size();
    const auto small = [&](std::uint64_t v) { return m.large ? 0xffffffffu : static_cast<u32>(v); };
    std::string extra = raw_bytes<u16>({0x7777, 3}) + "abc"; // of another program
    if (m.large) extra += raw_bytes<u16>({1, 24}) + raw_bytes<std::uint64_t>({size, packed, place});
    const u16 name = static_cast<u16>(m.name.size()), extra_size = static_cast<u16>(extra.size());
    const std::string common = raw_bytes<u16>({20, m.flags, m.method, 0, 0}) +
                               raw_bytes<u32>({zip_crc(m.content) + m.crc_change, small(packed), small(size)}) +
                               raw_bytes<u16>({name, extra_size});
    bytes += std::string("PK\3\4") + common + m.name + extra + data;
    directory += std::string("PK\1\2") + raw_bytes<u16>({20}) + common + raw_bytes<u16>({0, 0, 0}) +
                 raw_bytes<u32>({0, small(place)}) + m.name + extra;
  }
  const std::uint64_t begin = bytes.size(), count = members.size(), size = directory.size();
  bytes += directory;
  const bool large = !members.empty() && members.front().large;
  const std::uint64_t end64 = bytes.size();
  if (large)
    bytes += std::string("PK\6\6") + raw_bytes<std::uint64_t>({44}) + raw_bytes<u16>({45, 45}) +
             raw_bytes<u32>({0, 0}) + raw_bytes<std::uint64_t>({count, count, size, begin}) + "PK\6\7" +
             raw_bytes<u32>({0}) + raw_bytes<std::uint64_t>({end64}) + raw_bytes<u32>({1});
  const auto n = static_cast<u16>(large ? 0xffff : count);
  bytes +=
      "PK\5\6" + raw_bytes<u16>({0, 0, n, n}) +
      raw_bytes<u32>({large ? 0xffffffffu : static_cast<u32>(size), large ? 0xffffffffu : static_cast<u32>(begin)}) +
      raw_bytes<u16>({static_cast<u16>(comment.size())}) + comment;
  return bytes;
}

/// Version 1.0 with the header as it is given.
inline std::string npy_with_header(const std::string& header, const std::string& values) {
  return std::string("\x93NUMPY\1\0", 8) + raw_bytes<std::uint16_t>({static_cast<std::uint16_t>(header.size())}) +
         header + values;
}

/// \param shape as Python prints it: "(2, 3)"
inline std::string npy_file(const std::string& descr, const std::string& shape, const std::string& values,
                            bool fortran = false) {
  return npy_with_header("{'descr': '" + descr + "', 'fortran_order': " + (fortran ? "True" : "False") +
                             ", 'shape': " + shape + ", }   \n",
                         values);
}

} // namespace eigencrust
