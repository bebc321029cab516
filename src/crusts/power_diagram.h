// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The power diagram of balls: who is next to whom, and the polygons between.
#pragma once

#include <array>
#include <span>
#include <vector>

#include <eigencrust/types.h>

namespace eigencrust {

/// Cells of balls under the power distance |x - c|² - r². Balls without a cell are in no facet.
struct PowerDiagram {
  std::vector<Vec3> vertices;
  std::vector<std::array<std::uint32_t, 2>> facets; ///< the two balls whose cells meet there
  /// The polygon of each facet: vertices, counter-clockwise seen from the second ball (compressed rows); a row without
  /// any for facets that reach to infinity.
  std::vector<std::uint64_t> begin; ///< facets + 1
  std::vector<std::uint32_t> corners;

  [[nodiscard]] std::span<const std::uint32_t> polygon(std::size_t facet) const {
    return {corners.data() + begin[facet], corners.data() + begin[facet + 1]};
  }
};

/// The dual of the regular triangulation of the balls (Aurenhammer 1987).
PowerDiagram power_diagram(std::span<const Sphere> balls);

} // namespace eigencrust
