// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Samples that the surface passes by.
#pragma once

#include <eigencrust/stages.h>

namespace eigencrust {

/// Takes samples into the surface that it passes by closely: the tetrahedron between such a sample and a
/// surface triangle changes sides, which neither opens nor joins anything. Only when such samples are at
/// most `max_share` of those on the surface; more are noise. Isolated samples (may be empty) stay out where they
/// are more than 0.5 % of those (not in the paper).
struct RecoveryCounts {
  std::uint64_t samples = 0; ///< taken in
};
RecoveryCounts recover_samples(const Tetrahedralization& tetrahedralization, const VertexStars& stars,
                               const Labels& known, std::span<const float> isolated, double max_share,
                               TetrahedronLabels& labels);

} // namespace eigencrust
