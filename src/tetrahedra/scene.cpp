// SPDX-License-Identifier: GPL-3.0-or-later
#include "tetrahedra/scene.h"

#include <eigencrust/memory_forecast.h>

#include <thread>

#include "report/snapshots.h"

namespace eigencrust {
namespace {

/// Ends the triangulation when the run is cancelled, or when what grows would take more memory than is allowed. The
/// observer hears of progress from the caller's thread alone.
WatchGrowth watch_of(const PointCloud& cloud, const Context& context) {
  return [cancelled = context.run.cancellation(), checkpoint = context.run.checkpoint(),
          caller = std::this_thread::get_id(), limit = context.options.max_memory,
          further = further_bytes(cloud)](double fraction, std::uint64_t tetrahedra) {
    if (std::this_thread::get_id() == caller)
      checkpoint(fraction);
    else
      cancelled();
    check_memory_of_tetrahedra(tetrahedra, further, limit);
  };
}

} // namespace

Scene make_scene(const PointCloud& cloud, const Context& context) {
  const auto& [options, run, threads] = context;
  Scene scene;
  Samples samples = run.stage("samples", [&] { return prepare_samples(cloud.points, threads); });
  scene.sample_of_row = std::move(samples.of_row);
  scene.measures = run.stage("sample_model", [&] { return measure(cloud, samples, options, threads); });
  scene.tetrahedralization = run.stage("delaunay", [&] {
    const WatchGrowth watch = watch_of(cloud, context);
    return run.ranks() != nullptr ? run.ranks()->tetrahedralize(std::move(samples), threads, watch, options.max_memory)
                                  : tetrahedralize(std::move(samples), threads, watch);
  });
  if (run.ranks() != nullptr)
    for (const auto& [what, value] : run.ranks()->counts()) run.count(what, value);
  const Tetrahedralization& t = scene.tetrahedralization;
  run.product("samples", [&] { return snapshot_of_samples(t, scene.measures.model); });
  scene.stars = run.stage("stars", [&] { return vertex_stars(t, threads); });
  scene.poles = run.stage(
      "poles", [&] { return find_poles(t, scene.stars, reach_for_poles(scene.measures), options.weights, threads); });
  return scene;
}

SamplePlaces::SamplePlaces(const Scene& scene, const PointCloud& cloud, const Threads& threads) {
  const Tetrahedralization& t = scene.tetrahedralization;
  all_ = std::span(t.positions.raw()).first(t.sample_count);
  if (scene.measures.model.eased == 0) return;
  own_.resize(t.sample_count);
  for_each_index(threads, own_.size(), [&](std::size_t s) { own_[s] = cloud.points[t.source.raw()[s]] - t.origin; });
  all_ = own_;
}

} // namespace eigencrust
