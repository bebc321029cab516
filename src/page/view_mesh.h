// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Meshes and clouds made small enough to be looked at.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <eigencrust/types.h>

namespace eigencrust {

/// A mesh to be looked at, and which triangle of the whole one each of its triangles was.
struct ViewMesh {
  TriangleMesh mesh;
  std::vector<std::uint32_t> triangle;
};

/// The vertices in each cube of a grid become the one in their middle, and triangles that then have no area go
/// (Rossignac and Borrel, Multi-resolution 3D approximations for rendering complex scenes, 1993), the grid being as
/// fine as `most` triangles allow. A mesh that has no more stays as it is. For the eye alone: what comes out need not
/// be manifold.
ViewMesh view_mesh(const TriangleMesh& mesh, std::size_t most);

/// Every so-manieth, the same number at the most.
template <class T>
std::vector<T> evenly(std::span<const T> all, std::size_t most) {
  if (all.size() <= most) return {all.begin(), all.end()};
  std::vector<T> picked;
  for (std::size_t k = 0; k < most; ++k)
    picked.push_back(all[static_cast<std::size_t>(static_cast<double>(k) * static_cast<double>(all.size() - 1) /
                                                  static_cast<double>(most - 1))]);
  return picked;
}

} // namespace eigencrust
