// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/framing.h"

#include <gmock/gmock.h>

#include <cmath>

#include <eigencrust/error.h>
#include <eigencrust/render.h>

#include "support.h"

namespace eigencrust {
namespace {

using ::testing::HasSubstr;

/// n points on a sphere with this centre and radius, along a spiral.
std::vector<Vec3> ball(std::size_t n, const Vec3& centre = {}, double radius = 1) {
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < n; ++i) {
    const double z = 1 - 2 * (static_cast<double>(i) + 0.5) / static_cast<double>(n), r = std::sqrt(1 - z * z);
    const double angle = 2.399963229728653 * static_cast<double>(i); // the golden angle
    points.push_back(centre + radius * Vec3{r * std::cos(angle), r * std::sin(angle), z});
  }
  return points;
}

TEST(BulkOf, StraysGo) {
  std::vector<Vec3> points = ball(3000);
  for (int i = 1; i <= 60; ++i) points.push_back({5.0 * i, -3.0 * i * i, 1});
  EXPECT_EQ(bulk_of(points), ball(3000));
}

TEST(BulkOf, NothingGoesWithoutNeed) {
  const std::vector<Vec3> alone = ball(3000);
  EXPECT_EQ(bulk_of(alone), alone);
  // Strays that are hardly farther out than the object cost no size.
  std::vector<Vec3> close = alone;
  close.push_back({1.1, 0, 0});
  EXPECT_EQ(bulk_of(close), close);
  // Two objects, one a tenth as dense, are both the bulk.
  std::vector<Vec3> two = alone;
  for (const Vec3& p : ball(300, {5, 0, 0})) two.push_back(p);
  EXPECT_EQ(bulk_of(two), two);
  const std::vector<Vec3> few = {{0, 0, 0}, {1, 0, 0}, {1e9, 0, 0}};
  EXPECT_EQ(bulk_of(few), few);
  EXPECT_EQ(bulk_of(std::vector<Vec3>(100, Vec3{1, 2, 3})).size(), 100u);
}

TEST(BulkOf, ManyPointsAreJudgedByAPart) {
  std::vector<Vec3> points = ball(70000);
  for (int i = 0; i < 500; ++i) points.insert(points.begin() + 100 * i, {100, 3.0 * i, 0});
  EXPECT_EQ(bulk_of(points).size(), 70000u);
}

TEST(RenderSides, OneScaleForAll) {
  // Three units long, one high: seen from the front it is long, from the right it is short, at the same scale.
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {3, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  RenderOptions options;
  options.width = options.height = 100;
  const std::vector<Image> images = render_sides({mesh}, {seen_from("front", options), seen_from("right", options)});
  ASSERT_EQ(images.size(), 2u);
  const auto columns = [](const Image& image) {
    std::size_t n = 0;
    for (std::uint32_t x = 0; x < image.width; ++x) {
      bool drawn = false;
      for (std::uint32_t y = 0; y < image.height; ++y) drawn = drawn || image.rgb[3 * (y * image.width + x)] != 255;
      n += drawn ? 1 : 0;
    }
    return static_cast<double>(n);
  };
  EXPECT_NEAR(columns(images[0]), 92, 2);
  EXPECT_NEAR(columns(images[1]), 92.0 / 3, 2);
  EXPECT_THAT(error_of([&] { seen_from("above", options); }), HasSubstr("use front, right, back"));
}

TEST(Stacked, JoinsColumns) {
  const Image a{2, 1, {1, 2, 3, 4, 5, 6}}, b{2, 1, {7, 8, 9, 10, 11, 12}};
  const Image both = stacked({a, b});
  EXPECT_EQ(both.height, 2u);
  EXPECT_EQ(both.rgb, (std::vector<std::uint8_t>{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}));
  EXPECT_THAT(error_of([&] { stacked({a, Image{1, 1, {0, 0, 0}}}); }), HasSubstr("one width"));
}

} // namespace
} // namespace eigencrust
