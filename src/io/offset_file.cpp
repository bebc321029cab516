// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/offset_file.h"

#include <fstream>
#include <string_view>

#include <eigencrust/io.h>

#include "io/text_output.h"

namespace eigencrust {
namespace {

constexpr std::string_view mark = "# eigencrust: add these numbers to the coordinates of ";

} // namespace

std::filesystem::path offset_file(const std::filesystem::path& path) { return path.string() + ".offset.txt"; }

namespace io {

std::string three_numbers(const Vec3& v) {
  std::string text;
  for (const double value : {v.x, v.y, v.z}) {
    text += text.empty() ? "" : " ";
    append_number(text, value == 0 ? 0.0 : value); // no -0
  }
  return text;
}

std::string offset_text(const std::filesystem::path& result, const Vec3& offset) {
  return std::string(mark) + result.filename().string() + " to return to those of the input\n" + three_numbers(offset) +
         "\n";
}

bool is_offset_file(const std::filesystem::path& file) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) return false;
  std::string beginning(mark.size(), '\0');
  std::ifstream in(file, std::ios::binary);
  return in.read(beginning.data(), static_cast<std::streamsize>(beginning.size())) && beginning == mark;
}

} // namespace io
} // namespace eigencrust
