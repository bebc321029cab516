// SPDX-License-Identifier: GPL-3.0-or-later
#include "repair/reach_of_noise.h"

#include <algorithm>
#include <numbers>

namespace eigencrust {
namespace {

// Noise makes tunnels and bridges as wide as this at most, in deviations.
constexpr double noise_reach = 16;
// In spacings. Samples show a tunnel where they stand at half of its radius (Amenta and Bern's r = 1/2), 4π around it:
// a narrower one may be a gap between them. A wider one is meant.
constexpr double sampling_reach = 2;
constexpr double tetrahedra_per_worth = 8;

} // namespace

double reach_of_noise(const SampleModel& model, std::span<const std::uint32_t> samples) {
  double noise = 0, spacing = 0;
  for (const std::uint32_t s : samples) {
    noise += static_cast<double>(model.input_noise[SampleIndex{s}]);
    spacing += static_cast<double>(model.spacing[SampleIndex{s}]);
  }
  return std::clamp(noise_reach * noise / spacing, sampling_reach, widest_reach);
}

double worth_of_reach(double reach) { return 2 * std::numbers::pi * reach * reach; }

std::uint64_t most_tetrahedra(double worth) { return static_cast<std::uint64_t>(tetrahedra_per_worth * worth); }

} // namespace eigencrust
