// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Which samples a scanner saw side by side, and where its range jumps between them
/// (not in the paper; docs/decisions/0032).
#pragma once

#include <span>
#include <vector>

#include <eigencrust/stages.h>

namespace eigencrust {

/// What a scanner's grid says of the ground between samples.
enum class Between : std::uint8_t {
  unknown, ///< they are in no grid, of different scans, or too far apart in it
  surface, ///< neighbours, and the range does not jump
  jump     ///< the range jumps between them: nothing was seen there
};

class RangeGrid {
 public:
  RangeGrid() = default; ///< nothing is known
  /// \param sample_of_row, lines as sight_lines() takes and gives them; samples without a line are in no grid
  RangeGrid(const PointCloud& cloud, std::span<const SampleIndex> sample_of_row, const Tetrahedralization& t,
            std::span<const SightLine> lines);

  [[nodiscard]] bool empty() const { return pixel_.empty(); }
  /// A jump if there is one between any two; surface if there is, between all.
  [[nodiscard]] Between between(const std::array<SampleIndex, 3>& triangle) const;

 private:
  struct Pixel {
    std::uint32_t scan = no_index; ///< no_index: in no grid
    std::int32_t row = 0, column = 0;
    Vec3 towards; ///< unit vector to the scanner
  };
  [[nodiscard]] Between between(SampleIndex a, SampleIndex b) const;

  const Tetrahedralization* t_ = nullptr;
  std::vector<Pixel> pixel_; ///< of each sample; empty: no grid is known
};

} // namespace eigencrust
