// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What it costs to put the surface on a face.
#pragma once

#include <array>

#include <eigencrust/types.h>

#include "parallel/threads.h"

namespace eigencrust {

/// The β-skeleton measure of Labatut, Pons and Keriven (2009): 1 - min(cos φ₁, cos φ₂), where cos φᵢ is the signed
/// distance of tetrahedron i's circumcentre from the face, positive on i's own side, over its circumradius. Faces of a
/// well sampled surface have both centres far away on either side. The ε keeps faces of measure 0 from being free.
class FaceWeights {
 public:
  FaceWeights() = default;
  FaceWeights(const Tetrahedralization& tetrahedralization, const Threads& threads);

  /// Of the face opposite vertex k of tetrahedron i; in [ε, 2 + ε].
  [[nodiscard]] float operator()(TetrahedronIndex i, std::size_t k) const;

  static constexpr float least = 0.01f;       ///< ε
  static constexpr float largest = 2 + least; ///< where both centres lie right across the face

 private:
  const Tetrahedralization* t_ = nullptr;
  IndexedArray<TetrahedronIndex, std::array<std::int16_t, 4>> cosine_; ///< towards each face, in units of 1/steps
};

} // namespace eigencrust
