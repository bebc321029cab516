// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Which unknowns move together on the next coarser level.
#pragma once

#include <cstdint>
#include <vector>

#include "numerics/bordered_matrix.h"

namespace eigencrust {

struct Aggregation {
  std::uint32_t count = 0;
  std::vector<std::uint32_t> aggregate; ///< 0xffffffff: no interior neighbour, ends here
  std::vector<std::int8_t> sign;
};

/// Two rounds of pairwise matching along the strongest entries.
Aggregation aggregate_pairs_twice(const BorderedMatrix& matrix, const Threads& threads);

/// Pᵀ M P with the border kept. Entries that cancel to nothing are dropped.
BorderedMatrix galerkin(const BorderedMatrix& matrix, const Aggregation& aggregation, const Threads& threads);

} // namespace eigencrust
