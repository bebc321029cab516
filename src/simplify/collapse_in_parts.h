// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Edges of a large mesh are collapsed on all threads.
#pragma once

#include <memory>

#include "simplify/collapse.h"

namespace eigencrust {

/// collapse_edges() in parts of the mesh, which are as many for any number of threads. Each gets its share of the
/// triangles that may stay; vertices where parts meet stay. Asked again, with other limits, only the parts where these
/// have changed are made anew.
class CollapseInParts {
 public:
  /// \param mesh, quadrics outlive this
  /// \param before only its surface is looked at, and the vertices of the mesh for its points
  CollapseInParts(const TriangleMesh& mesh, std::span<const Quadric> quadrics, const StandFor& before,
                  const CollapseGoal& goal, const Threads& threads);
  ~CollapseInParts();

  Collapsed run(std::span<const float> limits);

 private:
  class Parts;
  std::unique_ptr<Parts> parts_;
};

} // namespace eigencrust
