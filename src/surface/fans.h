// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The triangles around each vertex of a surface.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <eigencrust/types.h>

namespace eigencrust {

/// For each vertex its triangles as the other two corners in the triangle's order (compressed rows, by
/// triangle). On a closed manifold the first of them runs once through the neighbours.
class SurfaceFans {
 public:
  struct Wing {
    std::uint32_t next, last; ///< vertex, next, last is the triangle
  };

  explicit SurfaceFans(const TriangleMesh& mesh) : begin_(mesh.vertices.size() + 1, 0) {
    for (const auto& triangle : mesh.triangles)
      for (const std::uint32_t v : triangle) ++begin_[v + 1];
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) begin_[v + 1] += begin_[v];
    wings_.resize(3 * mesh.triangles.size());
    std::vector<std::uint64_t> place(begin_.begin(), begin_.end() - 1);
    for (const auto& [a, b, c] : mesh.triangles) {
      wings_[place[a]++] = {b, c};
      wings_[place[b]++] = {c, a};
      wings_[place[c]++] = {a, b};
    }
  }

  [[nodiscard]] std::span<const Wing> operator[](std::size_t v) const {
    return {wings_.data() + begin_[v], wings_.data() + begin_[v + 1]};
  }

 private:
  std::vector<std::uint64_t> begin_;
  std::vector<Wing> wings_;
};

} // namespace eigencrust
