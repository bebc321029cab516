// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/pcd_header.h"

#include <algorithm>
#include <cmath>

#include "io/text.h"

namespace eigencrust::io {
namespace {

constexpr const char* pcd_header_help =
    "a PCD header has the lines VERSION, FIELDS, SIZE, TYPE, COUNT, WIDTH, HEIGHT, VIEWPOINT, POINTS, DATA";

class HeaderReader {
 public:
  explicit HeaderReader(const FileContent& file) : lines_(file) {}

  PcdHeader read() {
    while (lines_.next_filled('#')) {
      split_words(lines_.line(), words_);
      const std::string_view keyword = words_[0];
      words_.erase(words_.begin());
      if (keyword == "DATA") {
        take_encoding();
        finish();
        return header_;
      }
      take(keyword);
    }
    lines_.fail("the file ends before the line DATA of the header", pcd_header_help);
  }

 private:
  void take(std::string_view keyword) {
    if (keyword == "VERSION") return;
    if (keyword == "FIELDS" || keyword == "COLUMNS") return take_fields();
    if (keyword == "SIZE")
      return take_per_field(keyword, [](PcdField& f, std::string_view w) {
        std::uint64_t size = 0;
        const bool good = parse(w, size) && (size == 1 || size == 2 || size == 4 || size == 8);
        if (good) f.size = static_cast<std::size_t>(size);
        return good;
      });
    if (keyword == "TYPE")
      return take_per_field(keyword, [](PcdField& f, std::string_view w) {
        if (w == "I" || w == "U" || w == "F") f.type = w[0];
        return w == "I" || w == "U" || w == "F";
      });
    if (keyword == "COUNT")
      return take_per_field(keyword, [](PcdField& f, std::string_view w) {
        return parse(w, f.count) && f.count >= 1 && f.count <= 0xffffff;
      });
    if (keyword == "WIDTH") return take_number(width_);
    if (keyword == "HEIGHT") return take_number(height_);
    if (keyword == "POINTS") return take_number(points_);
    if (keyword == "VIEWPOINT") return take_viewpoint();
    lines_.fail(shown(keyword) + " is no keyword of a PCD header", pcd_header_help);
  }

  void take_fields() {
    if (!header_.fields.empty()) lines_.fail("a second line FIELDS", pcd_header_help);
    for (const std::string_view word : words_) header_.fields.push_back({std::string(word)});
    if (header_.fields.empty()) lines_.fail("FIELDS names no field", "name at least x, y and z");
  }

  template <class Take>
  void take_per_field(std::string_view keyword, Take&& take) {
    if (words_.size() != header_.fields.size())
      lines_.fail(std::string(keyword) + " has " + plural(words_.size(), "entry") + " for " +
                      plural(header_.fields.size(), "field"),
                  "give one entry for each of FIELDS, behind that line");
    for (std::size_t i = 0; i < words_.size(); ++i)
      if (!take(header_.fields[i], words_[i]))
        lines_.fail(shown(words_[i]) + " is no " + lower_case(keyword) + " of a field",
                    "SIZE is 1, 2, 4 or 8, TYPE is I, U or F, COUNT is 1 to 16777215");
  }

  void take_number(std::optional<std::uint64_t>& number) {
    std::uint64_t value = 0;
    if (words_.size() != 1 || !parse(words_[0], value)) lines_.fail("a whole number is expected", pcd_header_help);
    number = value;
  }

  void take_viewpoint() {
    std::array<double, 7> v{};
    bool good = words_.size() == v.size();
    for (std::size_t i = 0; good && i < v.size(); ++i) good = parse(words_[i], v[i]) && std::isfinite(v[i]);
    if (!good)
      lines_.fail("VIEWPOINT is not seven finite numbers", "write tx ty tz qw qx qy qz, or leave the line out");
    header_.viewpoint = v;
    header_.viewpoint_line = lines_.number();
  }

  void take_encoding() {
    const std::string word = words_.size() == 1 ? lower_case(words_[0]) : "";
    if (word == "ascii")
      header_.encoding = PcdEncoding::ascii;
    else if (word == "binary")
      header_.encoding = PcdEncoding::binary;
    else if (word == "binary_compressed")
      header_.encoding = PcdEncoding::binary_compressed;
    else
      lines_.fail("DATA is not ascii, binary or binary_compressed", "convert the file to one of these");
  }

  void finish() {
    if (header_.fields.empty()) lines_.fail("the header has no line FIELDS", pcd_header_help);
    for (const PcdField& f : header_.fields)
      if (f.type == 'F' && f.size < 4)
        lines_.fail("field " + shown(f.name) + " is a floating-point number of " + plural(f.size, "byte"),
                    "use SIZE 4 or 8 with TYPE F");
    if (header_.row_bytes() > 0xffffffff) lines_.fail("the fields are too long", "use smaller values of COUNT");
    if (!points_ && !width_) lines_.fail("the header says neither POINTS nor WIDTH", pcd_header_help);
    // An unorganized cloud of an old version has no WIDTH.
    const std::uint64_t width = width_.value_or(points_.value_or(0)), height = height_.value_or(1);
    if (height != 0 && width > 0xffffffffffffffff / height)
      lines_.fail("WIDTH x HEIGHT is too large", "correct the numbers");
    if (width_ && points_ && width * height != *points_)
      lines_.fail("POINTS is " + std::to_string(*points_) + ", but WIDTH x HEIGHT is " + std::to_string(width * height),
                  "make them agree");
    header_.points = points_ ? *points_ : width * height;
    header_.width = width;
    header_.height = height;
    header_.data_offset = lines_.offset();
    header_.lines = lines_.number();
  }

  LineScanner lines_;
  Fields words_;
  PcdHeader header_;
  std::optional<std::uint64_t> width_, height_, points_;
};

} // namespace

std::uint64_t PcdHeader::row_values() const {
  std::uint64_t values = 0;
  for (const PcdField& f : fields) values += f.count;
  return values;
}

std::uint64_t PcdHeader::row_bytes() const {
  std::uint64_t bytes = 0;
  for (const PcdField& f : fields) bytes += f.count * f.size;
  return bytes;
}

PcdHeader read_pcd_header(const FileContent& file) { return HeaderReader(file).read(); }

} // namespace eigencrust::io
