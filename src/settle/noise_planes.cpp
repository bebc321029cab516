// SPDX-License-Identifier: GPL-3.0-or-later
#include "settle/noise_planes.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/nearest.h"

namespace eigencrust {
namespace {

// Each plane takes the side that so many planes around vote for, so often.
constexpr std::size_t voters = 12;
constexpr int votes = 3;
// Planes are averaged with those around, with Gaussian weights; not with those beyond a crease.
constexpr double smoothing_in_sigmas = 2, least_cosine = 0.3;

/// Centroids of the poles' tetrahedra with that label, without those at the cube: where that side is known to be.
std::vector<Vec3> known_places(const Tetrahedralization& t, const Poles& poles, const Labels& labels, Label side) {
  std::vector<Vec3> places;
  for (const TetrahedronIndex i : poles.tetrahedron) {
    if (labels[i] != side || t.touches_cube(i)) continue;
    Vec3 centroid;
    for (const SampleIndex s : t.tetrahedra[i]) centroid = centroid + 0.25 * t.positions[s];
    places.push_back(centroid);
  }
  return places;
}

Vec3 nearest_of(const PointTree& tree, std::span<const Vec3> places, const Vec3& at) {
  std::uint32_t index = 0;
  double square = 0;
  tree.nearest(at, 1, &index, &square);
  return places[index];
}

} // namespace

NoisePlanes::NoisePlanes(const Tetrahedralization& t, const Poles& poles, const Labels& labels,
                         const SampleModel& model, const Threads& threads)
    : model_(model) {
  const std::size_t runs = model.plane.size();
  std::vector<double> side(runs, 0);
  std::vector<Vec3> at;
  std::vector<std::uint32_t> number;
  for (std::uint32_t r = 0; r < runs; ++r) {
    if (squared_norm(model.plane[r].normal) == 0) continue;
    at.push_back(model.plane[r].mean);
    number.push_back(r);
  }
  if (at.empty()) return;
  const std::vector<Vec3> outside = known_places(t, poles, labels, Label::outside),
                          inside = known_places(t, poles, labels, Label::inside);
  if (outside.empty() || inside.empty()) return;
  const PointTree outside_tree(outside), inside_tree(inside);
  for_each_index(
      threads, at.size(),
      [&](std::size_t p) {
        const Vec3 way = nearest_of(outside_tree, outside, at[p]) - nearest_of(inside_tree, inside, at[p]);
        side[number[p]] = dot(way, model.plane[number[p]].normal) / std::max(norm(way), 1e-300);
      },
      256);
  // Votes of planes around, for those whose poles say nothing or are wrong.
  const PointTree planes(at);
  std::vector<std::array<std::uint32_t, voters>> around(at.size());
  for_each_index(
      threads, at.size(),
      [&](std::size_t p) {
        std::array<double, voters> square{};
        around[p].fill(static_cast<std::uint32_t>(p));
        planes.nearest(at[p], std::min(voters, at.size()), around[p].data(), square.data());
      },
      256);
  std::vector<double> next(at.size());
  for (int vote = 0; vote < votes; ++vote) {
    for_each_index(threads, at.size(), [&](std::size_t p) {
      double sum = 0;
      for (const std::uint32_t q : around[p])
        sum += side[number[q]] * dot(model.plane[number[q]].normal, model.plane[number[p]].normal);
      next[p] = sum;
    });
    for (std::size_t p = 0; p < at.size(); ++p) side[number[p]] = std::clamp(next[p], -1.0, 1.0);
  }
  plane_.resize(runs);
  for_each_index(threads, at.size(), [&](std::size_t p) {
    if (side[number[p]] == 0) return;
    plane_[number[p]] = model.plane[number[p]];
    MeanPlane& plane = plane_[number[p]];
    if (side[number[p]] < 0) plane.normal = -1 * plane.normal;
    // Smoother, by the planes around with the weights that each has for its samples; none wider, for a wide mean of
    // tangent planes lies beyond a bent surface.
    const double width = smoothing_in_sigmas * static_cast<double>(model.noise[number[p] * SampleModel::run]);
    Vec3 normal;
    double height = 0, total = 0;
    for (const std::uint32_t q : around[p]) {
      const Vec3 n = (side[number[q]] > 0 ? 1.0 : side[number[q]] < 0 ? -1.0 : 0.0) * model.plane[number[q]].normal;
      if (!(dot(n, plane.normal) > least_cosine)) continue;
      const double w = std::exp(-squared_norm(at[q] - plane.mean) / (2 * width * width));
      normal = normal + w * n;
      height += w * dot(at[q] - plane.mean, n);
      total += w;
    }
    plane.normal = (1 / norm(normal)) * normal;
    plane.mean = plane.mean + (height / total) * plane.normal;
  });
}

} // namespace eigencrust
