// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Colours of points and vertices: in which columns programs keep them, and what viewers expect.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <eigencrust/types.h>

namespace eigencrust::io {

/// Colours as 0..1 (or 0..255 where a value exceeds 1 and all are whole): stored as uint8 where that
/// loses nothing, i.e. every value is a multiple of 1/255 up to three printed digits; else as float32.
/// \param rgb n × channels values, row after row; named red, green, blue, alpha
std::vector<Attribute> colour_attributes(std::span<const double> rgb, std::size_t channels, bool whole_numbers);

/// The four bytes of a packed colour. Some programs print them as a whole number, some that number as a
/// real (4.2108e+06), some the real number that has the same bits (below 1 or negative). Not known: white.
std::uint32_t packed_colour(double value);
/// red, green, blue (and alpha) of packed values 0xaarrggbb.
std::vector<Attribute> unpack_colours(std::span<const double> packed, bool with_alpha);

/// Colours as every viewer takes them, and where they came from.
struct ViewerColours {
  std::vector<const Attribute*> source;          ///< the columns, 1 (packed), 3 or 4
  std::array<std::vector<std::uint8_t>, 4> rgba; ///< alpha is empty where there is none
  bool plain = false; ///< the columns are bytes under the names red, green, blue (and alpha) already
  bool exact = false; ///< nothing was rounded: the columns' values are these bytes, in some way of writing
  double share = 1.0 / 255, alpha_share = 1.0 / 255; ///< what a value of the columns is multiplied with to get 0 to 1

  /// 0 to 1 without rounding to bytes. \param channel 0 to 2, or 3 where there is alpha
  [[nodiscard]] double fraction(std::size_t channel, std::size_t row) const;
  [[nodiscard]] bool has_alpha() const { return source.size() == 4 || (source.size() == 1 && !rgba[3].empty()); }
  [[nodiscard]] bool is_source(const Attribute& attribute) const;
  /// red, green, blue (and alpha) as attributes of bytes.
  [[nodiscard]] std::vector<Attribute> attributes() const;
};

/// Colours in columns red green blue, r g b, diffuse_red ..., rf gf bf (in any case), or packed in rgb or rgba; as 0 to
/// 255, 0 to 65535 or 0 to 1, which their values tell, not the type that holds them. Rows whose colour is not known
/// are white. Nothing where there are no such columns, or their values are no colours.
std::optional<ViewerColours> find_colours(const std::vector<Attribute>& attributes);

} // namespace eigencrust::io
