// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Regular triangles (not in the paper; docs/decisions/0041).
#pragma once

#include "simplify/simplify.h"

namespace eigencrust {

/// Splits, collapses and flips edges and moves vertices along the surface until edges are about as long as asked for
/// (Botsch and Kobbelt, A Remeshing Approach to Multiresolution Modeling, 2004). Creases, edges at which the surface
/// turns by more than 60 degrees, and rims stay where they are. Where triangles cross afterwards those of before stay,
/// and it is done again.
/// \param full manifold, oriented \param surface of `full` \param edge > 0
/// \param spacing coordinates are rounded to float where that moves them by less than a thousandth of it
/// \throws Error{usage} for an edge so short that there would be more triangles than anybody waits for
OtherTriangles remesh(const TriangleMesh& full, const FullSurface& surface, double edge, double spacing,
                      const Threads& threads);

/// \param edge the length asked for
ShapeReport shape_of(const TriangleMesh& mesh, double edge, const Threads& threads);

} // namespace eigencrust
