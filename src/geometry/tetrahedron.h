// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The corners of a tetrahedron.
#pragma once

#include <array>
#include <cstddef>

namespace eigencrust {

/// Of the face opposite corner k of a positively oriented tetrahedron, counter-clockwise seen from outside: in this
/// order corner k and they are positively oriented, too.
constexpr std::array<std::array<std::size_t, 3>, 4> face_opposite{{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

} // namespace eigencrust
