// SPDX-License-Identifier: GPL-3.0-or-later
#include "samples/two_sheets.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace eigencrust {
namespace {

constexpr double least_gap_in_deviations = 5;
// A few stray points are no sheet.
constexpr double least_share = 1.0 / 6;

/// Terms of z(x, y), and last the one that is 1 on the upper sheet: how much higher that is.
enum Term : Eigen::Index { constant, in_x, in_y, in_xx, in_xy, in_yy, is_upper, terms };
using Fit = Eigen::Matrix<double, terms, 1>;

/// Heights over the best quadric that both sheets share.
class SheetFit {
 public:
  SheetFit(std::span<const Vec3> points, std::span<const std::uint32_t> index, const LocalFrame& frame)
      : scale_(std::sqrt(frame.variance[2])) {
    for (const std::uint32_t i : index) {
      const Vec3 d = points[i] - frame.mean;
      const double x = dot(d, frame.axis[1]) / scale_, y = dot(d, frame.axis[2]) / scale_;
      terms_.push_back(Fit{{1, x, y, x * x, x * y, y * y, 0}});
      height_.push_back(dot(d, frame.axis[0]));
    }
  }

  void set_upper(std::size_t k, bool upper) { terms_[k][is_upper] = upper ? 1 : 0; }
  /// \return how much higher the upper sheet is; 0 while none is set
  double fit() {
    auto normal = (Fit::Zero() * Fit::Zero().transpose()).eval();
    Fit right = Fit::Zero();
    for (std::size_t k = 0; k < terms_.size(); ++k) {
      normal += terms_[k] * terms_[k].transpose();
      right += height_[k] * terms_[k];
    }
    if (!(normal(is_upper, is_upper) > 0)) normal(is_upper, is_upper) = 1;
    fit_ = normal.ldlt().solve(right);
    return fit_[is_upper];
  }
  /// Over the lower sheet.
  [[nodiscard]] double offset(std::size_t k) const {
    return height_[k] - fit_.head<is_upper>().dot(terms_[k].head<is_upper>());
  }
  /// Deviation from the own sheet.
  [[nodiscard]] double deviation() const {
    double squares = 0;
    for (std::size_t k = 0; k < terms_.size(); ++k) {
      const double residual = height_[k] - fit_.dot(terms_[k]);
      squares += residual * residual;
    }
    return std::sqrt(squares / static_cast<double>(terms_.size()));
  }
  /// Of the means of both sheets, along them.
  [[nodiscard]] double aside() const {
    std::array<double, 2> x{}, y{}, count{};
    for (const Fit& term : terms_) {
      const auto sheet = static_cast<std::size_t>(term[is_upper]);
      x[sheet] += term[in_x];
      y[sheet] += term[in_y];
      count[sheet] += 1;
    }
    return scale_ * std::hypot(x[1] / count[1] - x[0] / count[0], y[1] / count[1] - y[0] / count[0]);
  }
  [[nodiscard]] std::size_t size() const { return terms_.size(); }

 private:
  double scale_; ///< length of a unit
  std::vector<Fit> terms_;
  std::vector<double> height_;
  Fit fit_ = Fit::Zero();
};

/// Where the sorted values fall into two parts with the least squares within; the smallest value of the upper part.
double best_split(std::vector<double> z) {
  std::sort(z.begin(), z.end());
  const std::size_t n = z.size();
  double sum = 0;
  for (const double v : z) sum += v;
  double below = 0, best = -1, split = z.front();
  for (std::size_t k = 1; k < n; ++k) {
    below += z[k - 1];
    const double apart = (sum - below) / static_cast<double>(n - k) - below / static_cast<double>(k);
    const double between = static_cast<double>(k) * static_cast<double>(n - k) * apart * apart;
    if (between <= best) continue;
    best = between;
    split = z[k];
  }
  return split;
}

} // namespace

std::optional<TwoSheets> two_sheets(std::span<const Vec3> points, std::span<const std::uint32_t> index,
                                    const LocalFrame& frame) {
  if (!(frame.variance[1] > 0)) return std::nullopt;
  SheetFit sheets(points, index, frame);
  double gap = sheets.fit();
  std::size_t upper = 0;
  // The first quadric follows the sheets a little; with them told apart it does no more.
  for (int round = 0; round < 2; ++round) {
    std::vector<double> offsets(sheets.size());
    for (std::size_t k = 0; k < offsets.size(); ++k) offsets[k] = sheets.offset(k);
    const double split = best_split(offsets);
    upper = 0;
    for (std::size_t k = 0; k < offsets.size(); ++k) {
      sheets.set_upper(k, offsets[k] >= split);
      upper += offsets[k] >= split;
    }
    gap = sheets.fit();
  }
  const double least = least_share * static_cast<double>(sheets.size());
  if (static_cast<double>(std::min(upper, sheets.size() - upper)) < least) return std::nullopt;
  const double within = sheets.deviation();
  if (!(gap > least_gap_in_deviations * within)) return std::nullopt;
  return TwoSheets{gap, within, sheets.aside()};
}

} // namespace eigencrust
