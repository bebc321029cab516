// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The cocone faces around one sample, and what they separate.
#pragma once

#include <utility>

#include "crusts/cocone.h"
#include "tetrahedra/star.h"

namespace eigencrust {

/// Looks at one star after the other.
class Umbrellas {
 public:
  Umbrellas(const Scene& scene, const Cocone& cocone)
      : t_(scene.tetrahedralization), scene_(scene), cocone_(cocone), star_(t_, scene.stars) {}

  /// Is the sample flat, and do its two poles lie in different parts of its star, each bounded by a disc that is
  /// nowhere folded more than 120°?
  [[nodiscard]] bool is_good(SampleIndex s);

  struct Part {
    std::vector<TetrahedronIndex> tetrahedra;
    std::vector<std::pair<SampleIndex, TetrahedronIndex>>
        rim; ///< of the faces that bound it, each with its tetrahedron
  };
  /// What lies on the side of the umbrella of s where a tetrahedron of its star is, and on the other; both empty where
  /// the tetrahedron lies between the faces of a flat one, on neither.
  [[nodiscard]] std::pair<Part, Part> sides_of(SampleIndex s, TetrahedronIndex from);

 private:
  struct Side { ///< of a face at the sample, seen from inside a part
    SampleIndex from, to;
    TetrahedronIndex behind; ///< in the part
  };
  void flood(std::uint32_t start);
  [[nodiscard]] bool is_wall(std::uint32_t i, std::size_t k) const;
  [[nodiscard]] std::uint32_t place_of(TetrahedronIndex i) const;
  [[nodiscard]] std::vector<Side> rim() const;
  [[nodiscard]] Part part() const;
  [[nodiscard]] bool is_disc(SampleIndex s) const;

  const Tetrahedralization& t_;
  const Scene& scene_;
  const Cocone& cocone_;
  Star star_;
  SampleIndex sample_;
  std::vector<std::uint8_t> in_part_; ///< by place in the star
  std::vector<std::uint32_t> stack_;
};

} // namespace eigencrust
