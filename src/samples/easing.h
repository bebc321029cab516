// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Noisy samples that move a little way towards one another before they are triangulated (not in the paper;
/// docs/decisions/0049).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <eigencrust/stages.h>

#include "samples/places.h"
#include "samples/sample_model.h"
#include "samples/scales.h"

namespace eigencrust {

/// A sample and its nearest neighbours; itself once more where there are fewer.
using Neighbours = std::array<std::uint32_t, neighbours_around + 1>;

/// Where the samples are if all noisy ones move along the normal of the plane of their 12 nearest neighbours, onto it:
/// no farther than noise explains, and not those that stand alone. All are exact beside the origin and, where that is
/// no change, floats in input coordinates. Empty where none is noisy. \param around of each sample
std::vector<Vec3> eased_positions(const Samples& samples, std::span<const Neighbours> around, const SampleModel& model,
                                  const Threads& threads);

/// Moves those samples, and takes the noise that is left of them into the model, where it is clearly less than before:
/// elsewhere what was taken for noise is shape, or so much that neighbours do not know better.
/// \param eased see above \param models of them \param places as they were measured \param noise of all samples where
/// it is given
void take_eased(std::span<const Vec3> eased, const PlaceModels& models, Places places, std::optional<double> noise,
                Samples& samples, SampleModel& model, const Threads& threads);

/// Samples that came to lie on one another, or on one that did not move, go back to where they were.
/// \param before distinct \param after as many
void keep_distinct(std::span<const Vec3> before, std::vector<Vec3>& after, const Threads& threads);

} // namespace eigencrust
