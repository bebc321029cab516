// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// How the samples around one place are spread.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include <eigencrust/types.h>

#include "geometry/nearest.h"

namespace eigencrust {

struct PlaceModel {
  bool is_flat = false;  ///< some neighbourhood is; otherwise nothing is known
  double noise = 0;      ///< standard deviation across the surface
  bool is_sheet = false; ///< flat, or the 20 nearest samples are
  /// Do the 90 nearest samples lie in one flat sheet, or the 270 nearest, no thicker than the 90? Not in much noise,
  /// and not in little where other parts are near.
  bool is_clear = false;
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
  /// \param positions in the order of a space-filling curve; outlive this
  PlaceModels(std::span<const Vec3> positions, const Threads& threads);
  /// The same neighbours at other places. \param before outlives this \param positions outlive this, near those before
  PlaceModels(const PlaceModels& before, std::span<const Vec3> positions);

  /// Of all samples, where they were at first.
  [[nodiscard]] const PointTree& tree() const { return *densities_.front().tree; }

  [[nodiscard]] PlaceModel at(const Vec3& place) const;
  /// Of the samples within the bound of the noise, with Gaussian weights of 2 deviations.
  [[nodiscard]] MeanPlane mean_plane(const Vec3& place, double noise) const;

 private:
  /// All samples, every third, ninth ...: wide neighbourhoods are told from as few samples as narrow ones.
  struct Density {
    std::vector<Vec3> some; ///< of the positions; none where it is all
    std::shared_ptr<const PointTree> tree;
  };
  [[nodiscard]] std::span<const Vec3> points(std::size_t density) const {
    return density == 0 ? positions_ : std::span<const Vec3>(densities_[density].some);
  }
  [[nodiscard]] PlaceModel flat_at(const Vec3& place) const;
  [[nodiscard]] bool is_smooth_up_close(std::span<const Vec3> points, std::span<const std::uint32_t> around) const;

  std::span<const Vec3> positions_;
  std::vector<Density> densities_; ///< the finest first
};

} // namespace eigencrust
