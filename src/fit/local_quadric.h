// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A quadric over the tangent plane of one place, fitted to the samples around it.
#pragma once

#include <array>
#include <limits>
#include <optional>

#include <eigencrust/types.h>

#include "fit/sample_clusters.h"

namespace eigencrust {

/// Height z(x, y) over the plane through `origin` across `normal`, with x = u·(p - origin) and y = v·(p - origin).
struct LocalQuadric {
  Vec3 origin, normal;          ///< normal: unit
  Vec3 u, v;                    ///< orthogonal to the normal and to each other, of length 1 / width
  std::array<double, 6> height; ///< of 1, x, y, x², xy, y²; length
  /// How much lower samples with noise in all directions lie on average than the surface: where it bends, those that
  /// strayed sideways hang below it. σ² times the sum of the second coefficients, as a length.
  double sag = 0;
  double variance = 0;       ///< of the height without the sag, at the origin, in units of that of a sample
  double noise_variance = 0; ///< of the samples about the fit; length²

  struct Foot {
    double ahead; ///< how far the point is from the surface along its normal, to first order; positive: it lies ahead
    Vec3 normal;  ///< of the fit there, unit
  };
  [[nodiscard]] Foot foot(const Vec3& at) const;
  /// How far `at` is from the surface along `direction` (unit), to first order.
  [[nodiscard]] double offset(const Vec3& at, const Vec3& direction) const;

 private:
  [[nodiscard]] Vec3 gradient(double x, double y) const;
};

/// Weighted least squares (Cleveland 1979; Levin 1998 for surfaces).
class QuadricFit {
 public:
  /// \param normal unit; \param width > 0, where the samples' weights end
  QuadricFit(const Vec3& origin, const Vec3& normal, double width);

  /// Weighs each of the samples (1 - (r / width)²)², r being their distance from the origin along the tangent plane.
  void add(const SampleCluster& samples);
  /// None where the samples do not determine a quadric and its noise.
  /// \param most_noise what is more about the fit is shape; infinite: nothing is known
  [[nodiscard]] std::optional<LocalQuadric> solve(double most_noise = std::numeric_limits<double>::infinity()) const;

 private:
  static constexpr std::size_t unknowns = 6;

  LocalQuadric fit_;
  std::array<double, unknowns*(unknowns + 1) / 2> moments_{}; ///< lower triangle of Σ w b bᵀ
  std::array<double, unknowns> right_{};                      ///< Σ w b z
  double squares_ = 0;                                        ///< Σ w z²
  double weight_squares_ = 0;                                 ///< Σ w²
};

} // namespace eigencrust
