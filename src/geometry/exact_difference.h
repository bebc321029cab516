// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Does a subtraction round?
#pragma once

#include <eigencrust/types.h>

namespace eigencrust {

/// Whether p - o is exact in all coordinates, by what each loses (Knuth's error-free transformation; all operations
/// are single ones).
inline bool is_exact_difference(const Vec3& p, const Vec3& o) {
  const auto lost = [](double a, double b) {
    const double d = a - b, back = a - d;
    return (a - (d + back)) + (back - b);
  };
  return lost(p.x, o.x) == 0 && lost(p.y, o.y) == 0 && lost(p.z, o.z) == 0;
}

} // namespace eigencrust
