// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Short loops around and through the handles of a closed triangle mesh.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/mesh_topology.h"

namespace eigencrust {

/// Two loops for each handle, which together with the triangles generate all loops of the mesh (tree and
/// cotree, Eppstein 2003; the shortest are preferred as in Erickson and Whittlesey 2005). Each is a list
/// of vertices. Shortest first; none for spheres.
/// \param triangles closed and orientable; each edge in two triangles
/// \param longest   loops of more edges are left out
std::vector<std::vector<std::uint32_t>> handle_loops(std::span<const Triangle> triangles, std::size_t vertices,
                                                     std::uint32_t longest, const Threads& threads);

} // namespace eigencrust
