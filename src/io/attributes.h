// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What readers and writers share about attributes.
#pragma once

#include <array>
#include <initializer_list>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <eigencrust/types.h>

namespace eigencrust::io {

/// Gives out names that were not given out before: name, name_2, name_3 ...
class UniqueNames {
 public:
  UniqueNames(std::initializer_list<std::string> taken = {}) : taken_(taken) {}
  std::string operator()(const std::string& name);

 private:
  std::set<std::string> taken_;
  std::map<std::string, std::uint64_t> last_suffix_; ///< so that many equal names take no quadratic time
};

enum class NumberKind : std::uint8_t { natural, whole, real }; ///< unsigned, signed, floating

/// Of the attribute that holds numbers of so many bytes: whole ones of 64 bits become float64, real ones of 16 float32.
ScalarType attribute_type(NumberKind kind, std::size_t bytes);

/// append_scan without the scan numbers.
void append_rows(PointCloud& cloud, PointCloud next);

/// Colours as 0..1 (or 0..255 where a value exceeds 1 and all are whole): stored as uint8 where that
/// loses nothing, i.e. every value is a multiple of 1/255 up to three printed digits; else as float32.
/// \param rgb n × channels values, row after row; named red, green, blue, alpha
std::vector<Attribute> colour_attributes(std::span<const double> rgb, std::size_t channels, bool whole_numbers);

/// The attributes that hold the colour (red green blue or r g b, any case), or nothing.
struct ColourColumns {
  std::array<const Attribute*, 3> rgb{};
  const Attribute* alpha = nullptr;
};
std::optional<ColourColumns> find_colours(const std::vector<Attribute>& attributes);
/// 1 for the brightest value: integers are divided by the largest of their type.
double colour_fraction(const Attribute& channel, std::size_t row);

/// One warning that lists the attributes a format has no room for.
/// \param colours_kept channels of colour that it does hold: 0, 3 or 4 (with alpha)
void warn_lost_attributes(const std::vector<Attribute>& attributes, const std::string& of, std::size_t colours_kept,
                          const std::string& format, std::vector<std::string>& warnings);

/// \throws Error{usage} unless every attribute has `rows` rows and sound list offsets
void check_attributes(const std::vector<Attribute>& attributes, std::size_t rows, const std::string& of);

} // namespace eigencrust::io
