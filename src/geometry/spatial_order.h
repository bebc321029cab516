// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Points along a Hilbert curve.
#pragma once

#include <eigencrust/types.h>
#include <cstdint>

namespace eigencrust {

/// Position along a Hilbert curve of 2^21 cells per axis over the cube around `box`; points of one cell
/// share a key. Source: Skilling, Programming the Hilbert curve (2004).
std::uint64_t hilbert_key(const Vec3& point, const Box3& box);

} // namespace eigencrust
