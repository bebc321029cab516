// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Fronts that grow over the surface, to count its pieces without building it.
#pragma once

#include <cstdint>
#include <vector>

#include "repair/priced_labels.h"

namespace eigencrust {

/// All fronts grow in turn, ring by ring, and are one where they meet: that takes as long as it takes the smaller
/// pieces to end, or neighbours to meet.
class SurfaceFronts {
 public:
  static constexpr std::uint32_t none = no_index;

  /// \param owner `none` for every sample and corner, and so again afterwards
  SurfaceFronts(const Tetrahedralization& tetrahedralization, const VertexStars& stars, const PricedLabels& labels,
                std::vector<std::uint32_t>& owner)
      : t_(tetrahedralization), stars_(stars), labels_(labels), owner_(owner) {}

  /// How many pieces of the surface touch these (distinct) samples.
  std::int64_t pieces(const std::vector<std::uint32_t>& samples);

 private:
  std::uint32_t root_of(std::uint32_t front);
  void grow(std::uint32_t front);
  std::uint32_t join(std::uint32_t a, std::uint32_t b);

  const Tetrahedralization& t_;
  const VertexStars& stars_;
  const PricedLabels& labels_;
  std::vector<std::uint32_t>& owner_;           ///< the front that reached each sample
  std::vector<std::uint32_t> reached_;          ///< all that have an owner
  std::vector<std::uint32_t> root_;             ///< fronts that met have the same
  std::vector<std::vector<std::uint32_t>> rim_; ///< of each root: samples whose neighbours were not looked at
};

} // namespace eigencrust
