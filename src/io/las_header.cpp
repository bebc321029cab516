// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/las_header.h"

#include <cmath>

#include "io/bytes.h"
#include "io/text.h"

namespace eigencrust::io {
namespace {

constexpr const char* repair = "write the file anew with the program that made it";

constexpr std::size_t smallest_header = 227; ///< of versions 1.0 to 1.2
constexpr std::size_t header_1_4 = 375;
constexpr std::array<std::size_t, 11> record_sizes = {20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};

/// Variable length records: what else a file says of its points.
struct Records {
  bool compressed = false, cloud_optimized = false;
  std::vector<std::pair<std::size_t, std::size_t>> extra_bytes; ///< begin and size of each description
};

std::string text_at(std::string_view bytes, std::size_t at, std::size_t size) {
  const std::string_view text = bytes.substr(at, size);
  return std::string(text.substr(0, text.find('\0')));
}

/// The records need not be sound: what lies beyond the points' beginning is not looked at.
Records read_records(std::string_view bytes, std::size_t begin, std::size_t end, std::uint32_t count,
                     std::vector<std::string>& notes) {
  constexpr std::size_t head = 54;
  Records records;
  end = std::min(end, bytes.size());
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::size_t size = begin + head <= end ? value_at<std::uint16_t>(bytes, begin + 20) : 0;
    if (begin + head > end || size > end - begin - head) {
      notes.push_back("the header promises " + plural(count, "variable length record") + ", there is room for " +
                      std::to_string(i) + ": the others are not looked at");
      break;
    }
    const std::string user = text_at(bytes, begin + 2, 16);
    const auto id = value_at<std::uint16_t>(bytes, begin + 18);
    if (user == "copc") records.cloud_optimized = true;
    if (user == "laszip encoded" && id == 22204) records.compressed = true;
    if (user == "LASF_Spec" && id == 4) records.extra_bytes.emplace_back(begin + head, size);
    begin += head + size;
  }
  return records;
}

/// One description of 192 bytes. \return false for bytes without meaning
bool describe(std::string_view bytes, std::size_t at, LasExtra& extra, std::size_t& size) {
  const unsigned type = value_at<std::uint8_t>(bytes, at + 2), options = value_at<std::uint8_t>(bytes, at + 3);
  if (type == 0 || type > 30) { // "undocumented": the options hold the number of bytes
    size = type == 0 ? options : 0;
    return false;
  }
  extra.name = text_at(bytes, at + 4, 32);
  if (extra.name.empty()) extra.name = "extra_bytes";
  // Types 11 to 20 and 21 to 30 (deprecated) are pairs and triples of types 1 to 10.
  extra.type = (type - 1) % 10 + 1;
  extra.count = (type - 1) / 10 + 1;
  size = las_type_size(extra.type) * extra.count;
  const bool has_scale = (options & 8u) != 0, has_shift = (options & 16u) != 0;
  extra.scaled = has_scale || has_shift;
  for (std::size_t k = 0; k < 3; ++k) {
    if (has_scale) extra.scale[k] = value_at<double>(bytes, at + 112 + 8 * k);
    if (has_shift) extra.shift[k] = value_at<double>(bytes, at + 136 + 8 * k);
  }
  return true;
}

void read_extras(std::string_view bytes, const Records& records, LasHeader& header, std::vector<std::string>& notes) {
  constexpr std::size_t description = 192;
  std::size_t used = record_sizes[header.format], without = 0;
  for (const auto& [begin, length] : records.extra_bytes)
    for (std::size_t at = begin; at + description <= begin + length; at += description) {
      LasExtra extra;
      std::size_t size = 0;
      const bool known = describe(bytes, at, extra, size);
      if (size > header.record_bytes - used) {
        notes.push_back("extra bytes " + shown(extra.name) + " do not fit into the points: left out");
        return;
      }
      extra.offset = used;
      used += size;
      if (known)
        header.extras.push_back(std::move(extra));
      else
        without += size;
    }
  without += header.record_bytes - used;
  if (without > 0) notes.push_back(plural(without, "byte") + " of each point without a description left out");
}

Vec3 numbers_at(const FileContent& file, std::size_t at, const char* what) {
  const std::string_view bytes = file.bytes();
  const Vec3 v{value_at<double>(bytes, at), value_at<double>(bytes, at + 8), value_at<double>(bytes, at + 16)};
  if (!is_finite(v)) file.fail_at_byte(at, std::string("the ") + what + " of the coordinates is not finite,", repair);
  return v;
}

/// Version, format and sizes. \return the raw byte of the point format, whose upper bits say "compressed"
unsigned read_layout(const FileContent& file, LasHeader& header, std::size_t& header_size) {
  const std::string_view bytes = file.bytes();
  if (!bytes.starts_with("LASF")) file.fail("this is no LAS file: it does not begin with LASF", "check the format");
  if (bytes.size() < smallest_header) file.fail_at_byte(bytes.size(), "the file ends within its header,", cut_off);
  const unsigned major = value_at<std::uint8_t>(bytes, 24);
  header.minor = value_at<std::uint8_t>(bytes, 25);
  if (major != 1 || header.minor > 4)
    file.fail_at_byte(24,
                      "LAS version " + std::to_string(major) + "." + std::to_string(header.minor) + " is not known,",
                      "convert the file to LAS 1.4 or earlier");
  header_size = value_at<std::uint16_t>(bytes, 94);
  header.data_offset = value_at<std::uint32_t>(bytes, 96);
  const unsigned format = value_at<std::uint8_t>(bytes, 104);
  header.format = format & 0x3fu;
  header.record_bytes = value_at<std::uint16_t>(bytes, 105);
  if (header_size < smallest_header)
    file.fail_at_byte(94, "a header of " + plural(header_size, "byte") + " is too short,", repair);
  if (header.data_offset < header_size)
    file.fail_at_byte(
        96, "the points would begin at byte " + std::to_string(header.data_offset) + ", within the header,", repair);
  return format;
}

void check_points(const FileContent& file, LasHeader& header, std::size_t header_size) {
  const std::string_view bytes = file.bytes();
  if (header.format >= record_sizes.size())
    file.fail_at_byte(104, "point format " + std::to_string(header.format) + " is not known,",
                      "convert the points to one of the formats 0 to 10");
  if (header.record_bytes < record_sizes[header.format])
    file.fail_at_byte(105,
                      plural(header.record_bytes, "byte") + " are too few for points of format " +
                          std::to_string(header.format) + ",",
                      repair);
  header.points = value_at<std::uint32_t>(bytes, 107);
  if (header.minor >= 4 && header_size >= header_1_4 && bytes.size() >= header_1_4)
    if (const auto wide = value_at<std::uint64_t>(bytes, 247); wide != 0) header.points = wide;
  const std::size_t left = bytes.size() - std::min(bytes.size(), header.data_offset);
  if (header.points > left / header.record_bytes)
    file.fail_at_byte(bytes.size(),
                      "the header promises " + plural(header.points, "point") + " of " +
                          plural(header.record_bytes, "byte") + ", but the file ends",
                      cut_off);
}

} // namespace

std::size_t las_type_size(unsigned type) {
  constexpr std::array<std::size_t, 11> sizes = {0, 1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
  return type < sizes.size() ? sizes[type] : 0;
}

std::vector<LasField> las_fields(unsigned format, unsigned minor) {
  using enum ScalarType;
  std::vector<LasField> fields = {{"intensity", uint16, 12}};
  const auto add = [&](std::initializer_list<LasField> more) { fields.insert(fields.end(), more); };
  const bool is_new = format >= 6;
  const std::size_t time = is_new ? 22 : 20;
  std::size_t colour = is_new ? 30 : format == 2 ? 20 : 28;
  if (is_new)
    add({{"return_number", uint8, 14, 0, 4},
         {"number_of_returns", uint8, 14, 4, 4},
         {"synthetic", uint8, 15, 0, 1},
         {"key_point", uint8, 15, 1, 1},
         {"overlap", uint8, 15, 3, 1},
         {"scanner_channel", uint8, 15, 4, 2},
         {"scan_direction_flag", uint8, 15, 6, 1},
         {"edge_of_flight_line", uint8, 15, 7, 1},
         {"classification", uint8, 16},
         {"user_data", uint8, 17},
         {"scan_angle", int16, 18},
         {"point_source_id", uint16, 20}});
  else
    add({{"return_number", uint8, 14, 0, 3},
         {"number_of_returns", uint8, 14, 3, 3},
         {"scan_direction_flag", uint8, 14, 6, 1},
         {"edge_of_flight_line", uint8, 14, 7, 1}});
  if (!is_new && minor == 0) add({{"classification", uint8, 15}}); // 1.0 knows no flags
  if (!is_new && minor > 0)
    add({{"classification", uint8, 15, 0, 5}, {"synthetic", uint8, 15, 5, 1}, {"key_point", uint8, 15, 6, 1}});
  if (!is_new) add({{"scan_angle_rank", int8, 16}, {"user_data", uint8, 17}, {"point_source_id", uint16, 18}});
  if (is_new || format == 1 || format >= 3) add({{"gps_time", float64, time}});
  if (format == 2 || format == 3 || format == 5 || format == 7 || format == 8 || format == 10)
    add({{"red", uint16, colour}, {"green", uint16, colour + 2}, {"blue", uint16, colour + 4}});
  if (format == 8 || format == 10) add({{"nir", uint16, colour + 6}});
  return fields;
}

std::size_t las_record_bytes(unsigned format) { return record_sizes[format]; }

LasHeader read_las_header(const FileContent& file, std::vector<std::string>& notes) {
  LasHeader header;
  std::size_t header_size = 0;
  const unsigned raw_format = read_layout(file, header, header_size);
  const std::string_view bytes = file.bytes();
  const Records records =
      read_records(bytes, header_size, header.data_offset, value_at<std::uint32_t>(bytes, 100), notes);
  if (raw_format != header.format || records.compressed || records.cloud_optimized)
    file.fail_at_byte(104,
                      std::string("the points are compressed (") + (records.cloud_optimized ? "COPC" : "LAZ") +
                          "), which is not read,",
                      "unpack the file: laszip -i FILE -o FILE.las, or pdal translate FILE FILE.las");
  check_points(file, header, header_size);
  header.scale = numbers_at(file, 131, "scale");
  header.offset = numbers_at(file, 155, "offset");
  if (header.scale.x == 0 || header.scale.y == 0 || header.scale.z == 0)
    file.fail_at_byte(131, "a scale of the coordinates is 0,", repair);
  header.fields = las_fields(header.format, header.minor);
  read_extras(bytes, records, header, notes);
  return header;
}

} // namespace eigencrust::io
