// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Short loops around and through the handles of a closed triangle mesh.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "geometry/mesh_topology.h"
#include "parallel/compressed_rows.h"

namespace eigencrust {

/// Two loops for each handle, which together with the triangles generate all loops of the mesh (tree and
/// cotree, Eppstein 2003; the shortest are preferred as in Erickson and Whittlesey 2005). Each is a list
/// of vertices. Shortest first; none for spheres.
/// \param triangles orientable; each edge in two triangles, or at a rim, as if one face closed all of them
/// \param longest   loops of more edges are left out
std::vector<std::vector<std::uint32_t>> handle_loops(std::span<const Triangle> triangles, std::size_t vertices,
                                                     std::uint32_t longest, const Threads& threads);

/// The same of a part of the mesh: of that within so many edges of a vertex, as seen from there. A handle's loops
/// through that vertex are among them, as short as there are any.
class LoopsNearby {
 public:
  struct NamedTriangle {
    std::uint64_t name; ///< of its own
    Triangle corners;
  };
  /// Appends the triangles at a vertex, as they are then.
  using TrianglesAt = std::function<void(std::uint32_t vertex, std::vector<NamedTriangle>&)>;

  /// \param vertices how many numbers they have
  LoopsNearby(std::size_t vertices, TrianglesAt triangles_at);

  [[nodiscard]] std::vector<std::vector<std::uint32_t>> at(std::uint32_t root, std::uint32_t radius,
                                                           const Threads& threads);
  /// Vertices of all parts so far.
  [[nodiscard]] std::size_t visited() const { return visited_; }

 private:
  void take(std::uint32_t vertex);

  TrianglesAt triangles_at_;
  std::vector<std::uint32_t> number_; ///< of each vertex in the part; no_index outside it
  std::vector<std::uint32_t> part_;   ///< its vertices, the nearest first
  std::size_t visited_ = 0;
};

} // namespace eigencrust
