// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Fits at places spread over the surface, each as wide as the noise asks for and the shape allows.
#pragma once

#include <cstdint>
#include <vector>

#include "fit/local_quadric.h"
#include "fit/sample_clusters.h"
#include "parallel/threads.h"

namespace eigencrust {

/// Where quadrics are fitted: one place for each cluster of the pyramid's level 1.
struct FitPlaces {
  static constexpr std::size_t level = 1;
  std::vector<Vec3> position, normal; ///< normal: unit, or 0: no fit
  std::vector<double> unit;           ///< widths are so many times this length
  std::vector<double> noise;          ///< standard deviation; 0: unknown
  std::vector<double> spacing;        ///< of the samples
  std::vector<std::uint8_t> wanted;   ///< places that need a fit
};

struct ChosenWidths {
  std::vector<double> width;          ///< of each place, in its units; 0: no fit is possible
  std::vector<double> noise_variance; ///< of the samples about the narrowest fit; length²; negative: unknown
};

/// For each wanted place the width of least risk, which is the square of the bias and the variance together; averaged
/// over the places around, for a single one hangs on the noise.
ChosenWidths chosen_widths(const FitPlaces& places, const ClusterPyramid& samples, const Threads& threads);

struct PlaceFits {
  std::vector<LocalQuadric> fit; ///< of each place; variance = 0: there is none
  std::vector<std::uint8_t>
      wide; ///< of each cluster of the next level: 1 where only the place it was made from has one
};

struct FitEffort {
  double clusters; ///< clusters are as coarse as leaves so many of them in a fit
  double wide;     ///< in spacings: where all fits are wider one place in four has one, for all
};

/// Fits of these widths. Samples of other sides do not count: clusters whose normal is more than 60° off, and those
/// that are not reached along the surface.
PlaceFits fits_of_widths(const FitPlaces& places, const ClusterPyramid& samples, const std::vector<double>& width,
                         const FitEffort& effort, const Threads& threads);

} // namespace eigencrust
