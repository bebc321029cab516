// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Which samples lie on the surface.
#pragma once

#include <eigencrust/stages.h>

#include "samples/sample_model.h"

namespace eigencrust {

/// Which samples belong to the surface, from the labels (not in the paper; docs/decisions/0014).
struct Classification {
  IndexedArray<SampleIndex, std::uint8_t> inlier; ///< 1 exactly where the confidence is at least 0.5
  /// 1/(1 + (d/τ)²), d being how far the sample is from the surface that its neighbours make and τ the tolerance of
  /// the samples there.
  IndexedArray<SampleIndex, float> confidence;
  /// Vertices of the triangle of `surface` that is nearest; three times the same one where that is a vertex.
  /// Of samples with a plausible vertex of their own it is that.
  IndexedArray<SampleIndex, std::array<std::uint32_t, 3>> place;
};
/// \param surface as kept: pieces that were dropped make no inliers
Classification classify_samples(const Tetrahedralization& tetrahedralization, const Surface& surface,
                                const SampleModel& model, const Threads& threads);

/// Confidences and places again, by the distance from a surface through the middle of the noise: spikes, whose vertices
/// are no plausible ones of `classes`, are no part of it. \param samples where they came from \param fitted the surface
/// of `classes`, its vertices moved \param noise at its vertices
void classify_by_distance(std::span<const Vec3> samples, const Surface& fitted, const SampleModel& model,
                          std::span<const float> noise, Classification& classes, const Threads& threads);

} // namespace eigencrust
