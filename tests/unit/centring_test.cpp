// SPDX-License-Identifier: GPL-3.0-or-later
// A noisy sphere whose boundary between inside and outside is put on the wrong place by hand.
#include <gtest/gtest.h>

#include "clouds.h"
#include "parallel/threads.h"
#include "settle/centring.h"

namespace eigencrust {
namespace {

using clouds::Points;
using clouds::Prepared;

constexpr double sigma = 0.1;   // of the noise
constexpr double settled = 0.4; // the first stage knows the side of what is farther than that from the sphere

/// n directions spread evenly, radii normal around 1 (Box and Muller 1958).
Points noisy_sphere(std::size_t n, std::uint64_t seed) {
  clouds::Random random(seed);
  Points points = clouds::sphere(n);
  for (Vec3& p : points) {
    const double size = std::sqrt(-2 * std::log(1 - random.uniform()));
    p = (1 + sigma * size * std::cos(2 * std::numbers::pi * random.uniform())) * p;
  }
  return points;
}

/// The samples stand 0.035 apart on the sphere: sigma is about three spacings.
struct NoisySphere {
  Prepared p = clouds::prepare(noisy_sphere(10000, 1));
  Labels first;
  TetrahedronLabels labels;
  std::vector<float> reach;

  /// Labels as from a second stage whose values change sign at radius `boundary`.
  explicit NoisySphere(double boundary) {
    const std::size_t n = p.t.tetrahedra.size();
    first = Labels(n, Label::unlabelled);
    clouds::HandMade made(n, 1);
    for (TetrahedronIndex i{0}; i.value < n; ++i.value) {
      const double r = radius(clouds::centroid(p.t, i));
      if (p.t.touches_cube(i) || r > 1 + settled) {
        first[i] = Label::outside;
        continue;
      }
      if (r < 1 - settled) first[i] = Label::inside;
      const double value = r < 1 - settled ? -1 : std::clamp((r - boundary) / 0.2, -1.0, 1.0);
      made.set(i, value >= 0 ? Label::outside : Label::inside, static_cast<float>(std::fabs(value)));
    }
    labels = made.done();
    reach.assign(p.t.sample_count, static_cast<float>(2.4 * sigma));
  }
  [[nodiscard]] double radius(const Vec3& place) const { return norm(place + p.t.origin); }
  std::uint64_t centre(unsigned threads = 2, std::span<const float> isolated = {}) {
    const Threads team(threads);
    return centre_in_noise(p.t, p.stars, reach, isolated, first, team, labels).relabelled;
  }
  [[nodiscard]] double mean_radius() const {
    const Surface surface = extract_surface(p.t, labels.labels(), Threads(2));
    double sum = 0;
    for (const Vec3& v : surface.mesh.vertices) sum += radius(v);
    return sum / static_cast<double>(surface.mesh.vertices.size());
  }
};

TEST(Centring, WithoutReachNothingChanges) {
  NoisySphere sphere(0.9);
  std::fill(sphere.reach.begin(), sphere.reach.end(), 0.0f);
  const TetrahedronLabels before = sphere.labels;
  EXPECT_EQ(sphere.centre(), 0u);
  EXPECT_EQ(sphere.labels.labels().raw(), before.labels().raw());
  EXPECT_EQ(sphere.labels.values().raw(), before.values().raw());
  sphere.reach.clear();
  EXPECT_EQ(sphere.centre(), 0u);
}

TEST(Centring, MovesTheBoundaryToTheMiddleOfTheSamples) {
  for (const double boundary : {0.9, 1.1}) { // from within as well as from outside
    NoisySphere sphere(boundary);
    ASSERT_GT(std::fabs(sphere.mean_radius() - 1), 0.5 * sigma);
    const Labels before = sphere.labels.labels();
    const std::uint64_t changed = sphere.centre();
    EXPECT_NEAR(sphere.mean_radius(), 1, 0.25 * sigma) << boundary;
    std::uint64_t different = 0;
    for (std::uint32_t i = 0; i < before.size(); ++i) different += before.raw()[i] != sphere.labels.labels().raw()[i];
    EXPECT_GT(changed, 0u);
    EXPECT_EQ(changed, different);
  }
}

TEST(Centring, HalfOfTheSamplesAreOnEitherSide) {
  NoisySphere sphere(0.9);
  const auto share_outside = [&] {
    // By the labels around a sample; those half and half lie on the surface and count for neither.
    double outside = 0, inside = 0;
    for (SampleIndex s{0}; s.value < sphere.p.t.sample_count; ++s.value) {
      int balance = 0;
      for (const TetrahedronIndex i : sphere.p.stars[s]) balance += sphere.labels[i] == Label::outside ? 1 : -1;
      outside += balance > 0;
      inside += balance < 0;
    }
    return outside / (outside + inside);
  };
  EXPECT_GT(share_outside(), 0.7); // 0.9 is one deviation within: 84 % of a normal distribution lie beyond
  sphere.centre();
  EXPECT_NEAR(share_outside(), 0.5, 0.08);
}

TEST(Centring, WhatTheFirstStageSettledStays) {
  NoisySphere sphere(0.9);
  // A ball of settled tetrahedra on the wrong side of the middle, where everything around it changes.
  std::uint32_t wrong = 0;
  for (TetrahedronIndex i{0}; i.value < sphere.first.size(); ++i.value) {
    const Vec3 c = clouds::centroid(sphere.p.t, i) + sphere.p.t.origin;
    if (sphere.p.t.touches_cube(i) || distance(c, {0.9, 0, 0}) > 0.1) continue;
    sphere.first[i] = Label::outside;
    clouds::put(sphere.labels, i, Label::outside, 1);
    ++wrong;
  }
  ASSERT_GT(wrong, 20u);
  const TetrahedronLabels before = sphere.labels;
  sphere.centre();
  for (TetrahedronIndex i{0}; i.value < sphere.first.size(); ++i.value) {
    if (sphere.first[i] != Label::unlabelled) {
      ASSERT_EQ(sphere.labels[i], before[i]);
      ASSERT_EQ(sphere.labels.value(i), before.value(i));
    } else {
      ASSERT_EQ(sphere.labels[i], sphere.labels.value(i) >= 0 ? Label::outside : Label::inside);
    }
  }
}

TEST(Centring, WhereThereIsNoNoiseNothingMoves) {
  NoisySphere sphere(0.9); // noise only where x > 0: far on the other side the boundary stays at 0.9
  for (std::uint32_t s = 0; s < sphere.p.t.sample_count; ++s)
    if (sphere.p.t.positions.raw()[s].x + sphere.p.t.origin.x < 0) sphere.reach[s] = 0;
  sphere.centre();
  double left = 0, right = 0, on_left = 0, on_right = 0;
  const Surface surface = extract_surface(sphere.p.t, sphere.labels.labels(), Threads(2));
  for (const Vec3& v : surface.mesh.vertices) {
    const double x = v.x + sphere.p.t.origin.x;
    if (std::fabs(x) < 0.5) continue;
    (x < 0 ? left : right) += sphere.radius(v);
    (x < 0 ? on_left : on_right) += 1;
  }
  EXPECT_NEAR(left / on_left, 0.9, 0.25 * sigma);
  EXPECT_NEAR(right / on_right, 1, 0.25 * sigma);
}

TEST(Centring, DoesNotDependOnThreads) {
  NoisySphere one(0.9), three(0.9);
  EXPECT_EQ(one.centre(1), three.centre(3));
  EXPECT_EQ(one.labels.labels().raw(), three.labels.labels().raw());
  EXPECT_EQ(one.labels.values().raw(), three.labels.values().raw());
}

} // namespace
} // namespace eigencrust
