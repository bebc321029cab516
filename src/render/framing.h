// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Which points a picture has to hold.
#pragma once

#include <vector>

#include <eigencrust/types.h>

namespace eigencrust {

/// The points without those that lie apart, which would make the rest small. All of them where that hardly changes
/// the size of the box. \param points finite
std::vector<Vec3> bulk_of(std::vector<Vec3> points);

} // namespace eigencrust
