// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What the reader and the writer of GLB files agree on.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

namespace eigencrust::io {

/// In the extras of the asset: "metre", or that the numbers are no metres though the format says so.
constexpr const char* unit_key = "unit";
constexpr const char* unknown_unit = "not known";

/// Colours of files are sRGB, those of glTF's vertices linear (IEC 61966-2-1). Both 0 to 1.
inline double linear_light(double srgb) {
  return srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4);
}
inline double srgb_of(double linear) {
  const double share = std::clamp(linear, 0.0, 1.0);
  return share <= 0.0031308 ? 12.92 * share : 1.055 * std::pow(share, 1 / 2.4) - 0.055;
}

} // namespace eigencrust::io
