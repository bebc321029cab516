// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What the samples say of themselves: how close they stand, how noisy they are, which of them stand alone.
#pragma once

#include <algorithm>
#include <optional>
#include <span>
#include <vector>

#include <eigencrust/stages.h>

#include "parallel/threads.h"
#include "samples/place_model.h"

namespace eigencrust {

/// One model for all stages (not in the paper; docs/decisions/0024). Everything is local: nothing that one part of the
/// cloud says decides for another. Lengths in the unit of the input.
struct SampleModel {
  /// The side of the square that one sample of an even sampling stands for; of isolated samples that of the surface
  /// nearest to them.
  SampleLengths spacing;
  /// Standard deviation of the noise that the samples have where they are triangulated, 0 where there is none to be
  /// told from curvature; smooth in space.
  SampleLengths noise;
  /// That of the samples as they came: more where they were eased, see eased_positions().
  SampleLengths input_noise;
  std::uint64_t eased = 0; ///< samples that are triangulated where they did not come from
  /// Distance to the 20th nearest sample where a sample is isolated: 2.5 times as lonely as the samples of the
  /// surface nearest to it, and in no flat neighbourhood. 0 for all others.
  SampleLengths isolated;
  /// Where the samples are noisy, see below: the middle of the samples, one for each run of them along the curve.
  /// Empty where there is no such place.
  std::vector<MeanPlane> plane;
  std::vector<std::uint8_t> unclear; ///< of each place, see unclear_places()
  double typical_spacing = 0;        ///< median, for people
  /// Share of the places measured where samples lie in a sheet, if a narrow one; 1 where there are too few to tell.
  double sheet_share = 1;

  /// How far a sample may be from the surface: a spacing, or what noise explains.
  [[nodiscard]] double tolerance(SampleIndex s) const {
    return static_cast<double>(std::max(spacing[s], noise_bound * noise[s]));
  }

  static constexpr float noisy_in_spacings = 0.6f;
  static constexpr std::uint32_t run = 8; ///< longer runs are as wide as the tip of an ear
  /// Is the noise so large beside the spacing that no single sample sees both sides?
  [[nodiscard]] bool is_noisy(SampleIndex s) const { return input_noise[s] > noisy_in_spacings * spacing[s]; }
};

/// \param positions distinct, in the order of a space-filling curve
/// \param noise of all samples where it is known; none: it is measured
SampleModel sample_model(std::span<const Vec3> positions, std::optional<double> noise, const Threads& threads);
/// The same, of samples that are eased where that makes them less noisy.
SampleModel eased_sample_model(Samples& samples, std::optional<double> noise, const Threads& threads);

} // namespace eigencrust
