// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Which unknowns move together on the next coarser level.
#pragma once

#include <cstdint>
#include <vector>

#include <eigencrust/types.h>

#include "numerics/bordered_matrix.h"
#include "parallel/compressed_rows.h"

namespace eigencrust {

struct Aggregation {
  std::uint32_t count = 0;
  std::vector<std::uint32_t> aggregate;  ///< no_index: no interior neighbour, ends here
  std::vector<std::int8_t> sign;         ///< +1 or -1: moves with or against its aggregate
  CompressedRows<std::uint32_t> members; ///< of each aggregate, increasing
};

/// Pᵀ M P and its P.
struct Coarsening {
  Aggregation aggregation;
  BorderedMatrix matrix;
};

/// Two rounds of pairwise matching along the strongest entries.
Coarsening coarsen_by_pairs_twice(const BorderedMatrix& matrix, const Threads& threads);

/// One round: pairs along the strongest entries, and single nodes that join a neighbour's pair.
Aggregation match_pairs(const BorderedMatrix& matrix, const Threads& threads);

/// Pᵀ M P with the border kept. Entries that cancel to nothing are dropped.
BorderedMatrix galerkin(const BorderedMatrix& matrix, const Aggregation& aggregation, const Threads& threads);

} // namespace eigencrust
