// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/colours.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "io/text.h"
#include "surface/scalar.h"

namespace eigencrust::io {
namespace {

constexpr std::array<const char*, 4> channel_names = {"red", "green", "blue", "alpha"};
constexpr double white = 255;

/// How large the brightest value is.
enum class Scale : std::uint8_t { unit, byte, word, none };

/// A value of a channel; signed bytes are what some programs declare where they mean 0 to 255.
double channel_value(const Attribute& channel, std::size_t row) {
  const double value = attribute_value(channel, row);
  return channel.type == ScalarType::int8 && value < 0 ? value + 256 : value;
}

struct Range {
  double largest = 0;
  bool whole = true, sound = true;

  void add(const Attribute& channel) {
    for (std::size_t i = 0; i < channel.rows(); ++i) {
      const double value = channel_value(channel, i);
      if (std::isnan(value)) continue;
      sound = sound && value >= 0;
      whole = whole && value == std::floor(value);
      largest = std::max(largest, value);
    }
  }
  /// Real numbers up to 1 are shares; whole ones of an integer type never are.
  [[nodiscard]] Scale scale(bool real) const {
    if (!sound || largest > 0xffff) return Scale::none;
    if (real && largest <= 1) return Scale::unit;
    return largest <= 0xff ? Scale::byte : Scale::word;
  }
};

/// What to multiply values with to get bytes. 65535 = 257 × 255.
double factor(Scale scale) { return scale == Scale::unit ? 255 : scale == Scale::word ? 1.0 / 257 : 1; }

const Attribute* find(const std::vector<Attribute>& attributes, const std::string& name) {
  for (const Attribute& attribute : attributes)
    if (!attribute.is_list && equal_ignoring_case(attribute.name, name)) return &attribute;
  return nullptr;
}

/// The three channels, and alpha where there is one; none or at least three.
std::vector<const Attribute*> find_channels(const std::vector<Attribute>& attributes) {
  using Names = std::array<const char*, 4>;
  for (const Names& names :
       {Names{"red", "green", "blue", "alpha"}, Names{"diffuse_red", "diffuse_green", "diffuse_blue", "diffuse_alpha"},
        Names{"r", "g", "b", "a"}, Names{"rf", "gf", "bf", "af"}}) {
    std::vector<const Attribute*> found;
    for (const char* name : names)
      if (const Attribute* channel = find(attributes, name)) found.push_back(channel);
    const bool has_alpha = find(attributes, names[3]) != nullptr;
    if (found.size() == (has_alpha ? 4u : 3u)) return found;
  }
  return {};
}

std::optional<ViewerColours> from_channels(const std::vector<const Attribute*>& channels) {
  ViewerColours colours;
  colours.source = channels;
  colours.plain = colours.exact = true;
  Range of_colours;
  for (std::size_t k = 0; k < 3; ++k) of_colours.add(*channels[k]);
  for (std::size_t k = 0; k < channels.size(); ++k) {
    const Attribute& channel = *channels[k];
    Range range = of_colours;
    if (k == 3) {
      range = {};
      range.add(channel);
    }
    const Scale scale = range.scale(is_floating(channel.type));
    if (scale == Scale::none) return std::nullopt;
    (k == 3 ? colours.alpha_share : colours.share) = factor(scale) / 255;
    colours.plain = colours.plain && channel.type == ScalarType::uint8 && channel.name == channel_names[k];
    std::vector<std::uint8_t>& bytes = colours.rgba[k];
    bytes.resize(channel.rows());
    for (std::size_t i = 0; i < bytes.size(); ++i) {
      const double value = factor(scale) * channel_value(channel, i);
      const double byte = std::isnan(value) ? white : std::nearbyint(std::min(value, white));
      colours.exact = colours.exact && !(std::abs(byte - value) > 1e-6);
      bytes[i] = static_cast<std::uint8_t>(byte);
    }
  }
  return colours;
}

std::optional<ViewerColours> from_packed(const Attribute& packed) {
  if (size_of(packed.type) < 4) return std::nullopt;
  ViewerColours colours;
  colours.source = {&packed};
  colours.exact = true;
  const std::size_t channels = equal_ignoring_case(packed.name, "rgba") ? 4 : 3;
  for (std::size_t k = 0; k < channels; ++k) colours.rgba[k].resize(packed.rows());
  for (std::size_t i = 0; i < packed.rows(); ++i) {
    const double value = attribute_value(packed, i);
    // A negative whole number is the same four bytes with a sign.
    const std::uint32_t bits =
        packed.type == ScalarType::float32 ? std::bit_cast<std::uint32_t>(load<float>(packed.values.data(), i))
        : packed.type == ScalarType::int32 ? static_cast<std::uint32_t>(load<std::int32_t>(packed.values.data(), i))
                                           : packed_colour(value);
    for (std::size_t k = 0; k < channels; ++k)
      colours.rgba[k][i] = static_cast<std::uint8_t>(bits >> (k < 3 ? 16 - 8 * k : 24));
  }
  return colours;
}

} // namespace

std::vector<Attribute> colour_attributes(std::span<const double> rgb, std::size_t channels, bool whole_numbers) {
  constexpr double printed = 5e-4; // half a unit of the third digit
  const auto is_byte = [](double v) { return v >= 0 && v <= 255 && v == std::floor(v); };
  const auto is_fraction = [](double v) {
    return v >= 0 && v <= 1 && std::abs(v - std::nearbyint(255 * v) / 255) <= printed;
  };
  const bool bytes = whole_numbers && std::all_of(rgb.begin(), rgb.end(), is_byte);
  const bool fractions = !bytes && std::all_of(rgb.begin(), rgb.end(), is_fraction);
  std::vector<Attribute> result;
  std::vector<double> channel(rgb.size() / channels);
  for (std::size_t c = 0; c < channels; ++c) {
    for (std::size_t i = 0; i < channel.size(); ++i)
      channel[i] = fractions ? std::nearbyint(255 * rgb[i * channels + c]) : rgb[i * channels + c];
    result.push_back(
        make_attribute(channel_names[c], bytes || fractions ? ScalarType::uint8 : ScalarType::float32, channel));
  }
  return result;
}

std::uint32_t packed_colour(double value) {
  if (std::isnan(value) || value >= 0x1p32) return 0xffffffff;
  return value >= 1 ? static_cast<std::uint32_t>(value) : std::bit_cast<std::uint32_t>(static_cast<float>(value));
}

std::vector<Attribute> unpack_colours(std::span<const double> packed, bool with_alpha) {
  std::vector<Attribute> channels(with_alpha ? 4 : 3);
  for (std::size_t k = 0; k < channels.size(); ++k) {
    channels[k].name = channel_names[k];
    channels[k].type = ScalarType::uint8;
    channels[k].values.resize(packed.size());
    for (std::size_t i = 0; i < packed.size(); ++i)
      channels[k].values[i] = static_cast<std::byte>(packed_colour(packed[i]) >> (k < 3 ? 16 - 8 * k : 24) & 0xff);
  }
  return channels;
}

double ViewerColours::fraction(std::size_t channel, std::size_t row) const {
  if (exact || source.size() == 1) return rgba[channel][row] / 255.0;
  const double value = channel_value(*source[channel], row) * (channel == 3 ? alpha_share : share);
  return std::isnan(value) ? 1 : std::min(value, 1.0);
}

bool ViewerColours::is_source(const Attribute& attribute) const {
  return std::find(source.begin(), source.end(), &attribute) != source.end();
}

std::vector<Attribute> ViewerColours::attributes() const {
  std::vector<Attribute> result;
  for (std::size_t k = 0; k < 4; ++k) {
    if (k == 3 && rgba[k].empty()) break;
    Attribute channel;
    channel.name = channel_names[k];
    channel.type = ScalarType::uint8;
    channel.values.resize(rgba[k].size());
    if (!rgba[k].empty()) std::memcpy(channel.values.data(), rgba[k].data(), rgba[k].size());
    result.push_back(std::move(channel));
  }
  return result;
}

std::optional<ViewerColours> find_colours(const std::vector<Attribute>& attributes) {
  if (const auto channels = find_channels(attributes); !channels.empty()) return from_channels(channels);
  for (const char* name : {"rgb", "rgba"})
    if (const Attribute* packed = find(attributes, name)) return from_packed(*packed);
  return std::nullopt;
}

} // namespace eigencrust::io
