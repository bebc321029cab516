// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Products of the stages as points or triangles with named columns, for looking at.
#pragma once

#include <eigencrust/stages.h>

namespace eigencrust {

/// Circumcentres of the poles: radius, value (first eigenvector, NaN for poles that are no nodes), label.
TriangleMesh snapshot_of_poles(const Tetrahedralization& tetrahedralization, const Poles& poles, const PoleGraph& graph,
                               const Partition& partition, const Labels& labels);
/// Centroids of all tetrahedra that do not touch the cube: value and label of stage two.
TriangleMesh snapshot_of_tetrahedra(const Tetrahedralization& tetrahedralization, const TetrahedronLabels& labels);
/// The surface in input coordinates, before pieces are dropped.
TriangleMesh snapshot_of_surface(const Tetrahedralization& tetrahedralization, const Surface& surface);

} // namespace eigencrust
