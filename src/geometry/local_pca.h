// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// How some points are spread, by principal components.
#pragma once

#include <cstdint>
#include <span>

#include <eigencrust/types.h>

namespace eigencrust {

struct LocalPca {
  Vec3 mean;     ///< relative to the origin that was given
  Vec3 variance; ///< smallest, middle, largest; >= 0
  Vec3 normal;   ///< unit; the direction of the smallest
};
/// \param origin near the points, so that nothing cancels
LocalPca local_pca(std::span<const Vec3> positions, std::span<const std::uint32_t> points, const Vec3& origin);

} // namespace eigencrust
