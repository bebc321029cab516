// SPDX-License-Identifier: GPL-3.0-or-later
#include "settle/noise_planes.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/nearest.h"
#include "geometry/tetrahedron.h"
#include "samples/scales.h"

namespace eigencrust {
namespace {

// Each plane takes the side that those around vote for.
constexpr std::size_t voters = neighbours_around;
// Planes are averaged with those around, with Gaussian weights; not with those beyond a crease.
constexpr double smoothing_in_sigmas = 2, least_cosine = 0.3;

/// Centroids of the poles' tetrahedra with that label, without those at the cube: where that side is known to be.
std::vector<Vec3> known_places(const Tetrahedralization& t, const Poles& poles, const Labels& labels, Label side) {
  std::vector<Vec3> places;
  for (const TetrahedronIndex i : poles.tetrahedron) {
    if (labels[i] != side || t.touches_cube(i)) continue;
    places.push_back(centroid(corners_of(t, i)));
  }
  return places;
}

Vec3 nearest_of(const PointTree& tree, std::span<const Vec3> places, const Vec3& at) {
  std::uint32_t index = 0;
  double square = 0;
  tree.nearest(at, 1, &index, &square);
  return places[index];
}

/// The planes that there are, one for some of the runs.
struct Planes {
  std::vector<std::uint32_t> run;
  std::vector<Vec3> mean, normal;
  std::vector<std::array<std::uint32_t, voters>> around; ///< of each, itself included
};

Planes planes_of(const SampleModel& model, const Threads& threads) {
  Planes planes;
  for (std::uint32_t r = 0; r < model.plane.size(); ++r) {
    if (squared_norm(model.plane[r].normal) == 0) continue;
    planes.run.push_back(r);
    planes.mean.push_back(model.plane[r].mean);
    planes.normal.push_back(model.plane[r].normal);
  }
  if (planes.run.empty()) return planes;
  planes.around.resize(planes.run.size());
  const PointTree tree(planes.mean);
  for_each_index(
      threads, planes.run.size(),
      [&](std::size_t p) {
        std::array<double, voters> square{};
        planes.around[p].fill(static_cast<std::uint32_t>(p));
        tree.nearest(planes.mean[p], std::min(voters, planes.run.size()), planes.around[p].data(), square.data());
      },
      costly_block);
  return planes;
}

/// > 0 where the normal looks outward: from the nearest pole inside to the nearest outside; then by a vote of the
/// planes around, for those whose poles say nothing or are wrong.
std::vector<double> sides_of(const Planes& planes, std::span<const Vec3> outside, std::span<const Vec3> inside,
                             const Threads& threads) {
  const PointTree outside_tree(outside), inside_tree(inside);
  std::vector<double> side(planes.run.size());
  for_each_index(
      threads, side.size(),
      [&](std::size_t p) {
        const Vec3& at = planes.mean[p];
        const Vec3 way = nearest_of(outside_tree, outside, at) - nearest_of(inside_tree, inside, at);
        side[p] = norm(way) > 0 ? dot(way, planes.normal[p]) / norm(way) : 0;
      },
      costly_block);
  std::vector<double> voted(side.size());
  for_each_index(threads, side.size(), [&](std::size_t p) {
    double sum = 0;
    for (const std::uint32_t q : planes.around[p]) sum += side[q] * dot(planes.normal[q], planes.normal[p]);
    voted[p] = sum;
  });
  return voted;
}

/// Smoother, by the planes around with the weights that each has for its samples; none wider, for a wide mean of
/// tangent planes lies beyond a bent surface.
MeanPlane smoothed(const Planes& planes, const std::vector<double>& side, std::size_t p, double width) {
  MeanPlane plane{planes.mean[p], (side[p] < 0 ? -1.0 : 1.0) * planes.normal[p]};
  Vec3 normal;
  double height = 0, total = 0;
  for (const std::uint32_t q : planes.around[p]) {
    const Vec3 n = (side[q] > 0 ? 1.0 : side[q] < 0 ? -1.0 : 0.0) * planes.normal[q];
    if (!(dot(n, plane.normal) > least_cosine)) continue;
    const double w = std::exp(-squared_norm(planes.mean[q] - plane.mean) / (2 * width * width));
    normal = normal + w * n;
    height += w * dot(planes.mean[q] - plane.mean, n);
    total += w;
  }
  plane.normal = (1 / norm(normal)) * normal;
  plane.mean = plane.mean + (height / total) * plane.normal;
  return plane;
}

} // namespace

NoisePlanes::NoisePlanes(const Tetrahedralization& t, const Poles& poles, const Labels& labels,
                         const SampleModel& model, const Threads& threads)
    : model_(model) {
  const Planes planes = planes_of(model, threads);
  if (planes.run.empty()) return;
  const std::vector<Vec3> outside = known_places(t, poles, labels, Label::outside),
                          inside = known_places(t, poles, labels, Label::inside);
  if (outside.empty() || inside.empty()) return;
  const std::vector<double> side = sides_of(planes, outside, inside, threads);
  plane_.resize(model.plane.size());
  for_each_index(threads, side.size(), [&](std::size_t p) {
    const std::uint32_t r = planes.run[p];
    const double width = smoothing_in_sigmas * static_cast<double>(model.noise[r * SampleModel::run]);
    if (side[p] != 0) plane_[r] = smoothed(planes, side, p, width);
  });
}

} // namespace eigencrust
