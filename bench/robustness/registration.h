// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// One surface laid onto another of the same shape but another place, size and orientation.
#pragma once

#include <array>
#include <span>

#include <eigencrust/types.h>

namespace eigencrust::bench {

/// p -> scale · R p + translation.
struct Similarity {
  double scale = 1;
  std::array<Vec3, 3> rotation{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}; ///< rows of R
  Vec3 translation;

  [[nodiscard]] Vec3 apply(const Vec3& p) const;
  [[nodiscard]] Similarity inverse() const;
};

/// The similarity that takes from[i] nearest to to[i] in the least-squares sense (Umeyama 1991).
Similarity fit_similarity(std::span<const Vec3> from, std::span<const Vec3> to);

/// The similarity that lays `moving` onto `fixed`: iterative closest points (Besl and McKay 1992) in both
/// directions, the farthest tenth of the pairs left out, from the best of 28 starts (principal axes, and the
/// 24 rotations of a cube).
Similarity lay_onto(const TriangleMesh& moving, const TriangleMesh& fixed, unsigned threads);

} // namespace eigencrust::bench
