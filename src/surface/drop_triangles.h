// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>

#include <eigencrust/stages.h>

namespace eigencrust {

/// Takes away the triangles where `gone` is not 0, and vertices that are then without one; the order stays.
void drop_triangles(std::span<const std::uint8_t> gone, Surface& surface);

} // namespace eigencrust
