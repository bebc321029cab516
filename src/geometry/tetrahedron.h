// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The corners of a tetrahedron.
#pragma once

#include <array>
#include <cstddef>

#include <eigencrust/types.h>

namespace eigencrust {

/// Of the face opposite corner k of a positively oriented tetrahedron, counter-clockwise seen from outside: in this
/// order corner k and they are positively oriented, too.
constexpr std::array<std::array<std::size_t, 3>, 4> face_opposite{{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

/// Those of the cube around all, whose numbers follow those of the samples.
constexpr std::uint32_t cube_corners = 8;

inline std::array<Vec3, 4> corners_of(const Tetrahedralization& t, TetrahedronIndex i) {
  const auto& [a, b, c, d] = t.tetrahedra[i];
  return {t.positions[a], t.positions[b], t.positions[c], t.positions[d]};
}

template <std::size_t N>
Vec3 centroid(const std::array<Vec3, N>& corners) {
  Vec3 sum;
  for (const Vec3& p : corners) sum = sum + p;
  return (1 / static_cast<double>(corners.size())) * sum;
}

} // namespace eigencrust
