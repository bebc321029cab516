// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// How wide to fit: as wide as the noise allows to tell, as narrow as the shape asks for.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "fit/estimates.h"
#include "surface/fans.h"

namespace eigencrust {

/// Where each vertex goes.
struct Foot {
  double offset = 0; ///< along the normal
  Vec3 normal;       ///< of the surface there, unit; 0: no fit was possible
};

/// For each vertex fits of growing width as long as they agree: until one whose interval of confidence has nothing in
/// common with those before (Goldenshluger and Nemirovski 1997; Katkovnik 1999). The width is then averaged over
/// the neighbourhood, for a single choice hangs on the noise at its place.
/// \param moving the vertices to fit; the others stay and show the sides only
std::vector<Foot> fit_with_chosen_widths(const FitPlaces& places, std::span<const std::uint8_t> moving,
                                         const SurfaceFans& fans, const Threads& threads);

} // namespace eigencrust
