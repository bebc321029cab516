// SPDX-License-Identifier: GPL-3.0-or-later
#include "fit/local_quadric.h"

#include <algorithm>
#include <cmath>

namespace eigencrust {

double LocalQuadric::offset(const Vec3& at, const Vec3& direction) const {
  constexpr double least_cosine = 0.3; // more askew, the foot would be far off
  const auto [ahead, across] = foot(at);
  return ahead / std::max(least_cosine, dot(across, direction));
}

QuadricFit::QuadricFit(const Vec3& origin, const Vec3& normal, std::span<const double> widths) : count_(widths.size()) {
  frame_.origin = origin;
  frame_.normal = normal;
  const double largest = widths.back();
  const Vec3 across = cross(normal, std::fabs(normal.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0});
  frame_.u = (1 / (norm(across) * largest)) * across;
  frame_.v = cross(normal, frame_.u);
  for (std::size_t k = 0; k < count_; ++k) {
    Width& width = width_[k];
    width.shrink = largest / widths[k];
    width.row0 = width.row1 = width.sum = 0;
    width.row2 = width.row3 = 0;
    width.row4 = width.row5 = width.right = 0;
  }
}

inline QuadricFit::Row QuadricFit::row_of(const SampleCluster& samples) const {
  const Vec3 d = samples.mean - frame_.origin;
  const double x = dot(frame_.u, d), y = dot(frame_.v, d), z = dot(frame_.normal, d);
  const double xx = x * x, yy = y * y;
  Row row{{}, z, z * z, xx + yy, samples.count};
  if (samples.count > 1) {
    row.basis << 1, x, y, xx + samples.covariance(frame_.u, frame_.u), x * y + samples.covariance(frame_.u, frame_.v),
        yy + samples.covariance(frame_.v, frame_.v);
    row.height_square += samples.covariance(frame_.normal, frame_.normal);
  } else {
    row.basis << 1, x, y, xx, x * y, yy;
  }
  return row;
}

/// Where a width ends is anybody's guess: those within are written down first.
void QuadricFit::Width::add(std::span<const Row> rows) {
  std::array<std::uint8_t, batch> within;
  std::size_t count = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    within[count] = static_cast<std::uint8_t>(i);
    count += rows[i].square * (shrink * shrink) < 1 ? 1 : 0;
  }
  for (const std::uint8_t i : std::span(within).first(count)) {
    const Row& row = rows[i];
    const double nearness = 1 - row.square * (shrink * shrink);
    const double squared = nearness * nearness, w = row.count * squared;
    const Basis& b = row.basis;
    row0 += w * b.head<2>();
    row1 += w * b[1] * b.head<2>();
    row2 += w * b[2] * b.head<4>();
    row3 += w * b[3] * b.head<4>();
    row4 += w * b[4] * b;
    row5 += w * b[5] * b;
    right += w * row.height * b;
    sum += w * Eigen::Array<double, 2, 1>(row.height_square, squared);
  }
}

void QuadricFit::add(std::span<const SampleCluster* const> clusters) {
  std::array<Row, batch> rows;
  while (!clusters.empty()) {
    const std::size_t look = std::min(batch, clusters.size());
    std::size_t count = 0;
    for (const SampleCluster* samples : clusters.first(look)) {
      rows[count] = row_of(*samples);
      const bool is_near = rows[count].square<1, is_any = samples->count> 0;
      count += is_near & is_any;
    }
    for (std::size_t k = 0; k < count_; ++k) width_[k].add(std::span(rows).first(count));
    clusters = clusters.subspan(look);
  }
}

namespace {

/// Cholesky's factors L D Lᵀ of a symmetric matrix, given and kept as its lower triangle row by row.
template <std::size_t n>
class Factors {
 public:
  using Vector = std::array<double, n>;

  /// \return is the matrix positive definite?
  bool factor(const std::array<double, n*(n + 1) / 2>& matrix) {
    l_ = matrix;
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        double sum = at(i, j);
        for (std::size_t m = 0; m < j; ++m) sum -= scaled_[m] * at(j, m);
        scaled_[j] = sum; // L D
      }
      double pivot = at(i, i);
      for (std::size_t j = 0; j < i; ++j) {
        const double l = scaled_[j] * inverse_[j];
        pivot -= scaled_[j] * l;
        at(i, j) = l;
      }
      if (!(pivot > 0)) return false;
      inverse_[i] = 1 / pivot;
    }
    return true;
  }
  /// L⁻¹ right.
  [[nodiscard]] Vector half_solved(Vector right) const {
    for (std::size_t i = 1; i < n; ++i)
      for (std::size_t j = 0; j < i; ++j) right[i] -= at(i, j) * right[j];
    return right;
  }
  /// The square of what half_solved() gave, which is right · A⁻¹ right.
  [[nodiscard]] double square(const Vector& half) const {
    double sum = 0;
    for (std::size_t i = 0; i < n; ++i) sum += half[i] * half[i] * inverse_[i];
    return sum;
  }
  [[nodiscard]] Vector solved(Vector half) const {
    for (std::size_t i = n; i-- > 0;) {
      half[i] *= inverse_[i];
      for (std::size_t j = i + 1; j < n; ++j) half[i] -= at(j, i) * half[j];
    }
    return half;
  }

 private:
  [[nodiscard]] double at(std::size_t i, std::size_t j) const { return l_[i * (i + 1) / 2 + j]; }
  double& at(std::size_t i, std::size_t j) { return l_[i * (i + 1) / 2 + j]; }
  std::array<double, n*(n + 1) / 2> l_; ///< below the diagonal
  Vector inverse_;                      ///< of D
  Vector scaled_;                       ///< the row that is looked at, of L D
};

} // namespace

std::optional<LocalQuadric> QuadricFit::solve(double most_noise, std::size_t width) const {
  // As many as there are unknowns, and some that say how well they fit.
  constexpr double least_samples = 10;
  constexpr double ridge = 1e-9; // of the weight: samples in a row determine no quadric, but should not blow up either
  const Width& w = width_[width];
  const double total = w.row0[0], weight_squares = w.sum[1], shrink = w.shrink;
  if (!(total * total > least_samples * weight_squares)) return std::nullopt;
  const double square = shrink * shrink;
  const std::array<double, unknowns> unit{1, shrink, shrink, square, square, square}; // of the basis of this width
  const std::array<const double*, unknowns> rows{w.row0.data(), w.row1.data(), w.row2.data(),
                                                 w.row3.data(), w.row4.data(), w.row5.data()};
  std::array<double, unknowns*(unknowns + 1) / 2> moments;
  std::array<double, unknowns> right;
  for (std::size_t i = 0, k = 0; i < unknowns; ++i) {
    for (std::size_t j = 0; j <= i; ++j, ++k) moments[k] = unit[i] * unit[j] * rows[i][j];
    moments[k - 1] += ridge * total;
    right[i] = unit[i] * w.right[static_cast<Eigen::Index>(i)];
  }
  Factors<unknowns> solver;
  if (!solver.factor(moments)) return std::nullopt;
  const auto half = solver.half_solved(right);
  LocalQuadric fit = frame_;
  fit.u = shrink * fit.u;
  fit.v = shrink * fit.v;
  fit.height = solver.solved(half);
  // The mean of samples with weights w has the variance Σ w² / (Σ w)²; as many times 1 / Σ w is what a fit has.
  const double share = weight_squares / total;
  const double freedom = total - static_cast<double>(unknowns) * share;
  fit.noise_variance = freedom > 0 ? std::max(0.0, w.sum[0] - solver.square(half)) / freedom : 0;
  const double bend = std::min(fit.noise_variance, most_noise * most_noise) * squared_norm(fit.u);
  fit.sag = bend * (fit.height[3] + fit.height[5]);
  fit.variance = solver.square(solver.half_solved({1, 0, 0, -bend, 0, -bend})) * share;
  return fit;
}

} // namespace eigencrust
