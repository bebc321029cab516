// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The pieces of the surface.
#pragma once

#include <eigencrust/stages.h>

namespace eigencrust {

/// Removes pieces of the surface by `keep`; see docs/parameters.md for `supported`. Expects surface.support.
std::vector<DroppedComponent> filter_components(Surface& surface, const KeepComponents& keep,
                                                const Tetrahedralization& tetrahedralization, const Threads& threads);

} // namespace eigencrust
