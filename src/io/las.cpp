// SPDX-License-Identifier: GPL-3.0-or-later
// LAS: points as whole numbers with a scale and an offset, in records of one size.
#include <algorithm>

#include "io/attributes.h"
#include "io/bytes.h"
#include "io/formats.h"
#include "io/las_header.h"
#include "io/text.h"

namespace eigencrust::io {
namespace {

using Rows = std::vector<const char*>; ///< where each point's record begins

/// "Withheld: this point should not be included in processing (synonymous with deleted)."
bool is_withheld(const LasHeader& header, const char* record) {
  const auto flags = static_cast<unsigned char>(record[15]);
  if (header.format >= 6) return (flags & 4u) != 0;
  return header.minor > 0 && (flags & 0x80u) != 0;
}

Rows find_rows(const FileContent& file, const LasHeader& header, std::vector<std::string>& notes) {
  Rows rows;
  rows.reserve(header.points);
  const char* record = file.bytes().data() + header.data_offset;
  for (std::uint64_t i = 0; i < header.points; ++i, record += header.record_bytes)
    if (!is_withheld(header, record)) rows.push_back(record);
  if (rows.size() < header.points)
    notes.push_back(plural(header.points - rows.size(), "point") + " marked as withheld left out");
  return rows;
}

Attribute read_field(const LasField& field, const Rows& rows) {
  Attribute attribute;
  attribute.name = field.name;
  attribute.type = field.type;
  const std::size_t size = size_of(field.type);
  attribute.values.resize(rows.size() * size);
  if (field.bits == 0) {
    for (std::size_t i = 0; i < rows.size(); ++i)
      std::memcpy(attribute.values.data() + i * size, rows[i] + field.offset, size);
  } else {
    const unsigned mask = (1u << field.bits) - 1;
    for (std::size_t i = 0; i < rows.size(); ++i)
      attribute.values[i] =
          static_cast<std::byte>(static_cast<unsigned char>(rows[i][field.offset]) >> field.shift & mask);
  }
  return attribute;
}

/// Type of the attribute where the values are taken as they are; float64 where no other holds them.
ScalarType raw_type(unsigned type) {
  using enum ScalarType;
  constexpr std::array<ScalarType, 11> types = {uint8, uint8,   int8,    uint16,  int16,  uint32,
                                                int32, float64, float64, float32, float64};
  return types[type];
}

double load_value(const char* from, unsigned type) {
  const auto value = [&]<class T>(T v) {
    std::memcpy(&v, from, sizeof v);
    return static_cast<double>(v);
  };
  switch (type) {
    case 1:
      return value(std::uint8_t{});
    case 2:
      return value(std::int8_t{});
    case 3:
      return value(std::uint16_t{});
    case 4:
      return value(std::int16_t{});
    case 5:
      return value(std::uint32_t{});
    case 6:
      return value(std::int32_t{});
    case 7:
      return value(std::uint64_t{});
    case 8:
      return value(std::int64_t{});
    case 9:
      return value(float{});
    default:
      return value(double{});
  }
}

Attribute read_extra(const LasExtra& extra, const Rows& rows) {
  const std::size_t size = las_type_size(extra.type);
  Attribute attribute;
  attribute.type = extra.scaled ? ScalarType::float64 : raw_type(extra.type);
  const bool as_it_is = !extra.scaled && extra.type != 7 && extra.type != 8;
  attribute.values.resize(rows.size() * extra.count * size_of(attribute.type));
  std::byte* to = attribute.values.data();
  for (const char* row : rows)
    for (std::size_t k = 0; k < extra.count; ++k, to += size_of(attribute.type)) {
      const char* from = row + extra.offset + k * size;
      const double value = as_it_is ? 0 : extra.scale[k] * load_value(from, extra.type) + extra.shift[k];
      if (as_it_is)
        std::memcpy(to, from, size);
      else
        std::memcpy(to, &value, sizeof value);
    }
  if (extra.count > 1) {
    attribute.is_list = true;
    attribute.offsets.resize(rows.size() + 1);
    for (std::size_t i = 0; i <= rows.size(); ++i) attribute.offsets[i] = i * extra.count;
  }
  return attribute;
}

} // namespace

PointCloud read_las(const FileContent& file, std::vector<std::string>& notes) {
  const LasHeader header = read_las_header(file, notes);
  const Rows rows = find_rows(file, header, notes);
  PointCloud cloud;
  cloud.points.reserve(rows.size());
  for (const char* row : rows) {
    const std::string_view record(row, 12);
    cloud.points.push_back({value_at<std::int32_t>(record, 0) * header.scale.x + header.offset.x,
                            value_at<std::int32_t>(record, 4) * header.scale.y + header.offset.y,
                            value_at<std::int32_t>(record, 8) * header.scale.z + header.offset.z});
  }
  UniqueNames unique;
  for (const LasField& field : header.fields) {
    unique(field.name);
    cloud.attributes.push_back(read_field(field, rows));
  }
  for (const LasExtra& extra : header.extras) {
    cloud.attributes.push_back(read_extra(extra, rows));
    cloud.attributes.back().name = unique(extra.name);
  }
  return cloud;
}

} // namespace eigencrust::io
