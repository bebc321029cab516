// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A flat base under what was seen from one side (not in the paper; docs/decisions/0032).
#pragma once

#include <eigencrust/stages.h>

#include "samples/sample_model.h"

namespace eigencrust {

/// Closes an open surface, without its cavities, with walls from its rim down to a flat base across `front`, as low as
/// the middle of the rim and below every vertex. Vertices of the base follow those of the surface, one below each of
/// the rim, in the order of the rim, and one in the middle; sample_of names the sample above (in the middle: of the
/// first), support is 0. \param origin what is added to the vertices' coordinates later \throws Error{input} where
/// rounding of the coordinates would move the base into the surface \throws Error{usage} when the surface has not
/// exactly one rim, or the rim does not run once around its middle
Base close_with_base(Axis front, const SampleModel& model, const Vec3& origin, Surface& surface);

} // namespace eigencrust
