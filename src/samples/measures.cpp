// SPDX-License-Identifier: GPL-3.0-or-later
#include "samples/measures.h"
#include "samples/noise_scale.h"

#include <algorithm>

namespace eigencrust {
namespace {

std::vector<float> grid_spacing_field(const Samples& samples, const Options& options, const Threads& threads,
                                      const SampleMeasures& measures) {
  // What is measured at the samples replaces the one ℓ of all scans, which costs detail (docs/decisions/0012).
  if (options.grid_spacing.kind != GridSpacing::Kind::automatic || !options.local_noise)
    return measures.scan_grid_spacing > 0
               ? std::vector<float>(samples.positions.size(), static_cast<float>(measures.scan_grid_spacing))
               : std::vector<float>{};
  // Four times ℓ is the length below which a tetrahedron may be noise alone (docs/decisions/0012).
  constexpr float grid_spacing_in_deviations = 1.2f;
  std::vector<float> field = std::move(noise_scale(samples, measures.isolated, threads).raw());
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

} // namespace

void measure_neighbourhoods(const Samples& samples, const Options& options, const Threads& threads,
                            SampleMeasures& measures) {
  measures.around = sample_neighbourhoods(samples.positions.raw(), threads);
  if (options.weights == Weights::evidence) measures.isolated = measures.around.isolated;
}

void measure_noise(const PointCloud& cloud, const Samples& samples, const Options& options, const Threads& threads,
                   SampleMeasures& measures) {
  if (options.questionable == Questionable::never) return;
  measures.scan_grid_spacing =
      resolve_grid_spacing(options.grid_spacing, samples, cloud.points, cloud.scan_index, threads);
  measures.grid = grid_spacing_field(samples, options, threads, measures);
  measures.reach = reach_of(measures.grid, options, measures.around.nearest);
}

} // namespace eigencrust
