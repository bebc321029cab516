// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>
#include <utility>

#include "io/ply.h"
#include "io/text.h"
#include "surface/scalar.h"

namespace eigencrust::io {
namespace {

/// Both spellings of each type; the first of a type is the one written.
constexpr std::array<std::pair<std::string_view, ScalarType>, 16> type_names = {{
    {"char", ScalarType::int8},
    {"uchar", ScalarType::uint8},
    {"short", ScalarType::int16},
    {"ushort", ScalarType::uint16},
    {"int", ScalarType::int32},
    {"uint", ScalarType::uint32},
    {"float", ScalarType::float32},
    {"double", ScalarType::float64},
    {"int8", ScalarType::int8},
    {"uint8", ScalarType::uint8},
    {"int16", ScalarType::int16},
    {"uint16", ScalarType::uint16},
    {"int32", ScalarType::int32},
    {"uint32", ScalarType::uint32},
    {"float32", ScalarType::float32},
    {"float64", ScalarType::float64},
}};

ScalarType parse_type(std::string_view word, const LineScanner& lines) {
  for (const auto& [name, type] : type_names)
    if (word == name) return type;
  lines.fail("unknown PLY property type " + shown(word), "use char, uchar, short, ushort, int, uint, float or double");
}

PlyEncoding parse_format(const Fields& words, const LineScanner& lines) {
  if (words.size() >= 2) {
    if (words[1] == "ascii") return PlyEncoding::ascii;
    if (words[1] == "binary_little_endian") return PlyEncoding::little_endian;
    if (words[1] == "binary_big_endian") return PlyEncoding::big_endian;
  }
  lines.fail("unknown PLY format " + shown(words.size() >= 2 ? words[1] : ""),
             "write ascii, binary_little_endian or binary_big_endian");
}

PlyElement parse_element(const Fields& words, const LineScanner& lines) {
  PlyElement element;
  if (words.size() != 3 || !is_digit(words[2][0]) || !parse(words[2], element.count))
    lines.fail("malformed PLY element " + shown(lines.line()), "write: element NAME COUNT");
  element.name = words[1];
  element.line = lines.number();
  return element;
}

PlyProperty parse_property(const Fields& words, const LineScanner& lines) {
  PlyProperty property;
  property.is_list = words.size() >= 2 && words[1] == "list";
  if (words.size() != (property.is_list ? 5u : 3u))
    lines.fail("malformed PLY property " + shown(lines.line()), "write: property TYPE NAME");
  property.name = words.back();
  property.type = parse_type(words[words.size() - 2], lines);
  if (property.is_list) {
    property.count_type = parse_type(words[2], lines);
    if (is_floating(property.count_type))
      lines.fail("the length of a PLY list is not an integer", "declare it as uchar, ushort or uint");
  }
  return property;
}

} // namespace

const char* ply_type_name(ScalarType type) {
  for (const auto& [name, named] : type_names)
    if (named == type) return name.data();
  return "";
}

PlyHeader read_ply_header(const FileContent& file) {
  LineScanner lines(file);
  if (!lines.next() || trim(lines.line()) != "ply")
    file.fail_at_line(1, "this is no PLY file: it does not begin with 'ply'", "check the format");
  PlyHeader header;
  bool has_format = false;
  Fields words;
  while (lines.next()) {
    split_words(lines.line(), words);
    if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
    if (words[0] == "format") {
      header.encoding = parse_format(words, lines);
      has_format = true;
    } else if (words[0] == "element") {
      header.elements.push_back(parse_element(words, lines));
    } else if (words[0] == "property") {
      if (header.elements.empty()) lines.fail("a PLY property before the first element", "repair the header");
      header.elements.back().properties.push_back(parse_property(words, lines));
    } else if (words[0] == "end_header") {
      if (!has_format) lines.fail("the PLY header names no format", "add: format ascii 1.0");
      header.data_offset = lines.offset();
      header.lines = lines.number();
      return header;
    } else {
      lines.fail("unknown line " + shown(words[0]) + " in the PLY header", "repair the header");
    }
  }
  lines.fail("the PLY header has no end_header", "the file is cut off or damaged: fetch it again");
}

} // namespace eigencrust::io
