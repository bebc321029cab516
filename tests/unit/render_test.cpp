// SPDX-License-Identifier: GPL-3.0-or-later
#include <eigencrust/error.h>
#include <eigencrust/io.h>
#include <eigencrust/render.h>
#include <gmock/gmock.h>
#include <png.h>

#include <fstream>
#include <iterator>

#include "shapes.h"
#include "support.h"

namespace eigencrust {
namespace {

using Pixel = std::array<int, 3>;

Pixel at(const Image& image, std::uint32_t x, std::uint32_t y) {
  const std::uint8_t* p = &image.rgb[3 * (std::size_t{y} * image.width + x)];
  return {p[0], p[1], p[2]};
}

// Shading scales linear light, so hue tells the colours apart: the default back is red, the front is not.
bool is_background(const Pixel& p) { return p == Pixel{255, 255, 255}; }
bool is_back(const Pixel& p) { return p[0] > 2 * p[1]; }
bool is_front(const Pixel& p) { return !is_background(p) && p[0] < 2 * p[1]; }

std::size_t count(const Image& image, bool (*is)(const Pixel&)) {
  std::size_t n = 0;
  for (std::uint32_t y = 0; y < image.height; ++y)
    for (std::uint32_t x = 0; x < image.width; ++x) n += is(at(image, x, y)) ? 1 : 0;
  return n;
}

/// First and last column and row that are not background.
std::array<std::uint32_t, 4> extent(const Image& image) {
  std::array<std::uint32_t, 4> e{image.width, 0, image.height, 0};
  for (std::uint32_t y = 0; y < image.height; ++y)
    for (std::uint32_t x = 0; x < image.width; ++x)
      if (!is_background(at(image, x, y)))
        e = {std::min(e[0], x), std::max(e[1], x), std::min(e[2], y), std::max(e[3], y)};
  return e;
}

RenderOptions small(double azimuth = 0, double elevation = 0) {
  RenderOptions o;
  o.width = 120;
  o.height = 100;
  o.azimuth = azimuth;
  o.elevation = elevation;
  return o;
}

TriangleMesh unit_box() { return shapes::box({0, 0, 0}, {1, 1, 1}); }

/// One point on each positive axis in red, green and blue, and white-ish partners on the negative ones.
TriangleMesh axis_points() {
  TriangleMesh cloud;
  cloud.vertices = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
  const double values[] = {255, 0, 0, 200, 200, 200};
  const char* const names[] = {"red", "green", "blue"};
  for (std::size_t c = 0; c < 3; ++c) {
    std::vector<double> column(values, values + 6);
    std::rotate(column.begin(), column.begin() + (3 - static_cast<int>(c)) % 3, column.begin() + 3);
    cloud.vertex_attributes.push_back(make_attribute(names[c], ScalarType::uint8, column));
  }
  return cloud;
}

/// Where the pure colour of channel c is: -1, 0 or 1 to the right and upwards; {9, 9} when hidden.
std::array<int, 2> place_of(const Image& image, std::size_t c) {
  for (std::uint32_t y = 0; y < image.height; ++y)
    for (std::uint32_t x = 0; x < image.width; ++x) {
      const Pixel p = at(image, x, y);
      if (p[c] < 100 || p[(c + 1) % 3] > 20 || p[(c + 2) % 3] > 20) continue;
      const auto third = [](std::uint32_t i, std::uint32_t n) { return i < n / 3 ? -1 : i < 2 * n / 3 ? 0 : 1; };
      return {third(x, image.width), -third(y, image.height)};
    }
  return {9, 9};
}

TEST(Render, CameraStandsWhereTheAnglesSay) {
  const TriangleMesh cloud = axis_points();
  RenderOptions o = small();
  o.width = o.height = 120;
  o.point_size = 8;
  using Place = std::array<int, 2>;
  const auto places = [&] {
    const Image image = render(cloud, o);
    return std::array{place_of(image, 0), place_of(image, 1), place_of(image, 2)};
  };
  EXPECT_EQ(places(), (std::array{Place{1, 0}, Place{0, 1}, Place{0, 0}})) << "x right, y up, z towards us";
  o.azimuth = 90;
  EXPECT_EQ(places(), (std::array{Place{0, 0}, Place{0, 1}, Place{-1, 0}})) << "from +x";
  o.azimuth = 0;
  o.elevation = 90;
  EXPECT_EQ(places(), (std::array{Place{1, 0}, Place{0, 0}, Place{0, -1}})) << "from above";
  o.elevation = 0;
  o.roll = 90;
  EXPECT_EQ(places(), (std::array{Place{0, 1}, Place{-1, 0}, Place{0, 0}})) << "the camera turned clockwise";
  o.roll = 0;
  o.up = {0, 0, 5};
  EXPECT_EQ(places(), (std::array{Place{1, 0}, Place{9, 9}, Place{0, 1}})) << "z up, seen from -y: +y is behind";
  o.up = {1, 0, 0};
  EXPECT_EQ(places(), (std::array{Place{0, 1}, Place{1, 0}, Place{9, 9}})) << "x up, y right, seen from -z";
}

TEST(Render, FrontAndBack) {
  const Image outside = render(unit_box(), small(30, 20));
  EXPECT_TRUE(is_front(at(outside, 60, 50)));
  EXPECT_TRUE(is_background(at(outside, 0, 0)));
  EXPECT_EQ(count(outside, is_back), 0u) << "a closed surface shows no back, not even along its outline";
  RenderOptions on_black = small(30, 20);
  on_black.background = {0, 0, 0}; // so that pixels along the outline keep their hue
  const Image inside_out = render(shapes::flipped(unit_box()), on_black);
  EXPECT_EQ(count(inside_out, is_front), 0u);
  EXPECT_TRUE(is_back(at(inside_out, 60, 50)));
}

TEST(Render, TheObjectJustFitsAndZooms) {
  const auto e = extent(render(unit_box(), small()));
  // A square seen face on in 120 × 100: 92 % of the height.
  EXPECT_THAT(e, testing::ElementsAre(14, 105, 4, 95));
  RenderOptions half = small();
  half.zoom = 0.5;
  EXPECT_THAT(extent(render(unit_box(), half)), testing::ElementsAre(37, 82, 27, 72));
  const TriangleMesh far = shapes::moved(unit_box(), {1e8, 1e8, -1e8}, 0.001);
  EXPECT_THAT(extent(render(far, small())), testing::ElementsAre(14, 105, 4, 95)) << "far from zero";
}

// Every side of 20480 triangles is shared: a crack would let the background through.
TEST(Render, NoCracksBetweenTriangles) {
  const TriangleMesh ball = shapes::icosphere(5);
  for (const double azimuth : {0.0, 17.0, 90.0}) {
    const Image image = render(ball, small(azimuth, azimuth / 2));
    for (std::uint32_t y = 0; y < image.height; ++y)
      for (std::uint32_t x = 0; x < image.width; ++x) {
        const double r = std::hypot(x + 0.5 - 60, y + 0.5 - 50);
        if (r < 44) {
          ASSERT_TRUE(is_front(at(image, x, y))) << x << " " << y;
        } else if (r > 48) {
          ASSERT_TRUE(is_background(at(image, x, y))) << x << " " << y;
        }
      }
  }
}

TEST(Render, LightComesFromTheUpperLeft) {
  const Image ball = render(shapes::icosphere(5), small());
  const int upper_left = at(ball, 40, 30)[1], lower_right = at(ball, 80, 70)[1];
  EXPECT_GT(upper_left, lower_right + 60);
}

// A valley and a ridge have the same two slopes, so only what rises around a pixel tells them apart.
TEST(Render, HollowsAreDarkened) {
  const auto fold = [](double z) {
    return TriangleMesh{{{-1, -1, z}, {-1, 1, z}, {0, -1, 0}, {0, 1, 0}, {1, -1, z}, {1, 1, z}},
                        {{0, 2, 1}, {1, 2, 3}, {2, 4, 3}, {3, 4, 5}},
                        {},
                        {}};
  };
  const Image valley = render(fold(1), small()), ridge = render(fold(-1), small());
  EXPECT_LT(at(valley, 59, 50)[1], at(ridge, 61, 50)[1] - 20) << "left of the valley, right of the ridge";
  EXPECT_NEAR(at(valley, 35, 50)[1], at(ridge, 85, 50)[1], 2) << "far from the fold they are equal";
}

TEST(Render, ClippingShowsTheInside) {
  RenderOptions o = small();
  o.clip_normal = {0, 0, 2};
  o.clip_point = {0, 0, 0.5};
  const Image cut = render(unit_box(), o);
  EXPECT_TRUE(is_back(at(cut, 60, 50)));
  o.clip_normal = {1, 0, 0};
  o.clip_point = {0.5, 0, 0};
  const auto e = extent(render(unit_box(), o));
  EXPECT_NEAR(e[1] - e[0] + 1.0, 46, 1) << "half a box is framed by itself";
  EXPECT_NEAR(e[3] - e[2] + 1.0, 92, 1);
  o.clip_point = {-1, 0, 0};
  EXPECT_THROW(render(unit_box(), o), Error) << "all is cut away";
}

TEST(Render, WireframeDrawsTheDiagonal) {
  RenderOptions o = small();
  o.width = 100;
  const auto darkest_on_middle_row = [&] {
    const Image image = render(unit_box(), o);
    int least = 255;
    for (std::uint32_t x = 20; x < 80; ++x) least = std::min(least, at(image, x, 50)[1]);
    return least;
  };
  EXPECT_GT(darkest_on_middle_row(), 150);
  o.wireframe = true;
  EXPECT_LT(darkest_on_middle_row(), 120);
}

TEST(Render, ColorsOfVerticesAndTriangles) {
  const auto is_green = [](const Pixel& p) { return p[1] > 100 && p[0] < 30 && p[2] < 30; };
  TriangleMesh by_vertex = unit_box(), by_triangle = unit_box();
  const std::vector<double> zeros(8, 0.0), full(8, 255.0), zeros12(12, 0.0), ones12(12, 1.0);
  by_vertex.vertex_attributes = {make_attribute("red", ScalarType::uint8, zeros),
                                 make_attribute("green", ScalarType::uint8, full),
                                 make_attribute("blue", ScalarType::uint8, zeros)};
  by_triangle.triangle_attributes = {make_attribute("red", ScalarType::float32, zeros12),
                                     make_attribute("green", ScalarType::float32, ones12),
                                     make_attribute("blue", ScalarType::float32, zeros12)};
  for (TriangleMesh* mesh : {&by_vertex, &by_triangle}) {
    EXPECT_TRUE(is_green(at(render(*mesh, small()), 60, 50)));
    RenderOptions plain = small();
    plain.use_colors = false;
    EXPECT_FALSE(is_green(at(render(*mesh, plain), 60, 50)));
    EXPECT_TRUE(is_back(at(render(shapes::flipped(*mesh), small()), 60, 50))) << "the back stays red";
  }
  by_vertex.vertex_attributes.pop_back();
  EXPECT_TRUE(is_front(at(render(by_vertex, small()), 60, 50))) << "two columns are no colour";
}

TEST(Render, PointsAreDiscsOfTheirSize) {
  TriangleMesh one;
  one.vertices = {{3, 4, 5}};
  RenderOptions o = small();
  o.point_size = 20;
  const auto e = extent(render(one, o));
  EXPECT_THAT(e, testing::ElementsAre(50, 69, 40, 59));
  o.point_size = 0.01;
  EXPECT_GT(count(render(one, o), is_front), 0u) << "never too small to be seen";
}

TEST(Render, PointsWithNormalsTakeLightAndSide) {
  TriangleMesh two;
  two.vertices = {{-1, 0, 0}, {1, 0, 0}};
  const double zero[] = {0, 0}, nz[] = {1, -1};
  two.vertex_attributes = {make_attribute("nx", ScalarType::float32, zero),
                           make_attribute("ny", ScalarType::float32, zero),
                           make_attribute("nz", ScalarType::float32, nz)};
  RenderOptions o = small();
  o.point_size = 10;
  const Image image = render(two, o);
  const auto e = extent(image);
  EXPECT_TRUE(is_front(at(image, e[0] + 5, 50)));
  EXPECT_TRUE(is_back(at(image, e[1] - 5, 50)));
}

TEST(Render, WhatIsNotFiniteIsLeftOut) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  TriangleMesh mesh = unit_box();
  const Image clean = render(mesh, small());
  mesh.vertices.push_back({nan, 0, 0});
  mesh.vertices.push_back({0, -inf, 0});
  mesh.triangles.push_back({0, 1, 8});
  mesh.triangles.push_back({9, 1, 2});
  EXPECT_EQ(render(mesh, small()).rgb, clean.rgb);
  TriangleMesh cloud;
  cloud.vertices = {{0, 0, 0}, {nan, 1, 1}, {1, 1, 0}};
  EXPECT_NO_THROW(render(cloud, small()));
  cloud.vertices = {{nan, 0, 0}};
  EXPECT_THAT([&] { render(cloud, small()); },
              testing::Throws<Error>(testing::Property(&Error::kind, testing::Eq(ErrorKind::input))));
}

TEST(Render, RefusesOptionsThatMakeNoSense) {
  const auto refused = [](auto change) {
    RenderOptions o = small();
    change(o);
    try {
      render(unit_box(), o);
    } catch (const Error& e) {
      return e.kind() == ErrorKind::usage;
    }
    return false;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(refused([](RenderOptions& o) { o.width = 15; }));
  EXPECT_TRUE(refused([](RenderOptions& o) { o.height = 16385; }));
  EXPECT_TRUE(refused([](RenderOptions& o) { o.zoom = 0; }));
  EXPECT_TRUE(refused([&](RenderOptions& o) { o.zoom = nan; }));
  EXPECT_TRUE(refused([&](RenderOptions& o) { o.azimuth = nan; }));
  EXPECT_TRUE(refused([](RenderOptions& o) { o.up = {}; }));
  EXPECT_TRUE(refused([](RenderOptions& o) { o.point_size = -1; }));
  EXPECT_TRUE(refused([&](RenderOptions& o) { o.clip_normal.x = nan; }));
  EXPECT_THROW(render({}, small()), Error);
  EXPECT_THROW(render({{{0, 0, 0}}, {{0, 0, 7}}, {}, {}}, small()), Error);
}

TEST(Render, SamePixelsEveryTime) {
  const TriangleMesh mesh = shapes::torus(1, 0.4, 60, 30);
  EXPECT_EQ(render(mesh, small(40, 50)).rgb, render(mesh, small(40, 50)).rgb);
}

TEST(Render, FlatAndEdgeOnObjectsDoNotBreakIt) {
  EXPECT_NO_THROW(render(shapes::grid(2, 2), small(90, 0))) << "seen exactly edge-on";
  EXPECT_NO_THROW(render({{{1, 1, 1}}, {{0, 0, 0}}, {}, {}}, small()));
  RenderOptions huge = small();
  huge.zoom = 1e12;
  EXPECT_NO_THROW(render(unit_box(), huge));
}

TEST(RenderAlike, SeveralShareOneFrame) {
  // A box of side 1 and one of side 0.5 in its lower left half: the small one keeps its size and place.
  const TriangleMesh half = shapes::box({0, 0, 0}, {0.5, 0.5, 0.5});
  const std::vector<Image> images = render_alike({unit_box(), half}, small());
  ASSERT_EQ(images.size(), 2u);
  EXPECT_EQ(images[0].rgb, render(unit_box(), small()).rgb); // all of them together are the large one
  EXPECT_NE(images[1].rgb, render(half, small()).rgb);
  const auto large = extent(images[0]), little = extent(images[1]);
  const auto width = [](const std::array<std::uint32_t, 4>& e) { return static_cast<double>(e[1] - e[0] + 1); };
  EXPECT_NEAR(width(little), width(large) / 2, 2);
  EXPECT_NEAR(little[0], large[0], 1);
  EXPECT_NEAR(little[3], large[3], 1); // at the bottom
}

TEST(RenderAlike, MeshesAndPointsTogether) {
  const std::vector<Image> images = render_alike({unit_box(), axis_points()}, small());
  EXPECT_EQ(images[1].rgb, render(axis_points(), small()).rgb); // they reach farther in every direction
  EXPECT_TRUE(render_alike({}, small()).empty());
  EXPECT_THROW(render_alike({unit_box(), TriangleMesh{}}, small()), Error);
}

TEST(Beside, JoinsRowByRow) {
  Image a{1, 2, {1, 1, 1, 2, 2, 2}}, b{2, 2, {3, 3, 3, 4, 4, 4, 5, 5, 5, 6, 6, 6}};
  const Image both = beside({a, b});
  EXPECT_EQ(both.width, 3u);
  EXPECT_EQ(both.height, 2u);
  EXPECT_THAT(both.rgb, testing::ElementsAre(1, 1, 1, 3, 3, 3, 4, 4, 4, 2, 2, 2, 5, 5, 5, 6, 6, 6));
  EXPECT_THROW(beside({a, {1, 1, {0, 0, 0}}}), Error);
  EXPECT_EQ(beside({}).width, 0u);
}

TEST(WritePng, ReadsBackAsWritten) {
  const TempDir folder;
  const Image image = render(unit_box(), small(30, 20));
  write_png(folder / "box.png", image);
  std::ifstream file(folder / "box.png", std::ios::binary);
  const std::vector<char> bytes{std::istreambuf_iterator<char>(file), {}};
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  ASSERT_NE(png_image_begin_read_from_memory(&png, bytes.data(), bytes.size()), 0);
  EXPECT_EQ(png.width, image.width);
  EXPECT_EQ(png.height, image.height);
  png.format = PNG_FORMAT_RGB;
  std::vector<std::uint8_t> pixels(PNG_IMAGE_SIZE(png));
  ASSERT_NE(png_image_finish_read(&png, nullptr, pixels.data(), 0, nullptr), 0);
  EXPECT_EQ(pixels, image.rgb);
}

TEST(WritePng, RefusesBadPicturesAndPlaces) {
  const TempDir folder;
  EXPECT_THROW(write_png(folder / "empty.png", {}), Error);
  EXPECT_THROW(write_png(folder / "short.png", {2, 2, {1, 2, 3}}), Error);
  EXPECT_THROW(write_png(folder / "no/such/place.png", {1, 1, {1, 2, 3}}), Error);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(RenderFiles, HorseIsStoredInsideOut) {
  const auto path = data_path("meshes/horse.ply");
  EIGENCRUST_NEED_DATA(path);
  RenderOptions o = small(60, 10);
  o.background = {0, 0, 0};
  const Image image = render(read_mesh(path), o);
  EXPECT_GT(count(image, is_back), 1000u);
  EXPECT_LT(count(image, is_front), 5u);
}

} // namespace
} // namespace eigencrust
