// SPDX-License-Identifier: GPL-3.0-or-later
// Noisy samples that move towards one another before they are triangulated.
#include "samples/easing.h"

#include <eigencrust/eigencrust.h>
#include <eigencrust/metrics.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "clouds.h"
#include "geometry/exact_difference.h"
#include "noisy.h"
#include "numerics/quantile.h"

namespace eigencrust {
namespace {

using clouds::fence;
using clouds::noisy;
using clouds::Points;

struct Eased {
  Samples samples;
  Points before;
  SampleModel model;
  explicit Eased(const Points& points, std::optional<double> noise = std::nullopt, unsigned threads = 2)
      : samples(prepare_samples(points, Threads(threads))),
        before(samples.positions.raw()),
        model(eased_sample_model(samples, noise, Threads(threads))) {}
};

TEST(Easing, ThinBarsInNoiseAreNeitherFilledNorCut) {
  // Without it the bars are taken for noise: one lump with half of the volume more.
  for (const std::uint64_t seed : {1u, 2u}) {
    const Result result = reconstruct(clouds::cloud_of(noisy(fence(), 0.4, seed)));
    const MeshSummary m = validate(result.mesh);
    EXPECT_EQ(m.components, 1) << seed;
    EXPECT_EQ(m.genus, 7) << seed;
    EXPECT_EQ(m.self_intersections, 0) << seed;
    EXPECT_NEAR(m.volume / clouds::volume_of_fence, 1, 0.06) << seed;
  }
}

TEST(Easing, SaysHowNoisyTheSamplesCame) {
  const Eased o(noisy(fence(), 0.4, 5));
  EXPECT_GT(2 * o.model.eased, o.before.size());
  std::vector<float> left = o.model.noise.raw(), input = o.model.input_noise.raw();
  EXPECT_LT(median(left), 0.3);
  EXPECT_NEAR(median(input), 0.4, 0.15); // 1.2 without: half of a bar
  for (std::size_t i = 0; i < left.size(); ++i) ASSERT_LE(o.model.noise.raw()[i], o.model.input_noise.raw()[i]);
}

TEST(Easing, PlacesAreFloatsExactAndDistinct) {
  Points points = noisy(fence(), 0.4, 6);
  for (Vec3& p : points) p = {static_cast<float>(100 + p.x), static_cast<float>(p.y - 70), static_cast<float>(p.z)};
  const Eased o(points);
  ASSERT_GT(o.model.eased, 0);
  Points places = o.samples.positions.raw();
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Vec3 in_input = places[i] + o.samples.origin;
    EXPECT_TRUE(is_exact_difference(in_input, o.samples.origin));
    for (const double c : {in_input.x, in_input.y, in_input.z})
      EXPECT_EQ(c, static_cast<double>(static_cast<float>(c)));
    EXPECT_LE(distance(places[i], o.before[i]), 3 * 1.5); // spacings of noise, as it was read
  }
  std::sort(places.begin(), places.end());
  EXPECT_EQ(std::adjacent_find(places.begin(), places.end()), places.end());
}

TEST(Easing, SamplesThatMeetGoBack) {
  const Points before{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}};
  // The first two meet; the third is where the second came from, and the fourth where the third did.
  Points after{{0.5, 0, 0}, {0.5, 0, 0}, {1, 0, 0}, {2, 0, 0}, {4.5, 0, 0}};
  keep_distinct(before, after, Threads(2));
  EXPECT_EQ(after, (Points{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4.5, 0, 0}}));
}

TEST(Easing, WhereItLeavesMuchNoiseSamplesStay) {
  const std::size_t n = 20000;
  EXPECT_LT(Eased(noisy(clouds::sphere(n), 3 * std::sqrt(12.5 / n), 2)).model.eased, n / 100);
}

TEST(Easing, FlatFacesStayInNoiseOfASpacing) {
  clouds::Random random(4);
  Points cube; // a sample for each unit of area
  for (const auto& [u, v] : {std::pair{Vec3{100, 0, 0}, Vec3{0, 100, 0}},
                             {Vec3{0, 100, 0}, Vec3{0, 0, 100}},
                             {Vec3{0, 0, 100}, Vec3{100, 0, 0}}})
    for (const Vec3& corner : {Vec3{}, Vec3{100, 100, 100} - u - v}) clouds::cover(corner, u, v, random, cube);
  EXPECT_LT(Eased(noisy(cube, 1, 2)).model.eased, cube.size() / 10); // nearly all where 30 neighbours are asked
}

TEST(Easing, WithoutNoiseAllStay) {
  for (const Points& points : {clouds::sphere(8000), clouds::cube_surface(20), clouds::torus(3, 1, 120, 40), fence()}) {
    const Eased o(points);
    EXPECT_EQ(o.model.eased, 0);
    EXPECT_EQ(o.samples.positions.raw(), o.before);
    EXPECT_EQ(o.model.noise.raw(), o.model.input_noise.raw());
  }
}

TEST(Easing, TheTwoSidesOfACleanWallStayApart) {
  Points lens = clouds::sphere(30000); // two spacings thick and less
  for (Vec3& p : lens) p.z *= 0.02;
  EXPECT_LT(Eased(lens).model.eased, lens.size() / 50);
}

TEST(Easing, WhereAllIsClearTheNoiseIsAsMeasured) {
  Points ball = noisy(clouds::sphere(20000), 0.3 * std::sqrt(12.5 / 20000), 8);
  for (Vec3& p : ball) p = 40 * p + Vec3{200, 0, 0};
  const Eased o(clouds::joined(noisy(fence(), 0.4, 8), ball));
  const SampleModel before = sample_model(o.before, std::nullopt, Threads(2));
  EXPECT_GT(o.model.eased, 5000);
  for (std::size_t i = 0; i < o.before.size(); ++i) {
    if ((o.before[i] + o.samples.origin).x < 150) continue; // of the fence
    ASSERT_EQ(o.samples.positions.raw()[i], o.before[i]);
    ASSERT_EQ(o.model.noise.raw()[i], before.noise.raw()[i]);
    ASSERT_EQ(o.model.input_noise.raw()[i], before.noise.raw()[i]);
  }
}

TEST(Easing, NoiseThatIsGivenCounts) {
  const Points points = noisy(fence(), 0.4, 5);
  EXPECT_EQ(Eased(points, 0.0).model.eased, 0);
  const Eased o(points, 0.4);
  EXPECT_GT(o.model.eased, 0);
  EXPECT_LT(*std::max_element(o.model.input_noise.begin(), o.model.input_noise.end()), 0.41);
}

TEST(Easing, TheSurfaceOfSamplesIsThatOfTheInput) {
  const Points points = noisy(fence(), 0.4, 1);
  Options options;
  options.surface = SurfaceKind::samples;
  const Result result = reconstruct(clouds::cloud_of(points), options);
  const Attribute& source = *find_attribute(result.mesh.vertex_attributes, "source_index");
  for (std::size_t v = 0; v < result.mesh.vertices.size(); ++v)
    ASSERT_EQ(result.mesh.vertices[v], points[static_cast<std::size_t>(attribute_value(source, v))]);
}

TEST(Easing, AnyNumberOfThreadsGivesTheSame) {
  const Points points = noisy(fence(), 0.4, 9);
  const Eased one(points, std::nullopt, 1), three(points, std::nullopt, 3);
  EXPECT_EQ(one.samples.positions.raw(), three.samples.positions.raw());
  EXPECT_EQ(one.model.noise.raw(), three.model.noise.raw());
  EXPECT_EQ(one.model.input_noise.raw(), three.model.input_noise.raw());
}

} // namespace
} // namespace eigencrust
