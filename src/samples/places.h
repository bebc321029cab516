// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Places along the curve of the samples, and what the flat ones around each say.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <eigencrust/types.h>

#include "parallel/threads.h"
#include "samples/place_model.h"

namespace eigencrust {

/// One place is measured for so many samples along the curve.
constexpr std::uint32_t samples_per_place = 64;

/// Places along the curve with what was measured there.
struct Places {
  std::vector<Vec3> at;
  std::vector<PlaceModel> model;
  std::vector<float> spacing;
};
Places measure_places(const PlaceModels& models, std::span<const Vec3> positions, std::span<const float> spacing,
                      const Threads& threads);
/// Again, where `wanted`, at other positions.
void measure_again(const PlaceModels& models, std::span<const Vec3> positions, std::span<const std::uint8_t> wanted,
                   Places& places, const Threads& threads);

/// What the flat places around each place say.
struct FlatPlaces {
  std::vector<float> level, noise; ///< median of the spacings, infinite where there are none; upper quartile, 0
};
FlatPlaces flat_places_around(const Places& places, const Threads& threads);

/// Which places lie where more than a third are not clear, flat or not; see PlaceModel.
std::vector<std::uint8_t> unclear_places(const Places& places, const Threads& threads);

} // namespace eigencrust
