// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Sums of squared distances to planes (Garland and Heckbert, Surface Simplification Using Quadric Error Metrics,
/// 1997).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include <eigencrust/types.h>

namespace eigencrust {

/// x -> x A x + 2 b x + c, the sum over some planes of weight × squared distance.
class Quadric {
 public:
  Quadric() = default;
  /// \param normal unit vector of the plane through `point`
  Quadric(const Vec3& normal, const Vec3& point, double weight) : c_(weight), weight_(weight) {
    const double d = -dot(normal, point);
    a_ = {weight * normal.x * normal.x, weight * normal.x * normal.y, weight * normal.x * normal.z,
          weight * normal.y * normal.y, weight * normal.y * normal.z, weight * normal.z * normal.z};
    b_ = (weight * d) * normal;
    c_ *= d * d;
  }

  Quadric& operator+=(const Quadric& o) {
    for (std::size_t i = 0; i < a_.size(); ++i) a_[i] += o.a_[i];
    b_ = b_ + o.b_;
    c_ += o.c_;
    weight_ += o.weight_;
    return *this;
  }
  friend Quadric operator+(Quadric q, const Quadric& o) { return q += o; }

  [[nodiscard]] double weight() const { return weight_; }
  /// Never negative: rounding of what cancels is taken off.
  [[nodiscard]] double at(const Vec3& x) const { return std::max(0.0, dot(x, applied_to(x) + 2 * b_) + c_); }
  /// The place of the least sum of this and of `pull` × weight × the squared distance from `rest`, which decides where
  /// the planes leave it open. \param pull > 0
  [[nodiscard]] Vec3 least(const Vec3& rest, double pull) const {
    // Of the step y from `rest`: (A + pull weight) y = -(A rest + b), symmetric and positive definite.
    const double k = pull * weight_;
    if (!(k > 0)) return rest;
    const Vec3 r = applied_to(rest) + b_;
    const double d0 = a_[0] + k, l1 = a_[1] / d0, l2 = a_[2] / d0;
    const double d1 = a_[3] + k - l1 * a_[1], m = a_[4] - l1 * a_[2], l3 = m / d1;
    const double d2 = a_[5] + k - l2 * a_[2] - l3 * m;
    if (!(d1 > 0) || !(d2 > 0)) return rest;
    const double f1 = r.y - l1 * r.x, f2 = r.z - l2 * r.x - l3 * f1;
    const double z = f2 / d2, y = f1 / d1 - l3 * z, x = r.x / d0 - l1 * y - l2 * z;
    return rest - Vec3{x, y, z};
  }

 private:
  [[nodiscard]] Vec3 applied_to(const Vec3& x) const {
    return {a_[0] * x.x + a_[1] * x.y + a_[2] * x.z, a_[1] * x.x + a_[3] * x.y + a_[4] * x.z,
            a_[2] * x.x + a_[4] * x.y + a_[5] * x.z};
  }

  std::array<double, 6> a_{}; ///< xx, xy, xz, yy, yz, zz
  Vec3 b_;
  double c_ = 0, weight_ = 0;
};

} // namespace eigencrust
