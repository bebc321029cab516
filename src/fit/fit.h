// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The surface through the middle of the noise (not in the paper; docs/decisions/0036).
#pragma once

#include <span>
#include <vector>

#include <eigencrust/options.h>
#include <eigencrust/stages.h>

#include "samples/sample_model.h"
#include "surface/fans.h"

namespace eigencrust {

/// The noise at each vertex of the surface that is to be fitted, negative at those that stay; empty: all stay.
/// \param fans of the surface \param kind samples: all stay; fitted: none; automatic: those without noise. There is
///        some where it is more than 0.03 spacings at three vertices of four of the piece (curvature is mistaken for
///        noise only in places), or more than 0.1 spacings at one of ten, and ten edges around, for thin parts read as
///        free of it.
std::vector<float> noise_to_fit(const Surface& surface, const SurfaceFans& fans, const SampleModel& model,
                                SurfaceKind kind, const Threads& threads);

/// The places of all vertices after those that `noise` is given for have moved to the middle of the samples around.
/// They start from where a few steps of smoothing leave them, so that triangles are in order, and then move onto
/// the local fits around, which are as wide as the samples allow. None moves farther than 3 deviations of the noise
/// that the fits find and, where they agree, one spacing. \param samples distinct \param noise of each vertex;
/// negative: it stays
std::vector<Vec3> fitted_vertices(const Surface& surface, const SurfaceFans& fans, std::span<const Vec3> samples,
                                  const SampleModel& model, std::span<const float> noise, const Threads& threads);

} // namespace eigencrust
