// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Where the surface is beside each vertex, by fits of one width.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <eigencrust/types.h>

#include "geometry/nearest.h"
#include "parallel/threads.h"

namespace eigencrust {

/// Vertices that are to be fitted, and the samples.
struct FitPlaces {
  std::span<const Vec3> samples;
  const PointTree& sample_tree;
  std::vector<Vec3> position, normal; ///< of each vertex; normal: unit, or 0 where nothing is to be fitted
  std::vector<double> unit;           ///< widths are so many times this length
  std::vector<double> noise;          ///< standard deviation
};

/// The samples' sides: which vertex is nearest to each.
std::vector<std::uint32_t> nearest_vertices(const PointTree& vertices, std::span<const Vec3> samples,
                                            const Threads& threads);

/// The surface as fits of one width see it.
struct Estimate {
  double offset = 0;    ///< from the vertex along its normal
  double deviation = 0; ///< standard deviation of the offset, in units of that of a sample; 0: there is no estimate
  double noise = 0;     ///< standard deviation of the samples about the fits
  Vec3 normal;          ///< unit
};

/// Fits a quadric at some of the vertices, so many that each has one within a quarter of the width, and gives each
/// vertex the weighted mean of those within half of it. Samples of other sides do not count: those whose nearest
/// vertex has a normal that is more than 60° off.
/// \param width  in units of places.unit
/// \param wanted vertices that need an estimate
std::vector<Estimate> estimates(const FitPlaces& places, const PointTree& vertices,
                                std::span<const std::uint32_t> vertex_of, double width,
                                std::span<const std::uint8_t> wanted, const Threads& threads);

} // namespace eigencrust
