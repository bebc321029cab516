// SPDX-License-Identifier: GPL-3.0-or-later
#include "samples/sample_model.h"

#include <gmock/gmock.h>
#include <algorithm>

#include "clouds.h"
#include "geometry/nearest.h"
#include "samples/place_model.h"
#include "samples/two_sheets.h"

namespace eigencrust {
namespace {

using clouds::Points;

/// In the order of the curve, as the stages see them; `of_row` leads back.
struct Ordered {
  Samples samples;
  SampleModel model;
  explicit Ordered(const Points& points, std::optional<double> noise = std::nullopt, unsigned threads = 2)
      : samples(prepare_samples(points, Threads(threads))),
        model(sample_model(samples.positions.raw(), noise, Threads(threads))) {}
  [[nodiscard]] std::uint32_t at(std::size_t row) const { return samples.of_row[row].value; }
};

float middle(std::vector<float> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

/// Sum of twelve: close enough to Gaussian, deviation 1.
double deviate(clouds::Random& random) {
  double sum = -6;
  for (int k = 0; k < 12; ++k) sum += random.uniform();
  return sum;
}

Points grid(unsigned n, double step = 1) { return clouds::lattice(n, n, 1, step); }

Points noisy_sphere(std::size_t n, double sigma, std::uint64_t seed) {
  clouds::Random random(seed);
  Points points = clouds::sphere(n);
  for (Vec3& p : points) p = p + sigma * Vec3{deviate(random), deviate(random), deviate(random)};
  return points;
}

TEST(SampleModel, SpacingIsTheStepOfAGrid) {
  for (const double step : {1.0, 1e-3, 1e4}) {
    EXPECT_NEAR(Ordered(grid(60, step)).model.typical_spacing / step, 1, 0.05);
  }
}

TEST(SampleModel, ClosePairsDoNotFoolTheSpacing) {
  // The nearest neighbour is a hundredth of a step away; each pair stands for one place.
  Points pairs = grid(60);
  for (const Vec3& p : grid(60)) pairs.push_back(p + Vec3{0.01, 0.005, 0});
  const double spacing = Ordered(pairs).model.typical_spacing;
  EXPECT_GT(spacing, 0.6); // √½ of the step
  EXPECT_LT(spacing, 1);
}

TEST(SampleModel, MeasuresTheNoiseOfASurface) {
  const std::size_t n = 40000;
  const double spacing = std::sqrt(4 * std::numbers::pi / static_cast<double>(n));
  for (const std::uint64_t seed : {1u, 2u, 3u})
    for (const double sigma : {0.5 * spacing, spacing, 3 * spacing}) {
      const float measured = middle(Ordered(noisy_sphere(n, sigma, seed)).model.noise.raw());
      EXPECT_NEAR(static_cast<double>(measured) / sigma, 1, 0.3) << sigma / spacing << " spacings, seed " << seed;
    }
}

TEST(SampleModel, SmoothAndSharpSurfacesAreFreeOfNoise) {
  for (const Points& points : {clouds::sphere(20000), clouds::cube_surface(40), clouds::torus(3, 1, 200, 70)}) {
    const Ordered o(points);
    EXPECT_LT(middle(o.model.noise.raw()), 0.05 * o.model.typical_spacing);
    EXPECT_THAT(o.model.plane, testing::IsEmpty());
  }
}

TEST(SampleModel, TwoSidesOfAWallAreNoNoise) {
  // 1.5 steps apart, on grids that are shifted against each other, with a little noise.
  clouds::Random random(5);
  Points wall = grid(80);
  for (const Vec3& p : grid(80)) wall.push_back(p + Vec3{0.3, 0.4, 1.5});
  for (Vec3& p : wall) p.z += 0.05 * deviate(random);
  EXPECT_LT(middle(Ordered(wall).model.noise.raw()), 0.2); // half the gap would be 0.75
}

TEST(SampleModel, ThinRodsAreNoNoise) {
  // A frame of square rods 3 steps thick: from afar it is as thick as a layer of noise.
  Points frame;
  for (int rod = 0; rod < 8; ++rod)
    for (int along = 0; along < 120; ++along)
      for (int a = 0; a <= 3; ++a)
        for (int b = 0; b <= 3; ++b) {
          if (a > 0 && a < 3 && b > 0 && b < 3) continue;
          const double across = 15.0 * rod + a;
          frame.push_back({static_cast<double>(along), across, static_cast<double>(b)});
        }
  const Ordered o(frame);
  EXPECT_LT(middle(o.model.noise.raw()), 0.5); // half the thickness would be 1.5
  EXPECT_THAT(o.model.plane, testing::IsEmpty());
}

TEST(SampleModel, WallsOfHolesAreNoNoise) {
  // Wide neighbourhoods see two sheets, and the walls of the windows between them.
  for (const double thickness : {5.25, 5.5, 5.75, 6.0}) {
    clouds::Random random(3);
    Points plate = clouds::plate_with_windows(6, 4, thickness, 1);
    for (Vec3& p : plate) p = p + 0.3 * Vec3{deviate(random), deviate(random), deviate(random)};
    EXPECT_NEAR(static_cast<double>(middle(Ordered(plate).model.noise.raw())), 0.3, 0.15) << thickness; // 0.8 with them
  }
}

TEST(SampleModel, PartsSideBySideAreNoNoise) {
  // A body with two legs, five deviations thick and side by side: together they are flat.
  constexpr double sigma = 1;
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    clouds::Random random(seed);
    Points points;
    for (const Vec3& p : clouds::sphere(57000)) points.push_back(84.0 * p);
    const std::size_t body = points.size();
    for (const double x : {-13.0, 13.0})
      for (int k = 0; k < 1350; ++k) {
        const double angle = 2 * std::numbers::pi * random.uniform();
        points.push_back({x + 5 * std::cos(angle), 5 * std::sin(angle), -80 - 68 * random.uniform()});
      }
    for (Vec3& p : points) p = p + sigma * Vec3{deviate(random), deviate(random), deviate(random)};
    const Ordered o(points);
    float most = 0;
    for (std::size_t row = body; row < points.size(); ++row)
      most = std::max(most, o.model.noise[SampleIndex{o.at(row)}]);
    EXPECT_LT(most, 1.5 * sigma) << "seed " << seed;
  }
}

TEST(SampleModel, OneBodyDoesNotDecideForAnother) {
  // A clean sphere beside a noisy one of three times as many samples.
  const Points clean = clouds::sphere(10000), noisy = noisy_sphere(30000, 0.06, 7);
  const Ordered o(clouds::joined(clean, clouds::moved(noisy, {4, 0, 0})));
  std::vector<float> of_clean, of_noisy;
  for (std::size_t row = 0; row < clean.size(); ++row) of_clean.push_back(o.model.noise[SampleIndex{o.at(row)}]);
  for (std::size_t row = 0; row < noisy.size(); ++row)
    of_noisy.push_back(o.model.noise[SampleIndex{o.at(clean.size() + row)}]);
  EXPECT_LT(middle(of_clean), 0.003);
  EXPECT_NEAR(middle(of_noisy), 0.06, 0.015);
}

TEST(SampleModel, OutliersAreIsolatedAndSparsePartsAreNot) {
  // Dense and sparse halves side by side, and outliers between far and near.
  Points points = grid(100, 0.2);
  for (const Vec3& p : grid(30)) points.push_back(p + Vec3{40, 0, 0});
  const std::size_t surface = points.size();
  clouds::Random random(3);
  for (int i = 0; i < 60; ++i) points.push_back({random.uniform(0, 70), random.uniform(0, 30), random.uniform(4, 30)});
  const Ordered o(points);
  std::size_t wrong = 0, found = 0;
  for (std::size_t row = 0; row < points.size(); ++row)
    (row < surface ? wrong : found) += o.model.isolated[SampleIndex{o.at(row)}] > 0;
  EXPECT_EQ(wrong, 0u);
  EXPECT_GE(found, 54u);
}

TEST(PlaceModels, PlacesOfFarOutliersAreNotFlat) {
  // Their neighbourhoods reach the sheet, clean or noisy; as flat places they would be one another's level.
  for (const double sigma : {0.0, 0.5, 2.0}) {
    clouds::Random random(8);
    Points points = grid(200);
    for (Vec3& p : points) p.z += sigma * deviate(random);
    const std::size_t surface = points.size();
    for (int i = 0; i < 100; ++i)
      points.push_back({random.uniform(0, 200), random.uniform(0, 200), random.uniform(15, 100)});
    const PlaceModels models(points, Threads(2));
    std::size_t flat_outliers = 0, flat_places = 0;
    for (std::size_t row = surface; row < points.size(); ++row) flat_outliers += models.at(points[row]).is_flat;
    for (std::size_t row = 0; row < surface; row += 400) flat_places += models.at(points[row]).is_flat;
    EXPECT_LE(flat_outliers, 10u) << sigma;
    EXPECT_GE(flat_places, 90u) << sigma;
  }
}

TEST(PlaceModels, TiltedExactPlanesAreFlatEverywhere) {
  // Their thickness is nothing but rounding.
  for (const Vec3& shift : {Vec3{}, Vec3{1e6, 2e6, 3e5}}) {
    Points points;
    for (const Vec3& p : grid(60)) points.push_back(p.x * Vec3{0.6, 0.48, 0.64} + p.y * Vec3{-0.8, 0.36, 0.48} + shift);
    const PlaceModels models(points, Threads(2));
    EXPECT_TRUE(std::all_of(points.begin(), points.end(), [&](const Vec3& p) { return models.at(p).is_flat; }));
  }
}

TEST(SampleModel, AGivenNoiseIsTakenEverywhere) {
  const Ordered o(clouds::sphere(3000), 0.2);
  EXPECT_THAT(o.model.noise.raw(), testing::Each(0.2f));
  EXPECT_FALSE(o.model.plane.empty());
}

TEST(SampleModel, PointsThatFillAVolumeAreFlatNowhere) {
  EXPECT_LT(Ordered(clouds::random_box(8000, 4)).model.sheet_share, 0.02);
  EXPECT_GT(Ordered(clouds::sphere(8000)).model.sheet_share, 0.9);
}

TEST(SampleModel, PlatesAFewSpacingsApartAreSheets) {
  Points plates;
  clouds::Random random(7);
  for (const double height : {0.0, 2.4, 4.6, 7.1, 9.5, 11.8})
    for (unsigned i = 0; i < 40; ++i)
      for (unsigned j = 0; j < 40; ++j)
        plates.push_back({i + 0.6 * random.uniform(), j + 0.6 * random.uniform(), height});
  EXPECT_GT(Ordered(plates).model.sheet_share, 0.1);
}

TEST(SampleModel, AnyNumberOfThreadsGivesTheSame) {
  const Points points = noisy_sphere(20000, 0.03, 9);
  const Ordered one(points, std::nullopt, 1), three(points, std::nullopt, 3);
  EXPECT_EQ(one.model.spacing.raw(), three.model.spacing.raw());
  EXPECT_EQ(one.model.noise.raw(), three.model.noise.raw());
  EXPECT_EQ(one.model.isolated.raw(), three.model.isolated.raw());
  ASSERT_EQ(one.model.plane.size(), three.model.plane.size());
  for (std::size_t r = 0; r < one.model.plane.size(); ++r) {
    EXPECT_EQ(one.model.plane[r].mean, three.model.plane[r].mean);
    EXPECT_EQ(one.model.plane[r].normal, three.model.plane[r].normal);
  }
}

TEST(SampleModel, MeanPlanesLieInTheMiddleOfTheNoise) {
  const double sigma = 0.05;
  const Ordered o(noisy_sphere(20000, sigma, 11));
  ASSERT_FALSE(o.model.plane.empty());
  double off = 0, tilt = 0;
  std::size_t planes = 0;
  for (const MeanPlane& plane : o.model.plane) {
    if (squared_norm(plane.normal) == 0) continue;
    const Vec3 at = plane.mean + o.samples.origin;
    off += std::fabs(norm(at) - 1);
    tilt += std::fabs(dot((1 / norm(at)) * at, plane.normal));
    ++planes;
  }
  ASSERT_GT(planes, o.model.plane.size() / 2);
  EXPECT_LT(off / static_cast<double>(planes), 0.4 * sigma);
  EXPECT_GT(tilt / static_cast<double>(planes), 0.97);
}

std::optional<TwoSheets> sheets(const Points& points) {
  std::vector<std::uint32_t> all(points.size());
  std::iota(all.begin(), all.end(), 0u);
  return two_sheets(points, all, local_frame(points, all, points[0]));
}

TEST(TwoSheets, AreToldFromNoiseAndFromCurvature) {
  clouds::Random random(13);
  Points noise, two, bent;
  for (int i = 0; i < 90; ++i) {
    const double x = random.uniform(-4, 4), y = random.uniform(-4, 4), z = 0.1 * deviate(random);
    const double side = i % 2 == 0 ? 0.75 : -0.75;
    noise.push_back({x, y, 5 * z});
    two.push_back({x, y, z + side});
    bent.push_back({x, y, z + side + 0.04 * (x * x + y * y)}); // both sheets bend alike
  }
  EXPECT_FALSE(sheets(noise).has_value());
  ASSERT_TRUE(sheets(two).has_value());
  EXPECT_NEAR(sheets(two)->deviation, 0.1, 0.03);
  EXPECT_NEAR(sheets(two)->gap, 1.5, 0.1);
  ASSERT_TRUE(sheets(bent).has_value());
  EXPECT_NEAR(sheets(bent)->deviation, 0.1, 0.03);
}

TEST(TwoSheets, AFewStrayPointsAreNone) {
  Points plane = grid(9);
  plane.push_back({4, 4, 2});
  EXPECT_FALSE(sheets(plane).has_value());
}

} // namespace
} // namespace eigencrust
