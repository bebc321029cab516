// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/e57_pages.h"

#include <bit>
#include <cstring>

#include "io/crc32c.h"
#include "io/text.h"

namespace eigencrust::io {
namespace {

static_assert(std::endian::native == std::endian::little, "E57 files are little-endian");

constexpr std::size_t header_size = 48, checksum_size = 4;

template <class T>
T load_from(std::string_view bytes, std::size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

/// The checksum is the one big-endian number of the format.
std::uint32_t stored_checksum(std::string_view page) {
  std::uint32_t value = 0;
  for (std::size_t i = page.size() - checksum_size; i < page.size(); ++i)
    value = value << 8 | static_cast<unsigned char>(page[i]);
  return value;
}

} // namespace

E57Pages::E57Pages(const FileContent& file) : file_(file) {
  const std::string_view all = file.bytes();
  if (!all.starts_with("ASTM-E57")) file.fail_at_byte(0, "no E57 signature", "use an E57 file");
  if (all.size() < header_size) file.fail_at_byte(all.size(), "the file ends within the E57 header", cut_off);
  if (load_from<std::uint32_t>(all, 8) != 1)
    file.fail_at_byte(8, "E57 version " + std::to_string(load_from<std::uint32_t>(all, 8)) + " is not known",
                      "use version 1");
  const auto length = load_from<std::uint64_t>(all, 16);
  page_size_ = load_from<std::uint64_t>(all, 40);
  // The standard has 1024; the header must fit into the first page, and a wrong number must not pass.
  if (page_size_ < 64 || page_size_ > 1 << 20 || !std::has_single_bit(page_size_))
    file.fail_at_byte(40, "a page size of " + plural(page_size_, "byte"), "the standard's pages have 1024 bytes");
  if (length > all.size())
    file.fail_at_byte(all.size(), "the file ends, but its header says that it has " + plural(length, "byte") + ",",
                      cut_off);
  if (length == 0 || length % page_size_ != 0)
    file.fail_at_byte(16, "a file length of " + plural(length, "byte") + " is not a number of whole pages", cut_off);

  logical_.reserve(length / page_size_ * (page_size_ - checksum_size));
  for (std::uint64_t begin = 0; begin < length; begin += page_size_) {
    const std::string_view page = all.substr(begin, page_size_);
    const std::string_view content = page.substr(0, page_size_ - checksum_size);
    if (crc32c(content) != stored_checksum(page))
      file.fail_at_byte(begin, "the checksum of page " + std::to_string(begin / page_size_) + " is wrong,",
                        "fetch the file again, it is damaged");
    logical_.append(content);
  }
  xml_length_ = load_from<std::uint64_t>(all, 32);
  xml_offset_ = find(load_from<std::uint64_t>(all, 24), xml_length_, "the XML section");
}

std::uint64_t E57Pages::find(std::uint64_t physical, std::uint64_t size, const std::string& what) const {
  const std::uint64_t in_page = physical % page_size_, content = page_size_ - checksum_size;
  const std::uint64_t logical = physical / page_size_ * content + in_page;
  if (in_page >= content || logical > logical_.size() || size > logical_.size() - logical)
    file_.fail_at_byte(physical, what + " of " + plural(size, "byte") + " is not inside the file", cut_off);
  return logical;
}

void E57Pages::fail_at(std::uint64_t logical, const std::string& cause, const std::string& remedy) const {
  const std::uint64_t content = page_size_ - checksum_size;
  file_.fail_at_byte(logical / content * page_size_ + logical % content, cause, remedy);
}

} // namespace eigencrust::io
