// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Fronts that grow over the surface, to count its pieces without building it.
#pragma once

#include <cstdint>
#include <vector>

#include "repair/priced_labels.h"

namespace eigencrust {

/// The faces of the surface at a vertex: visit(tetrahedron inside, the place of its corner across).
template <class Visit>
void for_each_surface_face(const Tetrahedralization& t, const VertexStars& stars, const PricedLabels& labels,
                           VertexIndex at, Visit&& visit) {
  for (const TetrahedronIndex i : stars[at]) {
    if (labels[i] != Label::inside) continue;
    for (std::size_t k = 0; k < 4; ++k) {
      const TetrahedronIndex n = t.neighbours[i][k];
      if (t.tetrahedra[i][k] != at && !(n.valid() && labels[n] == Label::inside)) visit(i, k);
    }
  }
}

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
