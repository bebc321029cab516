// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The other crusts: other surfaces from the same tetrahedra and poles (docs/crusts.md).
#pragma once

#include <eigencrust/eigencrust.h>

#include "report/context.h"

namespace eigencrust {

/// The paper, from samples to mesh (src/pipeline.cpp).
void reconstruct_spectral(const PointCloud& cloud, const Context& context, Result& result);

/// The method that the options name; all of the mesh's pieces are kept unless the options choose some.
/// \throws as reconstruct()
void reconstruct_crust(const PointCloud& cloud, const Context& context, Result& result);

} // namespace eigencrust
