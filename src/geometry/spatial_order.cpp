// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/spatial_order.h"

#include <algorithm>

namespace eigencrust {
namespace {

constexpr int bits = 21;

/// Cell coordinates to the transposed form of the Hilbert index (Skilling's AxestoTranspose).
void axes_to_transpose(std::array<std::uint32_t, 3>& x) {
  for (std::uint32_t q = 1u << (bits - 1); q > 1; q >>= 1) {
    const std::uint32_t mask = q - 1;
    for (std::uint32_t& xi : x) {
      if (xi & q) {
        x[0] ^= mask;
      } else {
        const std::uint32_t swap = (x[0] ^ xi) & mask;
        x[0] ^= swap;
        xi ^= swap;
      }
    }
  }
  x[1] ^= x[0];
  x[2] ^= x[1];
  std::uint32_t flip = 0;
  for (std::uint32_t q = 1u << (bits - 1); q > 1; q >>= 1)
    if (x[2] & q) flip ^= q - 1;
  for (std::uint32_t& xi : x) xi ^= flip;
}

} // namespace

std::uint64_t hilbert_key(const Vec3& point, const Box3& box) {
  const double side = std::max({box.max.x - box.min.x, box.max.y - box.min.y, box.max.z - box.min.z});
  constexpr double cells = 1u << bits;
  const auto cell = [&](double value, double low) {
    const double scaled = side > 0 ? (value - low) / side * cells : 0.0;
    return static_cast<std::uint32_t>(std::clamp(scaled, 0.0, cells - 1));
  };
  std::array<std::uint32_t, 3> x{cell(point.x, box.min.x), cell(point.y, box.min.y), cell(point.z, box.min.z)};
  axes_to_transpose(x);
  std::uint64_t key = 0;
  for (int b = bits - 1; b >= 0; --b)
    for (const std::uint32_t xi : x) key = key << 1 | ((xi >> b) & 1u);
  return key;
}

} // namespace eigencrust
