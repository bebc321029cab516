// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The outermost layer of an E57 file (ASTM E2807): pages that end in a checksum.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "io/file_content.h"

namespace eigencrust::io {

/// What remains of an E57 file without the checksums. Offsets into that are called logical, those into
/// the file physical.
class E57Pages {
 public:
  /// Reads the header and checks every page. \throws Error{input} naming the byte
  explicit E57Pages(const FileContent& file);

  [[nodiscard]] std::string_view bytes() const { return logical_; }
  /// The XML section.
  [[nodiscard]] std::string_view xml() const { return bytes().substr(xml_offset_, xml_length_); }
  [[nodiscard]] std::uint64_t xml_offset() const { return xml_offset_; } ///< logical

  /// The logical offset of `size` bytes at a physical one. \throws Error{input} when they are not all there
  /// \param what for the message: "the XML section"
  [[nodiscard]] std::uint64_t find(std::uint64_t physical, std::uint64_t size, const std::string& what) const;

  /// A little-endian number of the given type at a logical offset, which must be inside.
  template <class T>
  [[nodiscard]] T load(std::uint64_t logical) const {
    T value{};
    logical_.copy(reinterpret_cast<char*>(&value), sizeof value, logical);
    return value;
  }

  /// \throws Error{input} at a logical offset
  [[noreturn]] void fail_at(std::uint64_t logical, const std::string& cause, const std::string& remedy) const;

 private:
  const FileContent& file_;
  std::string logical_;
  std::uint64_t page_size_ = 0, xml_offset_ = 0, xml_length_ = 0;
};

} // namespace eigencrust::io
