// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// How the samples around one place are spread.
#pragma once

#include <span>
#include <vector>

#include <eigencrust/types.h>

#include "geometry/nearest.h"

namespace eigencrust {

struct PlaceModel {
  bool is_flat = false;  ///< some neighbourhood is; otherwise nothing is known
  double noise = 0;      ///< standard deviation across the surface
  bool is_sheet = false; ///< flat, or the 20 nearest samples are
};

/// Nearly all noise is within so many standard deviations.
constexpr float noise_bound = 3;

/// The middle of noisy samples.
struct MeanPlane {
  Vec3 mean, normal; ///< normal: unit
};

/// Looks at ever larger neighbourhoods until one is flat: wider than the noise is thick.
class PlaceModels {
 public:
  /// \param positions in the order of a space-filling curve; outlive this, as does `tree` of them
  PlaceModels(std::span<const Vec3> positions, const PointTree& tree);

  [[nodiscard]] PlaceModel at(const Vec3& place) const;
  /// Of the samples within the bound of the noise, with Gaussian weights of 2 deviations.
  [[nodiscard]] MeanPlane mean_plane(const Vec3& place, double noise) const;

 private:
  /// Every third, ninth ... sample: wide neighbourhoods are told from as few samples as narrow ones.
  struct Coarser {
    std::vector<Vec3> positions;
    PointTree tree;
  };
  [[nodiscard]] PlaceModel flat_at(const Vec3& place) const;
  [[nodiscard]] bool is_smooth_up_close(std::span<const Vec3> points, std::span<const std::uint32_t> around) const;

  std::span<const Vec3> positions_;
  const PointTree& tree_;
  std::vector<Coarser> coarser_;
};

} // namespace eigencrust
