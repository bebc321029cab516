// SPDX-License-Identifier: GPL-3.0-or-later
#include "samples/measures.h"

#include <algorithm>
#include <chrono>

#include "parallel/threads.h"

namespace eigencrust {
namespace {

std::vector<float> grid_spacing_field(const PointCloud& cloud, const Samples& samples, std::span<const float> isolated,
                                      Report& report, const Threads& threads) {
  const Options& options = report.options;
  if (options.questionable == Questionable::never) return {};
  report.grid_spacing = resolve_grid_spacing(options.grid_spacing, samples, cloud.points, cloud.scan_index, threads);
  // What is measured at the samples replaces the one ℓ of all scans, which costs detail (docs/decisions/0012).
  if (options.grid_spacing.kind != GridSpacing::Kind::automatic || !options.local_noise)
    return report.grid_spacing > 0
               ? std::vector<float>(samples.positions.size(), static_cast<float>(report.grid_spacing))
               : std::vector<float>{};
  // Four times ℓ is the length below which a tetrahedron may be noise alone (docs/decisions/0012).
  constexpr float grid_spacing_in_deviations = 1.2f;
  std::vector<float> field = std::move(noise_scale(samples, isolated, threads).raw());
  for (float& value : field) value *= grid_spacing_in_deviations;
  const bool some = std::any_of(field.begin(), field.end(), [](float value) { return value > 0; });
  return some ? field : std::vector<float>{};
}

std::vector<float> reach_of(const std::vector<float>& grid_spacing, const Options& options, double spacing) {
  if (!options.local_noise || grid_spacing.empty()) return {};
  // Twice ℓ is 2.4 σ: from the middle of the noise to where it thins out on either side.
  constexpr float reach_in_grid_spacings = 2;
  std::vector<float> reach = grid_spacing;
  // Beyond a dozen spacings there are thousands of samples to look at, and none knows better.
  const float farthest = 12 * static_cast<float>(spacing);
  for (float& r : reach) r = static_cast<double>(r) < spacing ? 0 : std::min(farthest, reach_in_grid_spacings * r);
  return reach;
}

double seconds_of(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

} // namespace

Tetrahedralization triangulate_and_measure(const PointCloud& cloud, Samples samples, Run& run, Report& report,
                                           const Threads& threads, SampleMeasures& measures) {
  const auto measure_neighbourhoods = [&](const Samples& s, const Threads& on) {
    measures.around = sample_neighbourhoods(s.positions.raw(), on);
    if (report.options.weights == Weights::evidence) measures.isolated = measures.around.isolated;
  };
  const auto measure_noise = [&](const Samples& s, const Threads& on) {
    measures.grid = grid_spacing_field(cloud, s, measures.isolated, report, on);
  };
  Tetrahedralization t;
  if (threads.size() == 1) {
    run.stage("neighbourhoods", [&] { measure_neighbourhoods(samples, threads); });
    run.stage("noise", [&] { measure_noise(samples, threads); });
    t = run.stage("delaunay", [&] { return tetrahedralize(std::move(samples), threads); });
  } else {
    double neighbourhoods = 0, noise = 0;
    t = run.stage("delaunay", [&] {
      Samples copy = samples;
      return tetrahedralize(std::move(copy), threads, [&] {
        const Threads others(threads.size() - 1);
        neighbourhoods = seconds_of([&] { measure_neighbourhoods(samples, others); });
        noise = seconds_of([&] { measure_noise(samples, others); });
      });
    });
    run.add("neighbourhoods", neighbourhoods);
    run.add("noise", noise);
  }
  report.spacing = measures.around.nearest;
  measures.reach = reach_of(measures.grid, report.options, report.spacing);
  return t;
}

} // namespace eigencrust
