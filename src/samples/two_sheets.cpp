// SPDX-License-Identifier: GPL-3.0-or-later
#include "samples/two_sheets.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <vector>

namespace eigencrust {
namespace {

constexpr double least_gap_in_deviations = 5;
// A few stray points are no sheet.
constexpr double least_share = 1.0 / 6;

using Quadric = Eigen::Matrix<double, 6, 1>;

/// Heights over the best quadric z(x, y): what both sheets bend alike is taken out.
std::vector<double> offsets_from_quadric(std::span<const Vec3> points, std::span<const std::uint32_t> index,
                                         const LocalFrame& frame) {
  const double scale = std::sqrt(frame.variance[2]);
  const auto terms = [&](const Vec3& d) {
    const double x = dot(d, frame.axis[1]) / scale, y = dot(d, frame.axis[2]) / scale;
    Quadric q;
    q << 1, x, y, x * x, x * y, y * y;
    return q;
  };
  Eigen::Matrix<double, 6, 6> normal = Eigen::Matrix<double, 6, 6>::Zero();
  Quadric right = Quadric::Zero();
  for (const std::uint32_t i : index) {
    const Vec3 d = points[i] - frame.mean;
    const Quadric q = terms(d);
    normal += q * q.transpose();
    right += dot(d, frame.axis[0]) * q;
  }
  const Quadric fit = normal.ldlt().solve(right);
  std::vector<double> offsets;
  offsets.reserve(index.size());
  for (const std::uint32_t i : index) {
    const Vec3 d = points[i] - frame.mean;
    offsets.push_back(dot(d, frame.axis[0]) - fit.dot(terms(d)));
  }
  return offsets;
}

} // namespace

std::optional<double> deviation_within_sheets(std::span<const Vec3> points, std::span<const std::uint32_t> index,
                                              const LocalFrame& frame) {
  if (!(frame.variance[1] > 0)) return std::nullopt;
  std::vector<double> z = offsets_from_quadric(points, index, frame);
  std::sort(z.begin(), z.end());
  const std::size_t n = z.size();
  double sum = 0, squares = 0;
  for (const double v : z) {
    sum += v;
    squares += v * v;
  }
  const auto least = std::max<std::size_t>(3, static_cast<std::size_t>(least_share * static_cast<double>(n)));
  double below = 0, best = 0, gap = 0;
  for (std::size_t k = 1; k < n; ++k) {
    below += z[k - 1];
    if (k < least || n - k < least) continue;
    const double low = below / static_cast<double>(k), high = (sum - below) / static_cast<double>(n - k);
    const double between =
        static_cast<double>(k) * static_cast<double>(n - k) / static_cast<double>(n) * (high - low) * (high - low);
    if (between <= best) continue;
    best = between;
    gap = high - low;
  }
  const double within =
      std::sqrt(std::max(0.0, (squares - sum * sum / static_cast<double>(n) - best) / static_cast<double>(n)));
  if (!(gap > least_gap_in_deviations * within)) return std::nullopt;
  return within;
}

} // namespace eigencrust
