// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/e57_columns.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "io/text.h"

namespace eigencrust::io {
namespace {

constexpr const char* damaged = "fetch the file again, it may be cut off or damaged";
constexpr std::uint64_t section_header_size = 32, packet_header_size = 4;
enum Packet : std::uint8_t { index_packet = 0, data_packet = 1, empty_packet = 2 };

/// Bytes that hold `records` values of a field.
std::uint64_t stream_size(const E57Field& field, std::uint64_t records) { return (records * field.bits() + 7) / 8; }

class SectionReader {
 public:
  SectionReader(const E57Pages& pages, const E57Scan& scan) : pages_(pages), scan_(scan), streams_(scan.fields.size()) {
    begin_ = pages.find(scan.file_offset, section_header_size, "the binary section of a scan");
    if (pages.load<std::uint8_t>(begin_) != 1) pages.fail_at(begin_, "no binary section of points begins", damaged);
    const auto length = pages.load<std::uint64_t>(begin_ + 8);
    end_ = pages.find(scan.file_offset, length, "the binary section of a scan") + length;
    position_ = pages.find(pages.load<std::uint64_t>(begin_ + 16), 0, "the first packet of a scan");
    first_ = position_;
  }

  void read() {
    while (!is_complete()) {
      if (!next_data_packet()) {
        for (std::size_t i = 0; i < streams_.size(); ++i)
          if (streams_[i].size() < stream_size(scan_.fields[i], scan_.records))
            pages_.fail_at(position_,
                           "the section ends, but field " + shown(scan_.fields[i].name) + " has only " +
                               plural(streams_[i].size(), "byte") + " for " + plural(scan_.records, "point"),
                           damaged);
      }
    }
  }

  std::vector<std::string> take_streams() { return std::move(streams_); }
  /// Bytes walked through.
  [[nodiscard]] std::uint64_t size() const { return position_ - first_; }
  [[nodiscard]] std::uint64_t section_begin() const { return begin_; }

 private:
  [[nodiscard]] bool is_complete() const {
    for (std::size_t i = 0; i < streams_.size(); ++i)
      if (streams_[i].size() < stream_size(scan_.fields[i], scan_.records)) return false;
    return true;
  }

  /// Appends the pieces of the next data packet; false at the end of the section.
  bool next_data_packet() {
    for (;;) {
      if (position_ >= end_) return false;
      if (end_ - position_ < packet_header_size) pages_.fail_at(position_, "a packet is cut off", damaged);
      const auto type = pages_.load<std::uint8_t>(position_);
      const std::uint64_t length = std::uint64_t{pages_.load<std::uint16_t>(position_ + 2)} + 1;
      if (type > empty_packet || length < packet_header_size || length > end_ - position_)
        pages_.fail_at(position_, "no packet of points begins", damaged);
      if (type == data_packet) read_pieces(length);
      position_ += length;
      if (type == data_packet) return true;
    }
  }

  void read_pieces(std::uint64_t length) {
    const std::uint64_t lengths = position_ + packet_header_size + 2;
    const std::uint64_t table_end = packet_header_size + 2 + 2 * streams_.size();
    if (length < table_end || pages_.load<std::uint16_t>(position_ + packet_header_size) != streams_.size())
      pages_.fail_at(position_, "a packet of points does not have " + plural(streams_.size(), "stream"), damaged);
    std::uint64_t from = table_end;
    for (std::size_t i = 0; i < streams_.size(); ++i) {
      const auto piece = pages_.load<std::uint16_t>(lengths + 2 * i);
      if (piece > length - from) pages_.fail_at(position_, "the streams of a packet are longer than it", damaged);
      // The streams of text are not used.
      if (scan_.fields[i].kind != E57Field::Kind::text)
        streams_[i].append(pages_.bytes().substr(position_ + from, piece));
      from += piece;
    }
  }

  const E57Pages& pages_;
  const E57Scan& scan_;
  std::uint64_t begin_ = 0, end_ = 0, position_ = 0, first_ = 0;
  std::vector<std::string> streams_;
};

/// Values of up to 64 bits, one after another, least significant bit first.
class BitReader {
 public:
  BitReader(const std::string& bytes, unsigned width) : bytes_(bytes), width_(width) {}

  std::uint64_t next() {
    if (width_ == 0) return 0;
    const std::uint64_t byte = bit_ / 8;
    const auto shift = static_cast<unsigned>(bit_ % 8);
    bit_ += width_;
    std::uint64_t value = load(byte) >> shift;
    if (shift + width_ > 64) value |= load(byte + 8) << (64 - shift);
    return width_ == 64 ? value : value & ((std::uint64_t{1} << width_) - 1);
  }

 private:
  /// Eight bytes; zeros behind the end.
  [[nodiscard]] std::uint64_t load(std::uint64_t at) const {
    std::uint64_t value = 0;
    if (at < bytes_.size()) std::memcpy(&value, bytes_.data() + at, std::min<std::uint64_t>(8, bytes_.size() - at));
    return value;
  }

  const std::string& bytes_;
  unsigned width_;
  std::uint64_t bit_ = 0;
};

} // namespace

std::vector<std::string> read_e57_streams(const E57Pages& pages, const E57Scan& scan, E57Budget& budget) {
  if (scan.records == 0) return std::vector<std::string>(scan.fields.size());
  bool constant = true;
  for (const E57Field& f : scan.fields) constant = constant && f.bits() == 0;
  if (constant) {
    // Nothing in the binary section bears the number of points out.
    if (scan.records > budget.records)
      pages.fail_at(
          scan.xml,
          plural(scan.records, "point") + " whose columns are all constant, which is more than the file has bytes,",
          "correct recordCount, or the minimum and maximum of the fields");
    budget.records -= scan.records;
    return std::vector<std::string>(scan.fields.size());
  }
  SectionReader section(pages, scan);
  section.read();
  if (section.size() > budget.bytes)
    pages.fail_at(section.section_begin(), "the scans share their bytes", "correct the fileOffset of each scan");
  budget.bytes -= section.size();
  return section.take_streams();
}

std::vector<double> unpack_e57(const E57Field& field, const std::string& stream, std::uint64_t records) {
  std::vector<double> values(records);
  BitReader reader(stream, field.bits());
  for (double& value : values) {
    const std::uint64_t bits = reader.next();
    switch (field.kind) {
      case E57Field::Kind::float32:
        value = static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(bits)));
        break;
      case E57Field::Kind::float64:
        value = std::bit_cast<double>(bits);
        break;
      case E57Field::Kind::integer:
      case E57Field::Kind::scaled:
        value = static_cast<double>(static_cast<std::int64_t>(static_cast<std::uint64_t>(field.minimum) + bits));
        if (field.kind == E57Field::Kind::scaled) value = value * field.scale + field.offset;
        break;
      case E57Field::Kind::text:
        break;
    }
  }
  return values;
}

} // namespace eigencrust::io
