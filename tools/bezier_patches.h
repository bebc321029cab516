// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Bicubic Bézier patches, the form in which Newell's teapot was published.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

#include <eigencrust/types.h>

namespace eigencrust::tools {

/// A set of bicubic patches over shared control points.
struct BezierPatches {
  /// Control points of each patch, 0-based, four rows of four: entry 4 i + j belongs to B_i(u) B_j(v).
  std::vector<std::array<std::uint32_t, 16>> patches;
  std::vector<Vec3> control_points;
};

/// Reads the published format: number of patches, 16 one-based indices per line, number of control
/// points, x y z per line; separated by commas or blanks. Text from # on is a comment.
/// \throws Error{input} naming file and line
BezierPatches read_bezier_patches(const std::filesystem::path& path);

/// Point (i/n, j/n) of a patch. Patches that share boundary control points, in either direction, give
/// bit for bit the same boundary points.
Vec3 bezier_position(const BezierPatches& patches, std::size_t patch, std::uint32_t i, std::uint32_t j,
                     std::uint32_t n);

/// Each patch as a grid of 2 × n × n triangles; patches share no vertices. Triangles that collapse in a
/// pole of a patch are left out. Front faces are on the side of ∂/∂v × ∂/∂u (outside for the teapot).
/// \throws Error{usage} unless 1 <= subdivisions <= 1024
TriangleMesh tessellate(const BezierPatches& patches, std::uint32_t subdivisions);

/// The triangles whose front is seen from far away: without the parts that lie inside other parts. A
/// triangle stays when more than `fraction` of `directions` directions in front of it lead out.
TriangleMesh outer_part(const TriangleMesh& mesh, std::uint32_t directions = 256, double fraction = 0.02,
                        unsigned threads = 0);

} // namespace eigencrust::tools
