// SPDX-License-Identifier: GPL-3.0-or-later
#include <limits>

#include <eigencrust/io.h>

#include "io/scan_files.h"
#include "io/text.h"

namespace eigencrust {
namespace {

std::vector<std::uint32_t> read_numbers(const io::FileContent& file) {
  std::vector<std::uint32_t> scans;
  io::LineScanner lines(file);
  while (lines.next_filled('#')) {
    std::uint64_t scan = 0;
    if (!io::parse(lines.line(), scan) || scan > std::numeric_limits<std::uint32_t>::max())
      lines.fail(io::shown(lines.line()) + " is no scan number", "write one whole number from 0 on in each row");
    scans.push_back(static_cast<std::uint32_t>(scan));
  }
  return scans;
}

} // namespace

std::vector<std::uint32_t> io::read_scan_index(const io::FileContent& file, std::size_t points) {
  std::vector<std::uint32_t> scans;
  if (io::equal_ignoring_case(std::filesystem::path(file.name()).extension().string(), ".u8")) {
    for (const char c : file.bytes()) scans.push_back(static_cast<unsigned char>(c));
  } else {
    scans = read_numbers(file);
  }
  if (scans.size() != points)
    file.fail("the file holds " + io::plural(scans.size(), "scan number") + " for " + io::plural(points, "point"),
              "give exactly one number for each point");
  return scans;
}

std::vector<std::uint32_t> read_scan_index(const std::filesystem::path& path, std::size_t points) {
  return io::read_scan_index(io::FileContent(path), points);
}

} // namespace eigencrust
