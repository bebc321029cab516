// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Closed pieces that are inside out in a mesh with other triangles.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <eigencrust/types.h>

#include "parallel/threads.h"

namespace eigencrust {

/// The pieces of the mesh before, and which way they look.
class PieceSides {
 public:
  PieceSides(const TriangleMesh& mesh, const Threads& threads);

  /// Marks (1, else 0) the vertices of closed pieces of `mesh` that look the other way, or are flat. Empty: there are
  /// none. \param vertex_before for each of its vertices one of the mesh before, of the same piece
  [[nodiscard]] std::vector<std::uint8_t> turned(const TriangleMesh& mesh, std::span<const std::uint32_t> vertex_before,
                                                 const Threads& threads) const;

 private:
  std::vector<std::uint32_t> piece_; ///< of each vertex
  std::vector<int> side_;            ///< of each piece 1: outward, -1: inward, 0: open, or too flat to say
};

} // namespace eigencrust
