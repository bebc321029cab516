// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Small E57 files made by hand, so that the reader is tested against the standard and not against itself.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

namespace eigencrust {

template <class T>
std::string raw_bytes(std::initializer_list<T> values) {
  std::string bytes;
  for (const T value : values) {
    char buffer[sizeof(T)];
    std::memcpy(buffer, &value, sizeof(T));
    bytes.append(buffer, sizeof(T));
  }
  return bytes;
}

/// Values of `width` bits, least significant bit first.
inline std::string pack_bits(const std::vector<std::uint64_t>& values, unsigned width) {
  std::string bytes((values.size() * width + 7) / 8, '\0');
  for (std::size_t i = 0; i < values.size() * width; ++i)
    if ((values[i / width] >> (i % width) & 1) != 0)
      bytes[i / 8] = static_cast<char>(static_cast<unsigned char>(bytes[i / 8]) | 1u << (i % 8));
  return bytes;
}

struct E57TestScan {
  std::string before_points;                               ///< XML, a pose for example
  std::uint64_t records = 0;                               ///< what recordCount says
  std::vector<std::pair<std::string, std::string>> fields; ///< XML of the prototype's element, stream
  std::string codecs;                                      ///< XML
  bool shares_first = false;                               ///< names the bytes of the first scan as its own
  std::size_t first_packet = 1000000; ///< bytes of each stream in the first packet; the rest follows
};

/// CRC-32C bit by bit, unlike the reader's.
inline std::uint32_t slow_crc32c(const std::string& bytes) {
  std::uint32_t crc = 0xffffffff;
  for (const char c : bytes) {
    crc ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ ((crc & 1) != 0 ? 0x82F63B78u : 0u);
  }
  return ~crc;
}

inline std::uint64_t e57_physical(std::uint64_t logical) { return logical / 1020 * 1024 + logical % 1020; }

/// Cuts into pages and adds the checksums. The file's length is entered at byte 16.
inline std::string seal_e57(std::string logical) {
  logical.resize((logical.size() + 1019) / 1020 * 1020);
  logical.replace(16, 8, raw_bytes<std::uint64_t>({logical.size() / 1020 * 1024}));
  std::string file;
  for (std::size_t begin = 0; begin < logical.size(); begin += 1020) {
    const std::string page = logical.substr(begin, 1020);
    const std::uint32_t crc = slow_crc32c(page);
    file += page;
    for (int shift = 24; shift >= 0; shift -= 8) file += static_cast<char>(crc >> shift & 0xff);
  }
  return file;
}

inline std::string e57_packet(const std::vector<std::string>& pieces) {
  std::string body = raw_bytes<std::uint16_t>({static_cast<std::uint16_t>(pieces.size())});
  for (const std::string& piece : pieces) body += raw_bytes<std::uint16_t>({static_cast<std::uint16_t>(piece.size())});
  for (const std::string& piece : pieces) body += piece;
  body.resize((body.size() + 3) / 4 * 4);
  return std::string("\1\0", 2) + raw_bytes<std::uint16_t>({static_cast<std::uint16_t>(body.size() + 3)}) + body;
}

/// The file without its checksums; seal_e57 makes it whole.
inline std::string e57_logical(const std::vector<E57TestScan>& scans) {
  std::string logical(48, '\0');
  std::string xml = "<?xml version=\"1.0\"?>\n<e57Root type=\"Structure\" xmlns:nor=\"n\"><data3D type=\"Vector\">\n";
  for (const E57TestScan& scan : scans) {
    const std::uint64_t section = logical.size();
    std::vector<std::string> first, second;
    bool split = false;
    std::string prototype;
    for (const auto& [element, stream] : scan.fields) {
      prototype += element + "\n";
      const std::size_t cut = std::min(scan.first_packet, stream.size());
      first.push_back(stream.substr(0, cut));
      second.push_back(stream.substr(cut));
      split = split || !second.back().empty();
    }
    // An index packet and an empty one come between, which say nothing of the points.
    const std::string others = std::string("\0\0\x0f\0", 4) + std::string(12, '\0') + std::string("\2\0\3\0", 4);
    const std::string packets = e57_packet(first) + (split ? others + e57_packet(second) : "");
    logical += std::string("\1\0\0\0\0\0\0\0", 8) + raw_bytes<std::uint64_t>({32 + packets.size()}) +
               raw_bytes<std::uint64_t>({e57_physical(section + 32), 0}) + packets;
    xml += "<vectorChild type=\"Structure\">" + scan.before_points + "<points type=\"CompressedVector\" fileOffset=\"" +
           std::to_string(scan.shares_first ? 48 : e57_physical(section)) + "\" recordCount=\"" +
           std::to_string(scan.records) + "\"><prototype type=\"Structure\">" + prototype +
           "</prototype><codecs type=\"Vector\">" + scan.codecs + "</codecs></points></vectorChild>\n";
  }
  xml += "</data3D></e57Root>";
  const std::uint64_t xml_begin = logical.size();
  logical += xml;
  logical.replace(0, 48,
                  "ASTM-E57" + raw_bytes<std::uint32_t>({1, 0}) +
                      raw_bytes<std::uint64_t>({0, e57_physical(xml_begin), xml.size(), 1024}));
  return logical;
}

inline std::string e57_file(const std::vector<E57TestScan>& scans) { return seal_e57(e57_logical(scans)); }

} // namespace eigencrust
