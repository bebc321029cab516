// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Tables of places.
#pragma once

#include <array>
#include <functional>
#include <string_view>

#include <eigencrust/types.h>

namespace eigencrust {

/// Equal places have equal hashes: 0 and -0 are one number.
struct PlaceHash {
  std::size_t operator()(const Vec3& p) const {
    const std::array key{p.x + 0.0, p.y + 0.0, p.z + 0.0}; // -0 is 0
    return std::hash<std::string_view>()({reinterpret_cast<const char*>(key.data()), sizeof key});
  }
};

} // namespace eigencrust
