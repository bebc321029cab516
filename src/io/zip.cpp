// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/zip.h"

#define ZLIB_CONST // its input is not changed
#include <zlib.h>

#include <algorithm>
#include <limits>
#include <new>

#include "io/bytes.h"
#include "io/text.h"

namespace eigencrust::io {
namespace {

constexpr std::uint32_t local_mark = 0x04034b50, central_mark = 0x02014b50, end_mark = 0x06054b50;
constexpr std::uint32_t end64_mark = 0x06064b50, locator64_mark = 0x07064b50;
constexpr std::uint32_t in_extra = 0xffffffff; ///< the number stands in the extra field for large files

/// Is there a record of `size` bytes with that mark?
bool has_record(std::string_view bytes, std::uint64_t at, std::size_t size, std::uint32_t mark) {
  return at <= bytes.size() && size <= bytes.size() - at && value_at<std::uint32_t>(bytes, at) == mark;
}

struct Directory {
  std::uint64_t begin = 0, size = 0, entries = 0;
};

/// The end record is the last but for a comment of up to 65535 bytes.
Directory find_directory(const FileContent& file) {
  constexpr std::size_t end_size = 22, locator_size = 20, end64_size = 56, longest_comment = 0xffff;
  const std::string_view bytes = file.bytes();
  const std::size_t first = bytes.size() - std::min(bytes.size(), end_size + longest_comment);
  for (std::size_t at = bytes.size(); at-- > first;) {
    if (!has_record(bytes, at, end_size, end_mark)) continue;
    if (value_at<std::uint16_t>(bytes, at + 20) > bytes.size() - at - end_size) continue;
    Directory directory{value_at<std::uint32_t>(bytes, at + 16), value_at<std::uint32_t>(bytes, at + 12),
                        value_at<std::uint16_t>(bytes, at + 10)};
    if (at >= locator_size && has_record(bytes, at - locator_size, locator_size, locator64_mark)) {
      const auto end64 = value_at<std::uint64_t>(bytes, at - locator_size + 8);
      if (!has_record(bytes, end64, end64_size, end64_mark))
        file.fail_at_byte(at - locator_size, "the zip archive's end record is not where it should be,", cut_off);
      directory = {value_at<std::uint64_t>(bytes, end64 + 48), value_at<std::uint64_t>(bytes, end64 + 40),
                   value_at<std::uint64_t>(bytes, end64 + 32)};
    }
    return directory;
  }
  file.fail_at_byte(bytes.size(), "the zip archive has no directory: the file ends", cut_off);
}

/// Numbers of 64 bits where those of the header are full.
void read_large_numbers(std::string_view extra, ZipMember& member) {
  for (std::size_t at = 0; at + 4 <= extra.size();) {
    const std::size_t size = value_at<std::uint16_t>(extra, at + 2);
    if (size > extra.size() - at - 4) return;
    if (value_at<std::uint16_t>(extra, at) == 1) {
      const std::size_t end = at + 4 + size;
      std::size_t from = at + 4;
      for (std::uint64_t* number : {&member.size, &member.packed, &member.header})
        if (*number == in_extra && from + 8 <= end) {
          *number = value_at<std::uint64_t>(extra, from);
          from += 8;
        }
      return;
    }
    at += 4 + size;
  }
}

[[noreturn]] void fail_member(const FileContent& file, const ZipMember& member, const std::string& cause,
                              const char* remedy = cut_off) {
  file.fail_at_byte(member.header, "member " + shown(member.name) + " " + cause + ", it begins", remedy);
}

std::string_view packed_bytes(const FileContent& file, const ZipMember& member) {
  constexpr std::size_t local_size = 30;
  const std::string_view bytes = file.bytes();
  if (!has_record(bytes, member.header, local_size, local_mark))
    fail_member(file, member, "is not where the directory says");
  const std::uint64_t begin = member.header + local_size + value_at<std::uint16_t>(bytes, member.header + 26) +
                              value_at<std::uint16_t>(bytes, member.header + 28);
  if (begin > bytes.size() || member.packed > bytes.size() - begin)
    fail_member(file, member, "has " + plural(member.packed, "byte") + ", but the file ends before");
  return bytes.substr(begin, member.packed);
}

/// zlib's stream, which must be given back.
class Inflater {
 public:
  Inflater() {
    constexpr int raw_stream = -15; // neither header nor checksum of its own
    if (inflateInit2(&stream_, raw_stream) != Z_OK) throw std::bad_alloc();
  }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;
  ~Inflater() { inflateEnd(&stream_); }

  /// \return true if the stream ends with exactly `size` bytes
  bool unpack(std::string_view packed, std::string& result, std::size_t size) {
    result.resize(size + 1); // room for a byte too many
    std::size_t in = 0, out = 0;
    for (;;) {
      constexpr std::size_t most = std::numeric_limits<uInt>::max();
      stream_.next_in = reinterpret_cast<const Bytef*>(packed.data()) + in;
      stream_.avail_in = static_cast<uInt>(std::min(most, packed.size() - in));
      stream_.next_out = reinterpret_cast<Bytef*>(result.data()) + out;
      stream_.avail_out = static_cast<uInt>(std::min(most, result.size() - out));
      const uInt in_before = stream_.avail_in, out_before = stream_.avail_out;
      const int status = inflate(&stream_, Z_NO_FLUSH);
      in += in_before - stream_.avail_in;
      out += out_before - stream_.avail_out;
      if (status == Z_STREAM_END) break;
      if (status != Z_OK || out > size) return false; // also where there is nothing more to read
    }
    result.resize(std::min(out, size));
    return out == size;
  }

 private:
  z_stream stream_{};
};

std::uint32_t crc_of(std::string_view bytes) {
  return static_cast<std::uint32_t>(crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

} // namespace

std::vector<ZipMember> read_zip_directory(const FileContent& file) {
  constexpr std::size_t central_size = 46;
  const std::string_view bytes = file.bytes();
  const Directory directory = find_directory(file);
  std::vector<ZipMember> members;
  std::uint64_t at = directory.begin;
  for (std::uint64_t i = 0; i < directory.entries; ++i) {
    if (!has_record(bytes, at, central_size, central_mark))
      file.fail_at_byte(std::min<std::uint64_t>(at, bytes.size()),
                        "entry " + std::to_string(i) + " of the zip archive's directory is missing", cut_off);
    const std::size_t name = value_at<std::uint16_t>(bytes, at + 28), extra = value_at<std::uint16_t>(bytes, at + 30),
                      comment = value_at<std::uint16_t>(bytes, at + 32);
    if (name + extra + comment > bytes.size() - at - central_size)
      file.fail_at_byte(bytes.size(), "the file ends within the zip archive's directory,", cut_off);
    ZipMember member;
    member.name = bytes.substr(at + central_size, name);
    member.flags = value_at<std::uint16_t>(bytes, at + 8);
    member.method = value_at<std::uint16_t>(bytes, at + 10);
    member.crc = value_at<std::uint32_t>(bytes, at + 16);
    member.packed = value_at<std::uint32_t>(bytes, at + 20);
    member.size = value_at<std::uint32_t>(bytes, at + 24);
    member.header = value_at<std::uint32_t>(bytes, at + 42);
    read_large_numbers(bytes.substr(at + central_size + name, extra), member);
    members.push_back(std::move(member));
    at += central_size + name + extra + comment;
  }
  return members;
}

std::string unpack_zip_member(const FileContent& file, const ZipMember& member, std::uint64_t& budget) {
  constexpr unsigned encrypted = 1, stored = 0, deflated = 8;
  constexpr std::uint64_t largest_ratio = 1032; // of deflate: two bits for 258 bytes
  if ((member.flags & encrypted) != 0) fail_member(file, member, "is encrypted", "write it without a password");
  if (member.method != stored && member.method != deflated)
    fail_member(file, member, "is compressed by method " + std::to_string(member.method),
                "store or deflate the members");
  const std::string_view packed = packed_bytes(file, member);
  if (member.method == stored ? member.size != packed.size() : member.size / largest_ratio > packed.size())
    fail_member(file, member,
                "cannot unpack from " + plural(member.packed, "byte") + " to " + std::to_string(member.size));
  if (member.size > budget)
    fail_member(file, member, "unpacks to " + plural(member.size, "byte") + ", too much for a file of this size",
                "unpack it, or store the members without compression");
  budget -= member.size;
  std::string bytes;
  if (member.method == stored)
    bytes = packed;
  else if (!Inflater().unpack(packed, bytes, member.size))
    fail_member(file, member, "is damaged");
  if (crc_of(bytes) != member.crc) fail_member(file, member, "is damaged: its checksum is wrong");
  return bytes;
}

} // namespace eigencrust::io
