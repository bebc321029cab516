// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Tables of places.
#pragma once

#include <bit>
#include <cstdint>

#include <eigencrust/types.h>

namespace eigencrust {

/// Equal places have equal hashes: 0 and -0 are one number.
struct PlaceHash {
  std::size_t operator()(const Vec3& p) const {
    std::uint64_t hash = 0;
    for (const double c : {p.x, p.y, p.z}) // multiply by the golden ratio, fold the upper bits in
      hash = (hash ^ std::bit_cast<std::uint64_t>(c == 0 ? 0.0 : c)) * 0x9e3779b97f4a7c15u, hash ^= hash >> 29;
    return hash;
  }
};

} // namespace eigencrust
