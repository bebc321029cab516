// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What it costs to put the surface on a face.
#pragma once

#include <array>

#include <eigencrust/stages.h>

#include "parallel/threads.h"

namespace eigencrust {

/// The β-skeleton measure of Labatut, Pons and Keriven (2009): 1 - min(cos φ₁, cos φ₂), where cos φᵢ is the signed
/// distance of tetrahedron i's circumcentre from the face, positive on i's own side, over its circumradius. Faces of a
/// well sampled surface have both centres far away on either side. The ε keeps faces of measure 0 from being free.
/// Tetrahedra of four samples in one plane have no say: what they are between has.
/// A face with an isolated sample costs more: it is hardly on the surface, and faces however long that lead to it from
/// where samples are missing would be as cheap as those that close the gap (docs/decisions/0026).
class FaceWeights {
 public:
  FaceWeights() = default;
  /// \param isolated samples where it is > 0 are; may be empty
  FaceWeights(const Tetrahedralization& tetrahedralization, SampleLengthsView isolated, const Threads& threads);

  /// Of the face opposite vertex k of tetrahedron i; in [ε, 2 + cost_of_isolated + ε].
  [[nodiscard]] float operator()(TetrahedronIndex i, std::size_t k) const;

  static constexpr float least = 0.01f; ///< ε
  static constexpr float cost_of_isolated = 1;
  static constexpr float largest = 2 + cost_of_isolated + least; ///< where both centres lie right across the face

 private:
  /// Of each face the smaller of the two cosines, less what else it costs, in units of 1/steps.
  IndexedArray<TetrahedronIndex, std::array<std::int16_t, 4>> cosine_;
};

} // namespace eigencrust
