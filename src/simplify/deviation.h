// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// How far a mesh with fewer triangles is from the one that it stands for.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <eigencrust/metrics.h>
#include <eigencrust/report.h>

#include "parallel/threads.h"

namespace eigencrust {

/// The mesh before, prepared for questions.
class FullSurface {
 public:
  /// \param mesh outlives this
  FullSurface(const TriangleMesh& mesh, const Threads& threads);

  /// Distances both ways: from the vertices of the full mesh, each for the area around it, to `mesh`; and from the
  /// vertices of `mesh` and points spread evenly over it to the full one.
  [[nodiscard]] DeviationReport measure(const TriangleMesh& mesh, const Threads& threads) const;
  /// Also which vertices of `mesh` (1, else 0) are of triangles farther off than `most`, or have something farther off
  /// next to them or among what became part of them.
  /// \param into for each vertex of the full mesh the one of `mesh` that it is part of
  [[nodiscard]] DeviationReport measure(const TriangleMesh& mesh, double most, std::span<const std::uint32_t> into,
                                        std::vector<std::uint8_t>& beyond, const Threads& threads) const;
  [[nodiscard]] const TriangleTree& tree() const { return tree_; }

 private:
  [[nodiscard]] DeviationReport measure(const TriangleMesh& mesh, double most, std::span<const std::uint32_t> into,
                                        std::vector<std::uint8_t>* beyond, const Threads& threads) const;

  const TriangleMesh& mesh_;
  TriangleTree tree_;
  std::vector<double> area_; ///< three times that around each vertex
};

} // namespace eigencrust
