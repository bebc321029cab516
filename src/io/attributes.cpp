// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/attributes.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <eigencrust/error.h>
#include <eigencrust/io.h>

#include "io/colours.h"
#include "io/pose.h"
#include "io/text.h"
#include "surface/attributes.h"
#include "surface/scalar.h"

namespace eigencrust {
namespace {

/// The smallest type that holds all values of both.
ScalarType common_type(ScalarType a, ScalarType b) {
  if (a == b) return a;
  if (is_floating(a) || is_floating(b)) {
    // A float holds every integer of 16 bits, but not those of 32.
    const auto narrow = [](ScalarType t) { return t == ScalarType::float32 || size_of(t) <= 2; };
    return narrow(a) && narrow(b) ? ScalarType::float32 : ScalarType::float64;
  }
  const auto is_signed = [](ScalarType t) {
    return t == ScalarType::int8 || t == ScalarType::int16 || t == ScalarType::int32;
  };
  if (is_signed(a) == is_signed(b)) return size_of(a) > size_of(b) ? a : b;
  // Signed and unsigned: the signed type must have a bit more than the unsigned one.
  const std::size_t unsigned_size = size_of(is_signed(a) ? b : a), signed_size = size_of(is_signed(a) ? a : b);
  switch (std::max(2 * unsigned_size, signed_size)) {
    case 2:
      return ScalarType::int16;
    case 4:
      return ScalarType::int32;
    default:
      return ScalarType::float64;
  }
}

/// A scalar column as a list column whose rows all have one entry.
void make_list(Attribute& attribute) {
  if (attribute.is_list) return;
  const std::size_t rows = attribute.rows();
  attribute.offsets.resize(rows + 1);
  for (std::size_t i = 0; i <= rows; ++i) attribute.offsets[i] = i;
  attribute.is_list = true;
  attribute.count_type = ScalarType::uint8;
}

/// `rows` more rows that say "not known": empty lists, NaN or 0.
void append_missing(Attribute& attribute, std::size_t rows) {
  if (attribute.is_list) {
    if (attribute.offsets.empty()) attribute.offsets.push_back(0);
    const std::uint64_t end = attribute.offsets.back();
    attribute.offsets.resize(attribute.offsets.size() + rows, end);
    return;
  }
  const std::size_t begin = attribute.values.size();
  attribute.values.resize(begin + rows * size_of(attribute.type));
  if (!is_floating(attribute.type)) return;
  with_scalar(attribute.type, [&]<class T>(std::type_identity<T>) {
    const T nan = std::numeric_limits<T>::quiet_NaN();
    for (std::size_t i = 0; i < rows; ++i)
      std::memcpy(attribute.values.data() + begin + i * sizeof(T), &nan, sizeof(T));
  });
}

void append_rows(Attribute& attribute, Attribute next) {
  const ScalarType type = common_type(attribute.type, next.type);
  convert_to(attribute, type);
  convert_to(next, type);
  if (attribute.is_list || next.is_list) {
    make_list(attribute);
    make_list(next);
    const ScalarType count = common_type(attribute.count_type, next.count_type);
    attribute.count_type = is_floating(count) ? ScalarType::uint32 : count;
    if (attribute.offsets.empty()) attribute.offsets.push_back(0);
    const std::uint64_t end = attribute.offsets.back();
    for (std::size_t i = 1; i < next.offsets.size(); ++i) attribute.offsets.push_back(end + next.offsets[i]);
  }
  attribute.values.insert(attribute.values.end(), next.values.begin(), next.values.end());
}

void append_attributes(PointCloud& cloud, PointCloud& next) {
  const std::size_t rows = cloud.points.size();
  for (Attribute& attribute : cloud.attributes) {
    const auto same = std::find_if(next.attributes.begin(), next.attributes.end(),
                                   [&](const Attribute& other) { return other.name == attribute.name; });
    if (same == next.attributes.end()) {
      append_missing(attribute, next.points.size());
    } else {
      append_rows(attribute, std::move(*same));
      next.attributes.erase(same);
    }
  }
  for (Attribute& attribute : next.attributes) {
    Attribute first;
    first.name = attribute.name;
    first.type = attribute.type;
    first.is_list = attribute.is_list;
    first.count_type = attribute.count_type;
    append_missing(first, rows);
    append_rows(first, std::move(attribute));
    cloud.attributes.push_back(std::move(first));
  }
}

/// \return what was added to the scan numbers of `next`
std::uint32_t append_scan_index(PointCloud& cloud, const PointCloud& next) {
  const std::size_t rows = cloud.points.size();
  if (cloud.scan_index.empty()) cloud.scan_index.assign(rows, 0);
  const std::uint64_t first = 1 + std::uint64_t{*std::max_element(cloud.scan_index.begin(), cloud.scan_index.end())};
  const std::uint64_t last =
      next.scan_index.empty() ? 0 : *std::max_element(next.scan_index.begin(), next.scan_index.end());
  if (first + last > std::numeric_limits<std::uint32_t>::max())
    throw Error(ErrorKind::input, "scan index", "the scan numbers exceed 32 bits", "number the scans from 0");
  const auto shift = static_cast<std::uint32_t>(first);
  cloud.scan_index.reserve(rows + next.points.size());
  if (next.scan_index.empty()) cloud.scan_index.resize(rows + next.points.size(), shift);
  for (const std::uint32_t scan : next.scan_index) cloud.scan_index.push_back(scan + shift);
  return shift;
}

/// \param shift of the scan numbers of `next`
void append_cells(PointCloud& cloud, const PointCloud& next, std::uint32_t shift) {
  if (cloud.cell.empty() && next.cell.empty()) return;
  constexpr std::uint32_t most_scans = 1 << 20; // scan numbers may be any; grids are for those who count them
  if (shift > most_scans) {
    cloud.cell.clear();
    cloud.grids.clear();
    return;
  }
  cloud.cell.resize(cloud.points.size(), no_index);
  cloud.cell.insert(cloud.cell.end(), next.cell.begin(), next.cell.end());
  cloud.cell.resize(cloud.points.size() + next.points.size(), no_index);
  cloud.grids.resize(shift);
  cloud.grids.insert(cloud.grids.end(), next.grids.begin(), next.grids.end());
}

} // namespace

void append_scan(PointCloud& cloud, PointCloud next) {
  if (next.points.empty()) return;
  if (cloud.points.empty()) {
    cloud = std::move(next);
    return;
  }
  append_cells(cloud, next, append_scan_index(cloud, next));
  io::append_rows(cloud, std::move(next));
}

namespace io {

ScalarType attribute_type(NumberKind kind, std::size_t bytes) {
  if (kind == NumberKind::real) return bytes == 8 ? ScalarType::float64 : ScalarType::float32;
  const bool is_signed = kind == NumberKind::whole;
  switch (bytes) {
    case 1:
      return is_signed ? ScalarType::int8 : ScalarType::uint8;
    case 2:
      return is_signed ? ScalarType::int16 : ScalarType::uint16;
    case 4:
      return is_signed ? ScalarType::int32 : ScalarType::uint32;
    default:
      return ScalarType::float64;
  }
}

void append_rows(PointCloud& cloud, PointCloud next) {
  append_attributes(cloud, next);
  append_sensors(cloud, next);
  cloud.points.insert(cloud.points.end(), next.points.begin(), next.points.end());
}

std::string UniqueNames::operator()(const std::string& name) {
  if (taken_.insert(name).second) return name;
  std::uint64_t& suffix = last_suffix_.try_emplace(name, 1).first->second;
  for (;;) {
    std::string unique = name + "_" + std::to_string(++suffix);
    if (taken_.insert(unique).second) return unique;
  }
}

void warn_lost_attributes(const std::vector<Attribute>& attributes, const std::string& of, const ViewerColours* colours,
                          bool with_alpha, const std::string& format, std::vector<std::string>& warnings,
                          const std::vector<const Attribute*>& kept) {
  std::string names;
  for (const Attribute& attribute : attributes) {
    const bool is_colour = colours != nullptr && colours->is_source(attribute);
    const bool is_alpha = is_colour && colours->source.size() == 4 && colours->source.back() == &attribute;
    if (attribute.derived || (is_colour && (with_alpha || !is_alpha))) continue;
    if (std::find(kept.begin(), kept.end(), &attribute) != kept.end()) continue;
    names += (names.empty() ? "" : ", ") + attribute.name;
  }
  if (!names.empty()) warnings.push_back(format + " has no room for these attributes of the " + of + ": " + names);
}

void keep_rows(PointCloud& cloud, std::span<const std::uint32_t> rows) {
  for (std::size_t i = 0; i < rows.size(); ++i) cloud.points[i] = cloud.points[rows[i]];
  cloud.points.resize(rows.size());
  for (Attribute& attribute : cloud.attributes) attribute = gather(attribute, rows);
  for (auto* index : {&cloud.scan_index, &cloud.sensor_of}) {
    if (index->empty()) continue;
    for (std::size_t i = 0; i < rows.size(); ++i) (*index)[i] = (*index)[rows[i]];
    index->resize(rows.size());
  }
}

void check_attributes(const std::vector<Attribute>& attributes, std::size_t rows, const std::string& of) {
  for (const Attribute& attribute : attributes) {
    const std::size_t size = size_of(attribute.type);
    bool sound = attribute.values.size() % size == 0 && attribute.rows() == rows;
    if (attribute.is_list && sound && rows > 0)
      sound = attribute.offsets.front() == 0 && attribute.offsets.back() == attribute.values.size() / size &&
              std::is_sorted(attribute.offsets.begin(), attribute.offsets.end());
    if (!sound)
      throw Error(ErrorKind::usage, "attribute " + attribute.name,
                  "the attribute has " + plural(attribute.rows(), "row") + " for " + plural(rows, of),
                  "give every attribute as many rows as there are");
  }
}

} // namespace io
} // namespace eigencrust
