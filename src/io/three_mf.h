// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What the reader and the writer of 3MF files agree on.
#pragma once

#include <array>
#include <string_view>

namespace eigencrust::io {

struct ThreeMfUnit {
  std::string_view name;
  double metres;
};
/// In the order of lib3mf's numbers. Inch and foot are those of the International Yard and Pound Agreement of 1959.
constexpr std::array<ThreeMfUnit, 6> three_mf_units = {
    {{"micron", 1e-6}, {"millimeter", 1e-3}, {"centimeter", 1e-2}, {"inch", 0.0254}, {"foot", 0.3048}, {"meter", 1}}};

} // namespace eigencrust::io
