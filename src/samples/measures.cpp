// SPDX-License-Identifier: GPL-3.0-or-later
#include "samples/measures.h"

#include <algorithm>
#include <optional>

namespace eigencrust {
namespace {

// Four times ℓ is the length below which a tetrahedron may be noise alone (docs/decisions/0024).
constexpr float grid_spacing_in_deviations = 1.2f;

/// The noise that the options give; none: it is to be measured.
std::optional<double> given_noise(const Options& options, double diagonal) {
  if (const auto noise = options.noise.given(diagonal)) return noise;
  const auto grid = options.grid_spacing.given(diagonal);
  return grid ? std::optional(*grid / static_cast<double>(grid_spacing_in_deviations)) : std::nullopt;
}

} // namespace

std::vector<std::uint8_t> SampleMeasures::noisy() const {
  // Were it 0.2, most walls with gaps would be torn (docs/decisions/0025).
  constexpr float noisy_in_spacings = 0.125f;
  if (trusts_all) return {};
  std::vector<std::uint8_t> noisy(model.noise.size());
  for (SampleIndex s{0}; s.value < noisy.size(); ++s.value)
    noisy[s.value] = model.noise[s] > noisy_in_spacings * model.spacing[s];
  return noisy;
}

SampleLengths reach_for_poles(const SampleMeasures& measures) {
  // Twice ℓ: from the middle of the noise to where it thins out on either side. Beyond a dozen spacings there are
  // thousands of samples to look at, and none knows better.
  constexpr float farthest_in_spacings = 12;
  const SampleModel& model = measures.model;
  if (measures.trusts_all || measures.grid.empty()) return {};
  SampleLengths reach(model.noise.size());
  for (SampleIndex s{0}; s.value < reach.size(); ++s.value)
    if (measures.grid[s] >= model.spacing[s])
      reach[s] = std::min(farthest_in_spacings * model.spacing[s], 2 * measures.grid[s]);
  return reach;
}

SampleMeasures measure(const PointCloud& cloud, Samples& samples, const Options& options, const Threads& threads) {
  SampleMeasures measures;
  const bool paper = options.weights == Weights::paper;
  measures.trusts_all = paper;
  const std::optional<double> noise = paper ? 0 : given_noise(options, samples.bounds.diagonal());
  const bool may_move = options.surface == SurfaceKind::automatic || options.surface == SurfaceKind::fitted;
  measures.model = may_move && !paper ? eased_sample_model(samples, noise, threads)
                                      : sample_model(samples.positions.raw(), noise, threads);
  const SampleModel& model = measures.model;
  if (options.questionable != Questionable::never)
    measures.scan_grid_spacing =
        resolve_grid_spacing(options.grid_spacing, samples, cloud.points, cloud.scan_index, threads);
  if (paper) {
    if (measures.scan_grid_spacing > 0)
      measures.grid = SampleLengths(samples.positions.size(), static_cast<float>(measures.scan_grid_spacing));
    return measures;
  }
  if (std::none_of(model.noise.begin(), model.noise.end(), [](float sigma) { return sigma > 0; })) return measures;
  measures.grid = model.noise;
  for (float& length : measures.grid.raw()) length *= grid_spacing_in_deviations;
  return measures;
}

} // namespace eigencrust
