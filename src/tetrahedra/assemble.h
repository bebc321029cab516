// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// From samples to tetrahedra: what comes before the tiles, and how they become a whole.
#pragma once

#include <span>
#include <vector>

#include <eigencrust/stages.h>

#include "geometry/tetrahedron.h"
#include "tetrahedra/tile.h"

namespace eigencrust {

/// The samples and the corners of a cube around them, no tetrahedra yet.
/// \throws Error{input} where there are none
Tetrahedralization enclose(Samples samples);

inline std::span<const Vec3> samples_of(const Tetrahedralization& t) {
  return std::span(t.positions.raw()).first(t.sample_count);
}
inline std::span<const Vec3> corners_of(const Tetrahedralization& t) {
  return std::span(t.positions.raw()).last(cube_corners);
}

/// Of all samples, one for each thread; one where that is given up.
std::vector<Tile> make_tiles(const Tetrahedralization& enclosed, const Threads& threads, const WatchGrowth& watch);

/// \param tiles of ranges that follow one another and hold all samples
/// \param t gets the tetrahedra
/// \throws Error{guarantee} where they do not fit together, Error{memory} for more than can be numbered
void assemble(std::vector<Tile> tiles, Tetrahedralization& t, const Threads& threads);

} // namespace eigencrust
