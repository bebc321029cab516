// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Fewer or more regular triangles, as the options have it.
#pragma once

#include <eigencrust/options.h>
#include <eigencrust/stages.h>

#include "report/context.h"
#include "samples/sample_model.h"

namespace eigencrust {

/// Do the options ask for other triangles than those of the surface?
bool asks_for_other_triangles(const Options& options);

/// Simplifies or remeshes: the stages simplify or remesh. Each vertex then has the sample, each triangle the support
/// and the tetrahedron, of what was next to it. Writes Report::simplified. \param surface in input coordinates \throws
/// Error{usage} see remesh()
void make_other_triangles(Surface& surface, const SampleModel& model, const Context& context);

} // namespace eigencrust
