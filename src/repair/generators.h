// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What proposes moves to the engine. All expect a manifold.
#pragma once

#include <cstdint>

#include "repair/moves.h"

namespace eigencrust {

struct PieceCounts {
  std::uint64_t dropped = 0;
};
/// Small bodies and hollows, whole.
PieceCounts drop_pieces(Moves& moves);

struct HandleCounts {
  std::uint64_t closed = 0;
};
/// Short loops of the surface: tetrahedra around the loop, or at the disc that it bounds.
HandleCounts close_handles(Moves& moves, const Checkpoint& checkpoint = {});

struct RecoveryCounts {
  std::uint64_t samples = 0; ///< taken in
};
/// Samples that the surface passes by: one tetrahedron between such a sample and a triangle of the surface.
RecoveryCounts recover_samples(Moves& moves);

} // namespace eigencrust
