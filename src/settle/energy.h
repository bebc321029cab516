// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The one energy of the labels of all tetrahedra.
#pragma once

#include <span>

#include <eigencrust/types.h>

#include "parallel/threads.h"
#include "settle/face_weights.h"

namespace eigencrust {

/// E = Σ weights of the faces between inside and outside + Σ costs of the tetrahedra, in units of a face's weight.
struct Energy {
  FaceWeights faces;
  /// What it costs each tetrahedron to be inside less what it costs to be outside: > 0 where the samples say outside.
  IndexedArray<TetrahedronIndex, float> data;
  Labels known;        ///< labels that are no question: at the cube and as named
  double constant = 0; ///< Σ costs that no labels avoid

  [[nodiscard]] double of(const Tetrahedralization& tetrahedralization, const Labels& labels,
                          const Threads& threads) const;
  /// How much the energy changes when these (distinct) tetrahedra change sides.
  [[nodiscard]] double change(const Tetrahedralization& tetrahedralization, const Labels& labels,
                              std::span<const TetrahedronIndex> turned) const;
  /// Balance of everything that speaks for a tetrahedron's side, in [-1, 1], > 0 outside: its data and the labels
  /// across its faces. At a minimum of the energy no balance contradicts its label.
  [[nodiscard]] float balance(const Tetrahedralization& tetrahedralization, const Labels& labels,
                              TetrahedronIndex i) const;
};

} // namespace eigencrust
