// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The power crust: the faces between the cells of inside and of outside poles.
#pragma once

#include "crusts/power_diagram.h"
#include "tetrahedra/scene.h"

namespace eigencrust {

/// Sides of the poles by a queue from the outside in (Amenta, Choi, Kolluri 2001: two poles of one sample lie on
/// opposite sides the surer the more they oppose each other, poles whose balls intersect deeply on the same).
/// \param known sides that stay; at least those of the poles at the cube
IndexedArray<PoleIndex, Label> queue_labels(const Scene& scene, const PowerDiagram& diagram,
                                            IndexedArray<PoleIndex, Label> known);

/// The polygons between inside and outside cells, each as a fan, counter-clockwise seen from outside. Closed, since
/// around an edge of the diagram are three cells. Coordinates as those of the poles.
TriangleMesh power_crust(const PowerDiagram& diagram, const IndexedArray<PoleIndex, Label>& side);

} // namespace eigencrust
