// SPDX-License-Identifier: GPL-3.0-or-later
#include "points/point_results.h"

#include <limits>

#include "fit/fit.h"
#include "points/orient.h"

namespace eigencrust {
namespace {

PointResults results_by_row(const PointCloud& cloud, const Scene& scene, const Surface& surface,
                            const Threads& threads) {
  const Tetrahedralization& t = scene.tetrahedralization;
  const SampleModel& model = scene.measures.model;
  Classification classes = classify_samples(t, surface, model, threads);
  const SurfaceFans fans(surface.mesh);
  const std::vector<float> noise = noise_to_fit(surface, fans, model, SurfaceKind::automatic, threads);
  IndexedArray<SampleIndex, Vec3> normals;
  if (noise.empty()) {
    normals = orient_samples(t, surface, classes, scene.measures.grid, threads);
  } else {
    Surface fitted = surface;
    const SamplePlaces samples(scene, cloud, threads);
    fitted.mesh.vertices = fitted_vertices(surface, fans, samples.all(), model, noise, threads);
    classify_by_distance(samples.all(), fitted, model, noise, classes, threads);
    normals = orient_samples(t, fitted, classes, {}, threads); // it needs no smoothing
  }
  const std::vector<SampleIndex>& sample = scene.sample_of_row;
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  PointResults result;
  result.inlier.assign(sample.size(), 0);
  result.confidence.assign(sample.size(), 0);
  result.normals.assign(sample.size(), {nan, nan, nan});
  for_each_index(threads, sample.size(), [&](std::size_t row) {
    if (!sample[row].valid()) return;
    result.inlier[row] = classes.inlier[sample[row]];
    result.confidence[row] = classes.confidence[sample[row]];
    result.normals[row] = normals[sample[row]];
  });
  return result;
}

} // namespace

PointResults point_results(const PointCloud& cloud, const Scene& scene, const Surface& surface,
                           const Context& context) {
  if (!context.options.point_results) return {};
  return context.run.stage("points", [&] { return results_by_row(cloud, scene, surface, context.threads); });
}

} // namespace eigencrust
