// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The pieces of the surface.
#pragma once

#include <eigencrust/stages.h>

#include "samples/sample_model.h"

namespace eigencrust {

/// Removes pieces of the surface by `keep`; see docs/parameters.md for `supported`. Expects surface.support.
/// A wall of a cavity that is kept keeps the shell around it; but where `supported` drops the shell, the wall is
/// turned: it bounds a body.
/// \param model  its isolated samples count; may be empty
/// \param labels those that the surface was made from
std::vector<DroppedComponent> filter_components(Surface& surface, const KeepComponents& keep,
                                                const Tetrahedralization& tetrahedralization, const SampleModel& model,
                                                const Labels& labels, const Threads& threads);

/// Takes away the triangles where `gone` is not 0, and vertices that are then without one; the order stays.
void drop_triangles(std::span<const std::uint8_t> gone, Surface& surface);

} // namespace eigencrust
