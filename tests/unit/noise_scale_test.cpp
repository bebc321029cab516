// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <eigencrust/stages.h>

#include "clouds.h"
#include "samples/noise_scale.h"

namespace eigencrust {
namespace {

/// A square grid in the plane z = 0 of spacing 1, folded to a right angle at x = fold.
std::vector<Vec3> grid(int side, double fold) {
  std::vector<Vec3> points;
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j) {
      const double x = i, beyond = x - fold;
      points.push_back(beyond > 0 ? Vec3{fold, static_cast<double>(j), beyond} : Vec3{x, static_cast<double>(j), 0});
    }
  return points;
}

/// Deterministic numbers of mean 0 and standard deviation 1, close enough to normal for a thickness.
double deviate(std::uint64_t& state) {
  double sum = 0;
  for (int k = 0; k < 12; ++k) {
    state = state * 6364136223846793005ull + 1442695040888963407ull;
    sum += static_cast<double>(state >> 11) / 9007199254740992.0;
  }
  return sum - 6;
}

float largest(const IndexedArray<SampleIndex, float>& scale) { return *std::max_element(scale.begin(), scale.end()); }

TEST(NoiseScale, PlanesAndCreasesAreNoNoise) {
  const Threads threads(2);
  EXPECT_LT(largest(noise_scale(prepare_samples(grid(64, 1e9), threads), {}, threads)), 1e-6);
  // A crease is as thick as its neighbourhood is wide: thickness grows, so it is no noise.
  EXPECT_LT(largest(noise_scale(prepare_samples(grid(64, 32), threads), {}, threads)), 0.05);
}

TEST(NoiseScale, MeasuresTheDeviationOfANoisyPlane) {
  const Threads threads(2);
  for (const double sigma : {0.3, 1.0, 2.0}) {
    std::vector<Vec3> points = grid(160, 1e9);
    std::uint64_t state = 5;
    for (Vec3& p : points) p.z += sigma * deviate(state);
    std::vector<float> scale = noise_scale(prepare_samples(points, threads), {}, threads).raw();
    std::nth_element(scale.begin(), scale.begin() + static_cast<std::ptrdiff_t>(scale.size() / 2), scale.end());
    EXPECT_NEAR(scale[scale.size() / 2], sigma, 0.2 * sigma) << sigma;
  }
}

TEST(NoiseScale, DoesNotDependOnTheUnitNorOnThreads) {
  std::vector<Vec3> points = grid(100, 50);
  std::uint64_t state = 9;
  for (Vec3& p : points) p = p + Vec3{0, 0, 0.5 * deviate(state)};
  std::vector<Vec3> scaled;
  for (const Vec3& p : points) scaled.push_back(1024 * p);
  const Threads one(1), three(3);
  const auto a = noise_scale(prepare_samples(points, one), {}, one).raw();
  const auto b = noise_scale(prepare_samples(points, three), {}, three).raw();
  const auto c = noise_scale(prepare_samples(scaled, one), {}, one).raw();
  EXPECT_EQ(a, b);
  for (std::size_t i = 0; i < a.size(); ++i) ASSERT_NEAR(c[i], 1024 * a[i], 1e-2 * a[i] * 1024 + 1e-3);
}

} // namespace
} // namespace eigencrust
