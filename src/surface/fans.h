// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The triangles around each vertex of a surface.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>

#include <eigencrust/types.h>

#include "parallel/compressed_rows.h"

namespace eigencrust {

/// For each vertex its triangles as the other two corners in the triangle's order (compressed rows, by
/// triangle). On a closed manifold the first of them runs once through the neighbours.
class SurfaceFans {
 public:
  struct Wing {
    std::uint32_t next, last; ///< vertex, next, last is the triangle
  };

  explicit SurfaceFans(const TriangleMesh& mesh)
      : wings_(build_rows<Wing>(mesh.vertices.size(), [&](auto&& visit) {
          for (const auto& [a, b, c] : mesh.triangles) {
            visit(a, Wing{b, c});
            visit(b, Wing{c, a});
            visit(c, Wing{a, b});
          }
        })) {}

  [[nodiscard]] std::span<const Wing> operator[](std::size_t v) const { return wings_[v]; }
  /// Is an edge of the vertex a side of one triangle only?
  [[nodiscard]] bool at_rim(std::size_t v) const {
    const std::span<const Wing> wings = wings_[v];
    return std::any_of(wings.begin(), wings.end(), [&](const Wing& wing) {
      return std::none_of(wings.begin(), wings.end(), [&](const Wing& w) { return w.last == wing.next; }) ||
             std::none_of(wings.begin(), wings.end(), [&](const Wing& w) { return w.next == wing.last; });
    });
  }

 private:
  CompressedRows<Wing> wings_;
};

} // namespace eigencrust
