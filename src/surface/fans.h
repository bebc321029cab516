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
    // Where every neighbour is the first of one triangle and the last of another, which is nearly everywhere, none is.
    bool closed = true;
    for (const Wing& w : wings) {
      bool first = false, last = false;
      for (const Wing& o : wings) {
        first |= o.next == w.last;
        last |= o.last == w.next;
      }
      closed &= first & last;
    }
    return !closed && std::any_of(wings.begin(), wings.end(),
                                  [&](const Wing& w) { return is_open(v, w.next) || is_open(v, w.last); });
  }
  /// For each vertex whether it is one of those.
  [[nodiscard]] std::vector<std::uint8_t> rim_vertices(const Threads& threads) const {
    std::vector<std::uint8_t> result(wings_.begin.size() - 1);
    for_each_index(threads, result.size(),
                   [&](std::size_t v) { result[v] = at_rim(static_cast<std::uint32_t>(v)) ? 1 : 0; });
    return result;
  }
  /// For each vertex the number of its piece, by first vertex; vertices in no triangle have one each.
  [[nodiscard]] std::vector<std::uint32_t> pieces() const {
    std::vector<std::uint32_t> piece(wings_.begin.size() - 1, no_index), open;
    std::uint32_t count = 0;
    for (std::uint32_t start = 0; start < piece.size(); ++start) {
      if (piece[start] != no_index) continue;
      piece[start] = count;
      open.push_back(start);
      while (!open.empty()) {
        const std::uint32_t v = open.back();
        open.pop_back();
        for (const Wing& wing : wings_[v])
          for (const std::uint32_t other : {wing.next, wing.last})
            if (piece[other] == no_index) {
              piece[other] = count;
              open.push_back(other);
            }
      }
      ++count;
    }
    return piece;
  }

 private:
  CompressedRows<Wing> wings_;
};

} // namespace eigencrust
