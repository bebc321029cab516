// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include <eigencrust/error.h>
#include <eigencrust/metrics.h>
#include <eigencrust/validate.h>

#include "geometry/mesh_topology.h"
#include "parallel/threads.h"

namespace eigencrust {
namespace {

/// Unit normal of a triangle; zero where it has none.
Vec3 unit_normal(const TriangleMesh& mesh, std::uint32_t triangle) {
  const Vec3 n = area_vector(mesh, triangle);
  const double length = norm(n);
  return length > 0 ? (1 / length) * n : Vec3{};
}

/// Sums of n·n' over pairs of points where both surfaces have a normal.
struct NormalSums {
  double absolute = 0, oriented = 0, pairs = 0;
  NormalSums operator+(const NormalSums& o) const {
    return {absolute + o.absolute, oriented + o.oriented, pairs + o.pairs};
  }
};

/// Distances from samples of one surface to another; their normals' agreement is added to `normals`.
std::vector<double> one_way(const TriangleMesh& from, const TriangleMesh& to, const CompareOptions& options,
                            std::uint64_t seed, const Threads& threads, NormalSums& normals) {
  std::vector<std::uint32_t> triangle_of;
  const std::vector<Vec3> points = sample_surface(from, options.samples, seed, &triangle_of);
  const TriangleTree tree(to);
  std::vector<double> distances(points.size());
  const auto part = [&](std::size_t begin, std::size_t end) {
    NormalSums sum;
    for (std::size_t i = begin; i < end; ++i) {
      const TriangleTree::Nearest nearest = tree.nearest(points[i]);
      distances[i] = nearest.distance;
      const Vec3 n = unit_normal(from, triangle_of[i]), m = unit_normal(to, nearest.triangle);
      if (n == Vec3{} || m == Vec3{}) continue;
      sum = sum + NormalSums{std::fabs(dot(n, m)), dot(n, m), 1};
    }
    return sum;
  };
  normals = normals + sum_blocks<NormalSums>(threads, points.size(), part, costly_block);
  return distances;
}

double share_within(const std::vector<double>& distances, double threshold) {
  const auto within = std::count_if(distances.begin(), distances.end(), [&](double d) { return d <= threshold; });
  return static_cast<double>(within) / static_cast<double>(distances.size());
}

/// Every line then enters the mesh as often as it leaves it.
bool bounds_a_volume(const TriangleMesh& mesh, unsigned threads) {
  ValidateOptions options;
  options.self_intersections = false;
  options.threads = threads;
  const MeshSummary summary = validate(mesh, options);
  return summary.closed() && summary.oriented();
}

} // namespace

Comparison compare(const TriangleMesh& mesh, const TriangleMesh& reference, const CompareOptions& options) {
  if (options.samples == 0)
    throw Error(ErrorKind::usage, "compare", "the number of samples is 0", "ask for at least one");
  if (!(options.threshold >= 0) || !std::isfinite(options.threshold))
    throw Error(ErrorKind::usage, "compare", "the threshold is not a length", "give a positive length, or 0");
  const bool volumes = bounds_a_volume(mesh, options.threads) && bounds_a_volume(reference, options.threads);

  Comparison result;
  result.threshold = options.threshold;
  if (result.threshold == 0) {
    Box3 box;
    for (const auto& t : reference.triangles)
      for (const std::uint32_t v : t) box.add(reference.vertices[v]);
    result.threshold = 0.01 * box.diagonal();
  }
  NormalSums normals;
  {
    const Threads threads(options.threads);
    // Another seed for the way back: identical meshes shall not be compared in identical points only.
    const auto there = one_way(mesh, reference, options, options.seed, threads, normals);
    const auto back = one_way(reference, mesh, options, options.seed + 1, threads, normals);
    result.precision = share_within(there, result.threshold);
    result.recall = share_within(back, result.threshold);
    result.to_reference = summarize(there);
    result.from_reference = summarize(back);
  }
  result.hausdorff = std::max(result.to_reference.max, result.from_reference.max);
  if (result.precision + result.recall > 0)
    result.f_score = 2 * result.precision * result.recall / (result.precision + result.recall);
  if (normals.pairs > 0) {
    result.normal_consistency = normals.absolute / normals.pairs;
    result.oriented_normal_consistency = normals.oriented / normals.pairs;
  }
  if (volumes) result.volume_iou = volume_iou(mesh, reference, 512, options.threads);
  return result;
}

} // namespace eigencrust
