// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What the mesh readers share.
#pragma once

#include <span>

#include <eigencrust/types.h>

#include "io/file_content.h"

namespace eigencrust::io {

/// Adds a polygon as a fan of triangles around its first corner; fewer than three corners add nothing.
inline void add_polygon(TriangleMesh& mesh, std::span<const std::uint32_t> corners) {
  for (std::size_t k = 2; k < corners.size(); ++k) mesh.triangles.push_back({corners[0], corners[k - 1], corners[k]});
}

/// \throws Error{input} when 32 bits do not number the vertices
inline void check_vertex_count(const TriangleMesh& mesh, const FileContent& file) {
  if (mesh.vertices.size() >= SampleIndex::none)
    file.fail("more than 4294967294 vertices", "split the file into parts");
}

} // namespace eigencrust::io
