// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The triangles around each vertex of a surface.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

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
  /// Is the edge a side of one triangle only? \param v, other neighbours
  [[nodiscard]] bool is_open(std::uint32_t v, std::uint32_t other) const {
    const std::span<const Wing> wings = wings_[v];
    return std::count_if(wings.begin(), wings.end(),
                         [&](const Wing& w) { return w.next == other || w.last == other; }) == 1;
  }
  /// Has the vertex such an edge?
  [[nodiscard]] bool at_rim(std::uint32_t v) const {
    const std::span<const Wing> wings = wings_[v];
    return std::any_of(wings.begin(), wings.end(),
                       [&](const Wing& w) { return is_open(v, w.next) || is_open(v, w.last); });
  }
  /// For each vertex whether it is one of those.
  [[nodiscard]] std::vector<std::uint8_t> rim_vertices(const Threads& threads) const {
    std::vector<std::uint8_t> result(wings_.begin.size() - 1);
    for_each_index(threads, result.size(),
                   [&](std::size_t v) { result[v] = at_rim(static_cast<std::uint32_t>(v)) ? 1 : 0; });
    return result;
  }

 private:
  CompressedRows<Wing> wings_;
};

} // namespace eigencrust
