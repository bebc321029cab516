// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A quadric over the tangent plane of one place, fitted to the samples around it.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>

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
  [[nodiscard]] Foot foot(const Vec3& at) const {
    const Vec3 d = at - origin;
    const double x = dot(u, d), y = dot(v, d);
    const auto& h = height;
    const double z = h[0] + x * (h[1] + x * h[3] + y * h[4]) + y * (h[2] + y * h[5]);
    const Vec3 slope = normal - (h[1] + 2 * h[3] * x + h[4] * y) * u - (h[2] + 2 * h[5] * y + h[4] * x) * v;
    const double shorten = 1 / norm(slope);
    return {shorten * (z - sag - dot(normal, d)), shorten * slope};
  }
  /// How far `at` is from the surface along `direction` (unit), to first order.
  [[nodiscard]] double offset(const Vec3& at, const Vec3& direction) const;
};

/// Weighted least squares (Cleveland 1979; Levin 1998 for surfaces), of several widths at one place at once.
class QuadricFit {
 public:
  static constexpr std::size_t most_widths = 7;
  /// \param normal unit \param widths increasing, > 0, most_widths at most: where the samples' weights end
  QuadricFit(const Vec3& origin, const Vec3& normal, std::span<const double> widths);
  QuadricFit(const Vec3& origin, const Vec3& normal, double width) : QuadricFit(origin, normal, std::span(&width, 1)) {}

  /// Weighs each of the samples (1 - (r / width)²)², r being their distance from the origin along the tangent plane.
  void add(std::span<const SampleCluster* const> clusters);
  void add(const SampleCluster& samples) {
    const SampleCluster* const one = &samples;
    add(std::span(&one, 1));
  }
  /// None where the samples do not determine a quadric and its noise.
  /// \param most_noise what is more about the fit is shape; infinite: nothing is known \param width which of them
  [[nodiscard]] std::optional<LocalQuadric> solve(double most_noise = std::numeric_limits<double>::infinity(),
                                                  std::size_t width = 0) const;

 private:
  static constexpr std::size_t unknowns = 6;
  /// So many rows are written before they are read: what was just written in parts would have to be waited for.
  static constexpr std::size_t batch = 64;
  using Basis = Eigen::Array<double, unknowns, 1>; ///< 1, x, y, x², xy, y² in units of the largest width

  struct Row {
    Basis basis;
    double height, height_square; ///< means over the samples
    double square, count;         ///< of the distance from the origin along the plane; of samples
  };
  struct Width {
    double shrink; ///< the largest width over this one
    Eigen::Array<double, 2, 1> row0, row1;
    Eigen::Array<double, 4, 1> row2, row3;
    Basis row4, row5;               ///< Σ w b bᵀ: the lower triangle, rows filled up to pairs
    Basis right;                    ///< Σ w b z
    Eigen::Array<double, 2, 1> sum; ///< Σ w z² and Σ w²

    void add(std::span<const Row> rows);
  };

  [[nodiscard]] Row row_of(const SampleCluster& samples) const;

  LocalQuadric frame_; ///< of the largest width
  std::size_t count_;
  std::array<Width, most_widths> width_; ///< as many as there are
};

} // namespace eigencrust
