// SPDX-License-Identifier: GPL-3.0-or-later
// LAS 1.4 with points of format 6 to 8 (ASPRS, "LAS Specification 1.4 - R15"): what the format has no field for goes
// into extra bytes. No date is written: the same points make the same file.
#include <algorithm>
#include <array>
#include <cmath>

#include <eigencrust/error.h>

#include "io/attributes.h"
#include "io/binary_output.h"
#include "io/colours.h"
#include "io/formats.h"
#include "io/las_header.h"
#include "io/precision.h"
#include "io/text.h"

namespace eigencrust::io {
namespace {

constexpr std::size_t header_bytes = 375, record_head = 54, description_bytes = 192, name_bytes = 32;
constexpr double most_colour = 65535;
constexpr std::size_t most_extras = 0xffff / description_bytes; ///< what one record can describe

struct Column {
  const Attribute* attribute; ///< null: of the colour
  LasField field;             ///< bits > 0: only these of one byte
  std::size_t channel;        ///< 0 to 2 where it is one of red, green and blue
};
struct Extra {
  const Attribute* attribute;
  std::string name;
};

struct Layout {
  unsigned format = 6;
  Vec3 scale, offset;
  std::vector<std::uint32_t> rows; ///< with finite coordinates
  std::optional<ViewerColours> colours;
  std::vector<Column> columns;
  std::vector<Extra> extras;
  bool has_returns = false;
  std::size_t record_bytes = 0;
};

/// 0 to 2 for red, green and blue, 3 for all others.
std::size_t channel_of(std::string_view name) {
  return name == "red" ? 0 : name == "green" ? 1 : name == "blue" ? 2 : 3;
}

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

/// Do all values fit into the field without loss?
bool fits(const Attribute& a, const LasField& field) {
  if (a.is_list) return false;
  if (field.type == ScalarType::float64) return true;
  const double most =
      field.bits > 0 ? (1u << field.bits) - 1 : std::ldexp(1.0, static_cast<int>(8 * size_of(field.type)));
  const bool is_signed = field.type == ScalarType::int16;
  const double highest = field.bits > 0 ? most
                         : is_signed    ? most / 2 - 1
                                        : most - 1,
               lowest = is_signed ? -most / 2 : 0;
  for (std::size_t i = 0; i < a.rows(); ++i) {
    const double v = attribute_value(a, i);
    if (!(v >= lowest && v <= highest && v == std::floor(v))) return false;
  }
  return true;
}

const Attribute* find_fitting(const PointCloud& cloud, const LasField& field) {
  for (const Attribute& a : cloud.attributes)
    if (lower(a.name) == field.name) return fits(a, field) ? &a : nullptr;
  return nullptr;
}

/// Are the columns red, green and blue of bytes, or of 16 bits that are used? Then the fields hold all that they say.
bool are_held(const ViewerColours& colours) {
  constexpr std::array names{"red", "green", "blue"};
  if (colours.plain) return true;
  bool held = colours.source.size() >= 3;
  for (std::size_t k = 0; held && k < 3; ++k) {
    const Attribute& a = *colours.source[k];
    const bool wide = a.type == ScalarType::uint16 && colours.share == 1.0 / most_colour;
    held = a.name == names[k] && (wide || a.type == ScalarType::uint8);
  }
  return held;
}

void choose_columns(const PointCloud& cloud, Layout& layout, std::vector<std::string>& warnings) {
  std::vector<const Attribute*> placed;
  const std::optional<ViewerColours>& colours = layout.colours = find_colours(cloud.attributes);
  const bool held = colours && are_held(*colours);
  if (colours) {
    layout.format = 7;
    for (const LasField& field : las_fields(8, 4))
      if (std::string_view(field.name) == "nir" && find_fitting(cloud, field) != nullptr) layout.format = 8;
  }
  for (const LasField& field : las_fields(layout.format, 4)) {
    const std::string_view name = field.name;
    const std::size_t channel = channel_of(name);
    if (channel < 3) {
      layout.columns.push_back({nullptr, field, channel});
      if (held) placed.push_back(colours->source[channel]);
      continue;
    }
    const Attribute* a = find_fitting(cloud, field);
    if (a == nullptr) continue;
    layout.has_returns = layout.has_returns || name == "return_number";
    layout.columns.push_back({a, field, channel});
    placed.push_back(a);
  }
  layout.record_bytes = las_record_bytes(layout.format);
  UniqueNames unique;
  for (const Attribute& a : cloud.attributes) {
    if (std::find(placed.begin(), placed.end(), &a) != placed.end()) continue;
    if (a.is_list || layout.extras.size() == most_extras) {
      warnings.push_back("LAS has no room for the attribute " + a.name);
      continue;
    }
    const bool is_taken = colours && channel_of(lower(a.name)) < 3;
    layout.extras.push_back({&a, unique(is_taken ? lower(a.name) + "_original" : a.name.substr(0, name_bytes - 4))});
    if (layout.extras.back().name != a.name)
      warnings.push_back("attribute '" + a.name + "' is written as '" + layout.extras.back().name + "'");
    layout.record_bytes += size_of(a.type);
  }
}

/// A step, a power of ten, that 31 bits reach across the box and that is a thousandth of the spacing where possible.
double choose_step(double extent, double spacing) {
  constexpr double reach = 1073741824; // 2^30: the offset may lie as much as the extent below the smallest number
  const double coarsest = std::max(extent, 1e-300) / reach;
  const double wanted = spacing > 0 ? 1e-3 * spacing : coarsest;
  return std::pow(10, std::max(std::ceil(std::log10(coarsest)), std::floor(std::log10(wanted))));
}

void choose_grid(const PointCloud& cloud, double spacing, Layout& layout, std::vector<std::string>& warnings) {
  Box3 box;
  for (std::uint32_t i = 0; i < cloud.points.size(); ++i) {
    if (!is_finite(cloud.points[i])) continue;
    layout.rows.push_back(i);
    box.add(cloud.points[i]);
  }
  if (layout.rows.size() < cloud.points.size())
    warnings.push_back("LAS has no room for points that are not finite: " +
                       plural(cloud.points.size() - layout.rows.size(), "row") + " left out");
  layout.scale = {1, 1, 1};
  if (layout.rows.empty()) return;
  for (double Vec3::*axis : {&Vec3::x, &Vec3::y, &Vec3::z}) {
    const double extent = box.max.*axis - box.min.*axis;
    const double step = choose_step(extent, spacing);
    const double unit = std::max(step, std::pow(10, std::floor(std::log10(std::max(extent, step)))));
    layout.scale.*axis = step;
    layout.offset.*axis = std::floor(box.min.*axis / unit) * unit;
    if (spacing > 0 && step > 2e-3 * spacing)
      warnings.emplace_back("LAS rounds the coordinates to " + std::to_string(step));
  }
}

/// Bytes at fixed places; the rest stays 0.
class Bytes {
 public:
  explicit Bytes(std::size_t size) : bytes_(size, std::byte{0}) {}
  template <class T>
  void put(std::size_t at, T value) {
    std::memcpy(bytes_.data() + at, &value, sizeof value);
    if constexpr (std::endian::native == std::endian::big)
      swap_bytes(std::span(bytes_).subspan(at, sizeof value), sizeof value);
  }
  void put(std::size_t at, std::size_t most, const std::string& text) {
    std::memcpy(bytes_.data() + at, text.data(), std::min(text.size(), most));
  }
  void put_bits(std::size_t at, unsigned shift, unsigned value) {
    bytes_[at] |= static_cast<std::byte>(value << shift & 0xffu);
  }
  [[nodiscard]] const std::vector<std::byte>& all() const { return bytes_; }

 private:
  std::vector<std::byte> bytes_;
};

unsigned las_type(ScalarType type) {
  using enum ScalarType;
  switch (type) {
    case uint8:
      return 1;
    case int8:
      return 2;
    case uint16:
      return 3;
    case int16:
      return 4;
    case uint32:
      return 5;
    case int32:
      return 6;
    case float32:
      return 9;
    case float64:
      break;
  }
  return 10;
}

Bytes describe(const Layout& layout) {
  const std::size_t size = description_bytes * layout.extras.size();
  Bytes record(record_head + size);
  record.put(2, 16, "LASF_Spec");
  record.put(18, std::uint16_t{4});
  record.put(20, static_cast<std::uint16_t>(size));
  record.put(22, 32, "extra bytes");
  for (std::size_t i = 0; i < layout.extras.size(); ++i) {
    const std::size_t at = record_head + i * description_bytes;
    record.put(at + 2, static_cast<std::uint8_t>(las_type(layout.extras[i].attribute->type)));
    record.put(at + 4, name_bytes, layout.extras[i].name);
  }
  return record;
}

/// How many points are the first, second ... return of their pulse.
std::array<std::uint64_t, 15> count_returns(const Layout& layout) {
  std::array<std::uint64_t, 15> counts{};
  counts[0] = layout.has_returns ? 0 : layout.rows.size();
  for (const Column& column : layout.columns) {
    if (std::string_view(column.field.name) != "return_number") continue;
    for (const std::uint32_t i : layout.rows) {
      const double number = attribute_value(*column.attribute, i);
      if (number >= 1 && number <= 15) ++counts[static_cast<std::size_t>(number) - 1];
    }
  }
  return counts;
}

Bytes make_header(const PointCloud& cloud, const Layout& layout, const WriteOptions& options) {
  Bytes header(header_bytes);
  const std::size_t records = layout.extras.empty() ? 0 : 1;
  header.put(0, 4, "LASF");
  header.put(6, std::uint16_t{1u << 4}); // coordinate systems, of which none is written, would be well-known text
  header.put(24, std::uint8_t{1});
  header.put(25, std::uint8_t{4});
  header.put(26, 32, "eigencrust");
  header.put(58, 32, options.comments.empty() ? "eigencrust" : options.comments.front());
  header.put(94, static_cast<std::uint16_t>(header_bytes));
  header.put(96, static_cast<std::uint32_t>(header_bytes +
                                            records * (record_head + description_bytes * layout.extras.size())));
  header.put(100, static_cast<std::uint32_t>(records));
  header.put(104, static_cast<std::uint8_t>(layout.format));
  header.put(105, static_cast<std::uint16_t>(layout.record_bytes));
  Box3 box;
  for (const std::uint32_t i : layout.rows) box.add(cloud.points[i]);
  if (layout.rows.empty()) box.add({});
  std::size_t at = 131;
  for (const Vec3& v : {layout.scale, layout.offset})
    for (const double c : {v.x, v.y, v.z}) {
      header.put(at, c);
      at += 8;
    }
  for (const double c : {box.max.x, box.min.x, box.max.y, box.min.y, box.max.z, box.min.z}) {
    header.put(at, c);
    at += 8;
  }
  header.put(247, std::uint64_t{layout.rows.size()});
  at = 255;
  for (const std::uint64_t count : count_returns(layout)) {
    header.put(at, count);
    at += 8;
  }
  return header;
}

void put_column(Bytes& record, const Layout& layout, const Column& column, std::size_t row) {
  const auto& [attribute, field, channel] = column;
  if (channel < 3) { // bytes are stretched, as the specification asks for: 255 -> 65535
    record.put(field.offset,
               static_cast<std::uint16_t>(std::lround(most_colour * layout.colours->fraction(channel, row))));
    return;
  }
  const double value = attribute_value(*attribute, row);
  if (field.bits > 0) {
    record.put_bits(field.offset, field.shift, static_cast<unsigned>(value));
    return;
  }
  with_scalar(field.type,
              [&, &field = field]<class T>(std::type_identity<T>) { record.put(field.offset, static_cast<T>(value)); });
}

Bytes make_record(const PointCloud& cloud, const Layout& layout, std::size_t row) {
  Bytes record(layout.record_bytes);
  std::size_t at = 0;
  for (double Vec3::*axis : {&Vec3::x, &Vec3::y, &Vec3::z}) {
    const double steps = (cloud.points[row].*axis - layout.offset.*axis) / layout.scale.*axis;
    record.put(at, static_cast<std::int32_t>(std::lround(steps)));
    at += 4;
  }
  if (!layout.has_returns) record.put(14, std::uint8_t{0x11}); // the only return
  for (const Column& column : layout.columns) put_column(record, layout, column, row);
  at = las_record_bytes(layout.format);
  for (const Extra& extra : layout.extras) {
    with_scalar(extra.attribute->type,
                [&]<class T>(std::type_identity<T>) { record.put(at, load<T>(extra.attribute->values.data(), row)); });
    at += size_of(extra.attribute->type);
  }
  return record;
}

} // namespace

Body prepare_las(const PointCloud& cloud, const WriteOptions& options, WriteResult& result) {
  Layout layout;
  choose_columns(cloud, layout, result.warnings);
  choose_grid(cloud, options.spacing, layout, result.warnings);
  result.coordinates = CoordinateType::float64;
  if (layout.record_bytes > 0xffff)
    throw Error(ErrorKind::input, "LAS", "the attributes take more bytes than a point can have", "write a PLY file");
  return [&cloud, layout, options](std::ostream& out) {
    BinaryBuffer buffer(out);
    const auto append = [&](const Bytes& bytes) { buffer.append_values(bytes.all().data(), bytes.all().size(), 1); };
    append(make_header(cloud, layout, options));
    if (!layout.extras.empty()) append(describe(layout));
    for (const std::uint32_t row : layout.rows) append(make_record(cloud, layout, row));
  };
}

} // namespace eigencrust::io
