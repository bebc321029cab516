// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Circumcentres of tetrahedra, also of slivers.
#pragma once

#include <eigencrust/types.h>

namespace eigencrust {

/// Centre of the sphere through four points that are not coplanar. Computed in double; where that
/// would lose more than half of the digits, exactly and then rounded.
Vec3 circumcentre(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

} // namespace eigencrust
