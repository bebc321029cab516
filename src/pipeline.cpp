// SPDX-License-Identifier: GPL-3.0-or-later
// The paper on one page. § numbers: Kolluri, Shewchuk, O'Brien, Spectral Surface Reconstruction from
// Noisy Point Clouds (SGP 2004).
#include <eigencrust/eigencrust.h>
#include <eigencrust/memory_forecast.h>

#include "crusts/crusts.h"
#include "evidence/evidence.h"
#include "invariants.h"
#include "points/point_results.h"
#include "poles/solve.h"
#include "repair/repair.h"
#include "samples/check_cloud.h"
#include "settle/settle.h"
#include "surface/surface.h"
#include "tetrahedra/scene.h"

namespace eigencrust {

void reconstruct_spectral(const PointCloud& cloud, const Context& context, Result& result) {
  // §3: S+ = the samples and the corners of a cube, T = Delaunay(S+), and the two poles of every sample
  auto scene = make_scene(cloud, context);
  EIGENCRUST_SOUND(scene, cloud);
  // §3.1: what is known beforehand, from the cube, the user and the lines of sight
  const auto evidence = gather_evidence(cloud, scene, context);
  EIGENCRUST_SOUND(evidence, scene);
  // §3.1, §3.2, §3.3: the eigenvector of the smallest eigenvalue of L x = λ D x on the pole graph G labels the poles
  const auto poles = label_poles(scene, evidence, context);
  EIGENCRUST_SOUND(poles, scene, evidence);
  // §3.4: all tetrahedra, by the least energy
  auto settled = settle(scene, evidence, poles, context);
  EIGENCRUST_SOUND(settled, scene, context.options);
  const auto overlaps = std::move(settled.overlaps);
  // §3.5: a manifold
  auto labels = repair(scene, evidence, std::move(settled), context);
  EIGENCRUST_SOUND(labels, scene, context.options);
  // §3: the faces between inside and outside
  auto surface = make_surface(cloud, scene, evidence, labels, overlaps, context);
  EIGENCRUST_SOUND(surface, scene, labels, context.options);
  // Which rows lie on it, and which way they look
  auto points = point_results(cloud, scene, surface, context);
  // What only labels ask for makes room: the rest looks at samples and surface.
  scene.stars = {};
  scene.poles = {};
  // §3.6: smoothing; the vertices get back what the input said of them
  auto mesh = finish(std::move(surface), cloud, scene, context);
  check(mesh, cloud, scene, {}, context);

  result.mesh = std::move(mesh);
  result.tetrahedralization = std::move(scene.tetrahedralization);
  result.labels = std::move(labels).labels();
  result.inlier = std::move(points.inlier);
  result.confidence = std::move(points.confidence);
  result.normals = std::move(points.normals);
}

Result reconstruct(const PointCloud& cloud, const Options& options, Observer& observer, Ranks* ranks) {
  check_options(options);
  check_cloud(cloud);
  check_memory(cloud, options.max_memory);
  Result result;
  result.report.options = options;
  Run run(result.report, observer, ranks);
  const Threads threads(options.threads, run.cancellation());
  if (options.method == Method::eigencrust)
    reconstruct_spectral(cloud, {options, run, threads}, result);
  else
    reconstruct_crust(cloud, {options, run, threads}, result);
  run.end();
  return result;
}

} // namespace eigencrust
