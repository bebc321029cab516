// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// All tetrahedra take the labels of least energy.
#pragma once

#include <cstdint>

#include <eigencrust/stages.h>

#include "settle/data_term.h"
#include "settle/energy.h"

namespace eigencrust {

struct MinimumLabels {
  TetrahedronLabels labels;
  std::uint64_t undecided = 0; ///< tetrahedra that their data term alone did not decide
  double energy = 0;           ///< of the labels
};

/// The terms of all tetrahedra but those known, which keep their labels.
Energy make_energy(const Tetrahedralization& tetrahedralization, const DataTerms& data, const Labels& known,
                   const Threads& threads);

/// The exact minimum (docs/decisions/0026). A tetrahedron whose data term outweighs all its faces has the label that
/// it asks for in every minimum; the others get an exact minimum s-t cut. Of equal minima the one with the most
/// outside.
MinimumLabels minimum_of(const Tetrahedralization& tetrahedralization, const Energy& energy, const Threads& threads);

} // namespace eigencrust
