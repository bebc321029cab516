// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Clean samples of a mesh, and how far apart samples are.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <eigencrust/types.h>

namespace eigencrust::bench {

/// Median distance from a point to the nearest other one; equal points count once. 0 with fewer than two.
double median_spacing(std::span<const Vec3> points, unsigned threads);

/// About `count` samples no two of which are close: darts thrown at the surface, each kept if it is farther
/// from all earlier ones than the radius there. Without `relative_radius` the radius is the same all over;
/// with it, it is proportional to relative_radius(p) > 0. The same for the same seed.
std::vector<Vec3> even_samples(const TriangleMesh& mesh, std::size_t count, std::uint64_t seed,
                               const std::function<double(const Vec3&)>& relative_radius = {});

/// The points that are no nearer than `radius` to one kept before them; in order.
std::vector<Vec3> thinned(std::vector<Vec3> points, double radius);

/// Samples of ball_with_sheet(2 · spacing) as a careful scanner would take them: a square grid on the plate,
/// with samples on all its edges, each inner one moved by up to 5 % of the spacing; a spiral of that spacing on
/// the ball.
std::vector<Vec3> ball_with_sheet_samples(double spacing, std::uint64_t seed);

/// Area that each vertex stands for: a third of its triangles.
std::vector<double> vertex_areas(const TriangleMesh& mesh);

/// 64-bit FNV-1a hash of the coordinates' bytes, by which two runs tell that they had the same cloud.
std::uint64_t fingerprint(std::span<const Vec3> points);

} // namespace eigencrust::bench
