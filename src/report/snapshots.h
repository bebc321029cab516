// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Products of the stages as points or triangles with named columns, for looking at.
#pragma once

#include <eigencrust/stages.h>

#include "samples/sample_model.h"

namespace eigencrust {

/// The samples: spacing, noise (standard deviation) and isolated, as the model has them.
TriangleMesh snapshot_of_samples(const Tetrahedralization& tetrahedralization, const SampleModel& model);

/// Circumcentres of the poles: radius, value (first eigenvector, NaN for poles that are no nodes), label.
TriangleMesh snapshot_of_poles(const Tetrahedralization& tetrahedralization, const Poles& poles, const PoleGraph& graph,
                               const Partition& partition, const Labels& labels);
/// Centroids of all tetrahedra that do not touch the cube: value and label of stage two.
TriangleMesh snapshot_of_tetrahedra(const Tetrahedralization& tetrahedralization, const TetrahedronLabels& labels);
/// The surface before pieces are dropped and anything is trimmed, its vertices still samples. Of each triangle:
/// support; kept: 0 where it is not in `kept`.
TriangleMesh snapshot_of_surface(const Tetrahedralization& tetrahedralization, const Surface& all, const Surface& kept);
/// The finished mesh. Of each triangle: support; unsupported: 1 where the samples do not bear it out (absent where
/// nothing was said of that).
TriangleMesh snapshot_of_mesh(const TriangleMesh& mesh, const Surface& surface);

} // namespace eigencrust
