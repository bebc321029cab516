// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/deviation.h"

#include <algorithm>
#include <numeric>

#include "geometry/mesh_topology.h"

namespace eigencrust {
namespace {

// Points on the coarse mesh: as many as the full one has vertices, within these.
constexpr std::size_t least_points = 20'000, most_points = 200'000;
constexpr std::uint64_t seed = 1;

/// Sums in blocks, so that they do not depend on threads.
struct Sums {
  double weight = 0, weighted = 0, max = 0;
  Sums operator+(const Sums& o) const { return {weight + o.weight, weighted + o.weighted, std::max(max, o.max)}; }
  void add(double d, double w) {
    weight += w;
    weighted += w * d;
    max = std::max(max, d);
  }
  [[nodiscard]] DistanceReport report() const { return {weight > 0 ? weighted / weight : 0, max}; }
};

} // namespace

FullSurface::FullSurface(const TriangleMesh& mesh, const Threads& threads)
    : mesh_(mesh), tree_(mesh, threads.size()), area_(mesh.vertices.size(), 0) {
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const double area = norm(area_vector(mesh, t)) / 2;
    for (const std::uint32_t v : mesh.triangles[t]) area_[v] += area;
  }
}

DeviationReport FullSurface::measure(const TriangleMesh& mesh, const Threads& threads) const {
  return measure(mesh, 0, {}, nullptr, threads);
}

DeviationReport FullSurface::measure(const TriangleMesh& mesh, double most, std::span<const std::uint32_t> into,
                                     std::vector<std::uint8_t>& beyond, const Threads& threads) const {
  return measure(mesh, most, into, &beyond, threads);
}

DeviationReport FullSurface::measure(const TriangleMesh& mesh, double most, std::span<const std::uint32_t> into,
                                     std::vector<std::uint8_t>* beyond, const Threads& threads) const {
  const TriangleTree coarse(mesh, threads.size());
  // Triangles of the coarse mesh next to what is too far off, by vertex of the full one and by point.
  std::vector<std::uint32_t> near_far(beyond ? mesh_.vertices.size() : 0, no_index), at_far;
  const Sums from_full = sum_blocks<Sums>(
      threads, mesh_.vertices.size(),
      [&](std::size_t begin, std::size_t end) {
        Sums sums;
        for (std::size_t v = begin; v < end; ++v) {
          const TriangleTree::Nearest nearest = coarse.nearest(mesh_.vertices[v]);
          sums.add(nearest.distance, area_[v]);
          if (beyond && nearest.distance > most) near_far[v] = nearest.triangle;
        }
        return sums;
      },
      costly_block);
  std::vector<std::uint32_t> triangle_of;
  const std::size_t count = std::clamp(mesh_.vertices.size(), least_points, most_points);
  std::vector<Vec3> points = sample_surface(mesh, count, seed, &triangle_of);
  points.insert(points.end(), mesh.vertices.begin(), mesh.vertices.end()); // they weigh nothing
  triangle_of.resize(points.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (const std::uint32_t v : mesh.triangles[t]) triangle_of[count + v] = t;
  at_far.assign(beyond ? points.size() : 0, no_index);
  const Sums to_full = sum_blocks<Sums>(
      threads, points.size(),
      [&](std::size_t begin, std::size_t end) {
        Sums sums;
        for (std::size_t i = begin; i < end; ++i) {
          const double distance = tree_.nearest(points[i]).distance;
          sums.add(distance, i < count ? 1 : 0);
          if (beyond && distance > most) at_far[i] = triangle_of[i];
        }
        return sums;
      },
      costly_block);
  if (beyond) {
    const auto mark = [&](std::uint32_t t) {
      for (const std::uint32_t v : mesh.triangles[t]) (*beyond)[v] = 1;
    };
    beyond->assign(mesh.vertices.size(), 0);
    for (const std::uint32_t t : at_far)
      if (t != no_index) mark(t);
    for (std::size_t v = 0; v < near_far.size(); ++v) {
      if (near_far[v] == no_index) continue;
      mark(near_far[v]);
      (*beyond)[into[v]] = 1;
    }
  }
  return {to_full.report(), from_full.report()};
}

} // namespace eigencrust
