// SPDX-License-Identifier: GPL-3.0-or-later
#include "fit/local_quadric.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace eigencrust {

Vec3 LocalQuadric::gradient(double x, double y) const {
  const auto& h = height;
  return normal - (h[1] + 2 * h[3] * x + h[4] * y) * u - (h[2] + 2 * h[5] * y + h[4] * x) * v;
}

LocalQuadric::Foot LocalQuadric::foot(const Vec3& at) const {
  const Vec3 d = at - origin;
  const double x = dot(u, d), y = dot(v, d);
  const auto& h = height;
  const double z = h[0] + x * (h[1] + x * h[3] + y * h[4]) + y * (h[2] + y * h[5]);
  const Vec3 slope = gradient(x, y);
  const double shorten = 1 / norm(slope);
  return {shorten * (z - sag - dot(normal, d)), shorten * slope};
}

double LocalQuadric::offset(const Vec3& at, const Vec3& direction) const {
  constexpr double least_cosine = 0.3; // more askew, the foot would be far off
  const auto [ahead, across] = foot(at);
  return ahead / std::max(least_cosine, dot(across, direction));
}

QuadricFit::QuadricFit(const Vec3& origin, const Vec3& normal, double width) {
  fit_.origin = origin;
  fit_.normal = normal;
  const Vec3 across = cross(normal, std::fabs(normal.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0});
  fit_.u = (1 / (norm(across) * width)) * across;
  fit_.v = cross(normal, fit_.u);
}

void QuadricFit::add(const SampleCluster& samples) {
  const Vec3 d = samples.mean - fit_.origin;
  const double x = dot(fit_.u, d), y = dot(fit_.v, d), z = dot(fit_.normal, d);
  const double nearness = 1 - x * x - y * y;
  if (!(nearness > 0) || !(samples.count > 0)) return;
  const double w = samples.count * nearness * nearness;
  std::array<double, unknowns> b{1, x, y, x * x, x * y, y * y};
  double square = z * z;
  if (samples.count > 1) {
    b[3] += samples.covariance(fit_.u, fit_.u);
    b[4] += samples.covariance(fit_.u, fit_.v);
    b[5] += samples.covariance(fit_.v, fit_.v);
    square += samples.covariance(fit_.normal, fit_.normal);
  }
  std::size_t k = 0;
  for (std::size_t i = 0; i < unknowns; ++i) {
    const double wb = w * b[i];
    for (std::size_t j = 0; j <= i; ++j) moments_[k++] += wb * b[j];
    right_[i] += wb * z;
  }
  squares_ += w * square;
  weight_squares_ += w * nearness * nearness;
}

std::optional<LocalQuadric> QuadricFit::solve(double most_noise) const {
  using Matrix = Eigen::Matrix<double, unknowns, unknowns>;
  using Vector = Eigen::Matrix<double, unknowns, 1>;
  // As many as there are unknowns, and some that say how well they fit.
  constexpr double least_samples = 10;
  constexpr double ridge = 1e-9; // of the weight: samples in a row determine no quadric, but should not blow up either
  const double total = moments_[0];
  if (!(total * total > least_samples * weight_squares_)) return std::nullopt;
  Matrix moments;
  std::size_t k = 0;
  for (Eigen::Index i = 0; i < moments.rows(); ++i)
    for (Eigen::Index j = 0; j <= i; ++j) moments(i, j) = moments(j, i) = moments_[k++];
  const Eigen::LLT<Matrix> solver(moments + ridge * total * Matrix::Identity());
  if (solver.info() != Eigen::Success) return std::nullopt;
  const Vector right(right_.data()), height = solver.solve(right);
  LocalQuadric fit = fit_;
  std::copy_n(height.data(), unknowns, fit.height.begin());
  // The mean of samples with weights w has the variance Σ w² / (Σ w)²; as many times 1 / Σ w is what a fit has.
  const double share = weight_squares_ / total;
  const double freedom = total - static_cast<double>(unknowns) * share;
  fit.noise_variance = freedom > 0 ? std::max(0.0, squares_ - height.dot(right)) / freedom : 0;
  const double bend = std::min(fit.noise_variance, most_noise * most_noise) * squared_norm(fit.u);
  fit.sag = bend * (height[3] + height[5]);
  Vector functional = Vector::Zero();
  functional[0] = 1;
  functional[3] = functional[5] = -bend;
  fit.variance = functional.dot(solver.solve(functional)) * share;
  return fit;
}

} // namespace eigencrust
