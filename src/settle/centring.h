// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The middle of noisy samples.
#pragma once

#include <eigencrust/stages.h>

namespace eigencrust {

/// Where noise exceeds the spacing (`reach` > 0, see find_poles): moves the boundary between inside and outside to
/// the middle of the samples, half of them on either side, and smooths it at the scale of a few spacings. The harmonic
/// values leave it on the inner side, and nowhere in thin parts. Only tetrahedra that the first stage left open
/// (`first`) change (not in the paper).
struct CentringCounts {
  std::uint64_t relabelled = 0; ///< tetrahedra
};
CentringCounts centre_in_noise(const Tetrahedralization& tetrahedralization, const VertexStars& stars,
                               std::span<const float> reach, std::span<const float> isolated, const Labels& first,
                               const Threads& threads, TetrahedronLabels& labels);

} // namespace eigencrust
