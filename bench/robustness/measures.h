// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What every result is measured by. Each function adds the figures that the scene's truth allows. Lengths
/// are in spacings of the true samples, shares from 0 to 1.
#pragma once

#include <eigencrust/eigencrust.h>

#include "figures.h"
#include "scene.h"

namespace eigencrust::bench {

/// components; genus: sum over as many of the largest components as the truth has, so that specks do not hide
/// the body's; genus_total; vertices; volume.
void measure_topology(const Scene& scene, const Result& result, Figures& figures);

/// true_samples_kept: share of the distinct true samples that are vertices of the surface.
/// outliers_kept: share of the vertices that are outliers.
void measure_kept(const Scene& scene, const Result& result, Figures& figures);

/// to_truth_mean, to_truth_q95, to_truth_max, from_truth_mean, from_truth_q95, from_truth_max, hausdorff
/// between points spread over both surfaces; far_vertices: share of the vertices farther than 2 spacings
/// from the truth.
void measure_distances(const Scene& scene, const Result& result, unsigned threads, Figures& figures);

/// volume_error: |V - truth| / truth.
void measure_volume(const Scene& scene, const Result& result, Figures& figures);

/// area; area_error: |A - truth| / truth.
void measure_area(const Scene& scene, const Result& result, Figures& figures);

/// sharp_edges_kept: share of the length of the body's sharp edges that edges of the mesh run along.
void measure_sharp_edges(const Scene& scene, const Result& result, Figures& figures);

/// clean_rows_kept: share of the distinct samples of the clean bodies that are vertices of the surface; of the
/// worst body.
void measure_clean_rows(const Scene& scene, const Result& result, Figures& figures);

/// Of the tetrahedra whose circumcentre lies inside the cloud's bounding box and more than 3 spacings from
/// the true surface: deep_tetrahedra, how many; wrong_deep_tetrahedra, how many have the wrong label;
/// wrong_deep_share. Only where inside is known by formula.
void measure_deep_tetrahedra(const Scene& scene, const Result& result, unsigned threads, Figures& figures);

/// All of the above.
void measure(const Scene& scene, const Result& result, unsigned threads, Figures& figures);

} // namespace eigencrust::bench
