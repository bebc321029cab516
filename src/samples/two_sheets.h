// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The two sides of a thin wall are no noise.
#pragma once

#include <optional>
#include <span>

#include "samples/local_frame.h"

namespace eigencrust {

struct TwoSheets {
  double gap;       ///< between their means
  double deviation; ///< standard deviation within each
  double aside;     ///< how far their means are apart along the sheets; much of the width where it is a step
};

/// Two parallel sheets, if the points lie in two: their offsets from a common quadric fall into halves (least squares)
/// whose means are more than 5 deviations apart. Noise about one sheet gives 2.65 (Gaussian) to 3.5 (uniform), two
/// walls 9 and more. \param index points of a flat neighbourhood, 30 or more; \param frame theirs
std::optional<TwoSheets> two_sheets(std::span<const Vec3> points, std::span<const std::uint32_t> index,
                                    const LocalFrame& frame);

} // namespace eigencrust
