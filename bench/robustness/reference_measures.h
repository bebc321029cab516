// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Measures for single cases: a lid over a hole, a result beside an undisturbed one, a scan beside a model of
/// the same thing.
#pragma once

#include <cstdint>
#include <vector>

#include <eigencrust/types.h>

#include "figures.h"
#include "scene.h"

namespace eigencrust::bench {

/// The patch is the part of the surface farther than 3 spacings from the true samples. patch_area: share of the
/// surface; patch_q95_of_diagonal: 95 % of it are nearer to the truth than that share of the truth's diagonal.
/// Both 0 where there is no patch.
void measure_patch(const Scene& scene, const TriangleMesh& mesh, unsigned threads, Figures& figures);

/// Share of each surface that is within `tolerance` of the other: within_tolerance_of_reference (the mesh) and
/// reference_within_tolerance.
void measure_tolerance(const TriangleMesh& mesh, const TriangleMesh& reference, double tolerance, unsigned threads,
                       Figures& figures);

/// The vertices at the top of the `count` most prominent peaks of the mesh along `up`, highest first. The
/// prominence of a peak is how far one must descend from it to reach a higher one.
std::vector<std::uint32_t> peaks(const TriangleMesh& mesh, const Vec3& up, std::size_t count);

/// For each of two peaks of the reference along y: tip_1 and tip_2, the greatest distance to the mesh from the
/// reference's vertices within `radius` of the peak. Times `unit`.
void measure_tips(const TriangleMesh& mesh, const TriangleMesh& reference, double radius, double unit, unsigned threads,
                  Figures& figures);

/// After a similarity that lays `model` onto the mesh: fitted_scale, and distances between the surfaces times
/// `unit`: model_q99 and model_max (mesh to model), model_from_q99, model_from_max (model to mesh).
void measure_against_model(const TriangleMesh& mesh, const TriangleMesh& model, double unit, unsigned threads,
                           Figures& figures);

} // namespace eigencrust::bench
