// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The two sides of a loop on the surface.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "repair/priced_labels.h"

namespace eigencrust {

/// A loop goes around or through a handle only where the surface still hangs together when it is cut along the loop.
class LoopSides {
 public:
  LoopSides(const Tetrahedralization& tetrahedralization, const VertexStars& stars, const PricedLabels& labels)
      : t_(tetrahedralization), stars_(stars), labels_(labels), side_(tetrahedralization.positions.size(), neither) {}

  /// Does the surface fall apart along the loop? Both sides grow until they meet or one of them ends.
  /// \param loop samples, each joined to the next by an edge of the surface, whose stars are discs
  /// \param most so many samples are looked at
  /// \return false as well where neither is so by then, or where the loop is none
  bool fall_apart(std::span<const std::uint32_t> loop, std::uint64_t most);

 private:
  enum Side : std::uint8_t { left = 0, right = 1, neither = 2, on_loop = 3 };
  struct Face {
    std::uint64_t name;                  ///< four times the tetrahedron inside and the place of its corner across
    std::array<std::uint32_t, 2> others; ///< corners, counterclockwise from outside
    Side side;
  };

  bool sides_meet(std::span<const std::uint32_t> loop);
  bool faces_at(std::span<const std::uint32_t> loop, std::size_t at, std::vector<Face>& faces) const;
  bool reach(std::uint32_t sample, Side side);
  bool grow(Side side);

  const Tetrahedralization& t_;
  const VertexStars& stars_;
  const PricedLabels& labels_;
  std::vector<std::uint8_t> side_; ///< of each sample and corner that was reached
  std::array<std::vector<std::uint32_t>, 2> reached_;
  std::array<std::size_t, 2> looked_through_{}; ///< of those
};

} // namespace eigencrust
