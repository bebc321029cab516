// SPDX-License-Identifier: GPL-3.0-or-later
// The virtual scanner against surfaces whose answer is known.
#include "virtual_scanner.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <optional>

#include <eigencrust/error.h>
#include <eigencrust/io.h>

#include "counter_random.h"

namespace eigencrust::tools {
namespace {

constexpr double degree = std::numbers::pi / 180;

/// A square of half side `half` in the plane z = height, seen from above, tilted about the y axis.
TriangleMesh square(double half, double height = 0, double tilt = 0) {
  TriangleMesh mesh;
  for (const auto& [x, y] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}})
    mesh.vertices.push_back(
        {half * x * std::cos(degree * tilt), half * y, height + half * x * std::sin(degree * tilt)});
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

/// Unit sphere by latitude and longitude, outward.
TriangleMesh sphere(std::uint32_t n) {
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i <= n; ++i)
    for (std::uint32_t j = 0; j < 2 * n; ++j) {
      const double a = std::numbers::pi * i / n, b = std::numbers::pi * j / n;
      mesh.vertices.push_back({std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a)});
    }
  for (std::uint32_t i = 0; i < n; ++i)
    for (std::uint32_t j = 0; j < 2 * n; ++j) {
      const std::uint32_t k = (j + 1) % (2 * n), row = 2 * n * i, next = row + 2 * n;
      if (i > 0) mesh.triangles.push_back({row + j, next + j, row + k});
      if (i + 1 < n) mesh.triangles.push_back({row + k, next + j, next + k});
    }
  return mesh;
}

void append(TriangleMesh& mesh, const TriangleMesh& more) {
  const auto shift = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), more.vertices.begin(), more.vertices.end());
  for (const auto& [a, b, c] : more.triangles) mesh.triangles.push_back({a + shift, b + shift, c + shift});
}

/// Parallel rays straight down onto the square [-1, 1]².
Sensor downward(std::uint32_t across) {
  return {.projection = Projection::parallel,
          .position = {0, 0, 5},
          .target = {0, 0, 0},
          .up = {0, 1, 0},
          .columns = across,
          .rows = across,
          .spacing = 2.0 / across};
}

std::vector<double> column(const PointCloud& cloud, const char* name) {
  const Attribute* attribute = find_attribute(cloud.attributes, name);
  if (attribute == nullptr) throw std::runtime_error(std::string("no attribute ") + name);
  std::vector<double> values(cloud.points.size());
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = attribute_value(*attribute, i);
  return values;
}

/// The oracle: smallest t > 0 at which a triangle is met, by solving o + t d = a + u ab + v ac.
std::optional<double> brute_force_hit(const TriangleMesh& mesh, const Ray& ray) {
  std::optional<double> best;
  for (const auto& triangle : mesh.triangles) {
    const Vec3 a = mesh.vertices[triangle[0]], ab = mesh.vertices[triangle[1]] - a, ac = mesh.vertices[triangle[2]] - a;
    const double determinant = dot(ab, cross(ray.direction, ac));
    if (determinant == 0) continue;
    const Vec3 oa = ray.origin - a;
    const double u = dot(oa, cross(ray.direction, ac)) / determinant;
    const double v = dot(ray.direction, cross(oa, ab)) / determinant;
    const double t = dot(ac, cross(oa, ab)) / determinant;
    if (u >= -1e-12 && v >= -1e-12 && u + v <= 1 + 1e-12 && t > 0 && (!best || t < *best)) best = t;
  }
  return best;
}

// ---- what is hit ----

TEST(VirtualScanner, PlaneIsHitExactlyAndInRowMajorOrder) {
  const Sensor sensor{.position = {0.3, -0.2, 5}, .target = {0.3, -0.2, 0}, .up = {0, 1, 0}, .columns = 9, .rows = 7};
  const PointCloud cloud = scan(square(100), {sensor});
  ASSERT_EQ(cloud.points.size(), 63u);
  const std::vector<double> range = column(cloud, "range");
  for (std::size_t i = 0; i < 63; ++i) {
    EXPECT_NEAR(cloud.points[i].z, 0, 1e-9);
    EXPECT_NEAR(range[i], distance(cloud.points[i], sensor.position), 1e-6); // float32
  }
  // The middle ray meets the target; columns run to the right, rows downwards; 40 degrees over 9 cells.
  EXPECT_LT(distance(cloud.points[31], {0.3, -0.2, 0}), 1e-9);
  const double step = 5 * 2 * std::tan(20 * degree) / 9;
  EXPECT_LT(distance(cloud.points[32], {0.3 + step, -0.2, 0}), 1e-9);
  EXPECT_LT(distance(cloud.points[40], {0.3, -0.2 - step, 0}), 1e-9);
}

TEST(VirtualScanner, TiltedPlane) {
  const PointCloud cloud = scan(square(100, 0, 40), {downward(12)});
  ASSERT_EQ(cloud.points.size(), 144u);
  for (const Vec3& p : cloud.points) EXPECT_NEAR(p.z, p.x * std::tan(40 * degree), 1e-9);
}

TEST(VirtualScanner, SphereAgreesWithBruteForce) {
  const std::uint32_t n = 12;
  const TriangleMesh mesh = sphere(n);
  const Sensor sensor = aim_pinhole({0, 0, 0}, {0.48, 0.6, 0.64}, 1.1, 4, 40, {0, 0, 1});
  const RayGrid grid(sensor);
  const PointCloud cloud = scan(mesh, {sensor});
  std::size_t next = 0;
  for (std::uint64_t i = 0; i < grid.size(); ++i) {
    const Ray ray = grid.ray(i);
    const auto t = brute_force_hit(mesh, ray);
    if (!t) continue;
    ASSERT_LT(next, cloud.points.size());
    const Vec3 p = cloud.points[next++];
    EXPECT_LT(distance(p, ray.origin + *t * ray.direction), 1e-9);
    // A chord of pi/n lies within the sphere by less than 1 - cos^2(pi/2n).
    EXPECT_LE(norm(p), 1 + 1e-12);
    EXPECT_GT(norm(p), std::pow(std::cos(std::numbers::pi / (2 * n)), 2));
  }
  EXPECT_EQ(next, cloud.points.size());
  EXPECT_GT(next, 500u);
}

TEST(VirtualScanner, TheNearerSurfaceHidesTheFarther) {
  TriangleMesh mesh = square(100, -3);
  append(mesh, sphere(16));
  const PointCloud cloud = scan(mesh, {downward(101)});
  ASSERT_EQ(cloud.points.size(), 101u * 101);
  for (const Vec3& p : cloud.points) {
    // Parallel rays: the shadow on the plane is the disc of radius 1 (its polygon's inradius is 0.98).
    if (p.z < -2)
      EXPECT_GT(std::hypot(p.x, p.y), 0.98);
    else
      EXPECT_GE(p.z, 0);
  }
}

TEST(VirtualScanner, ParallelRaysStartOnTheirPlane) {
  const PointCloud cloud = scan(square(1, 0.5), {downward(10)});
  ASSERT_EQ(cloud.points.size(), 100u);
  const auto sx = column(cloud, "sx"), sy = column(cloud, "sy"), sz = column(cloud, "sz");
  for (std::size_t i = 0; i < 100; ++i) {
    EXPECT_NEAR(sx[i], cloud.points[i].x, 1e-6);
    EXPECT_NEAR(sy[i], cloud.points[i].y, 1e-6);
    EXPECT_EQ(sz[i], 5);
  }
  EXPECT_NEAR(distance(cloud.points[0], cloud.points[1]), 0.2, 1e-12);
}

TEST(VirtualScanner, BackFacesReturnUnlessTold) {
  Sensor below = downward(8);
  below.position.z = -5;
  EXPECT_EQ(scan(square(2), {below}).points.size(), 64u);
  EXPECT_EQ(scan(square(2), {below}, {.drop_back_faces = true}).points.size(), 0u);
  EXPECT_EQ(scan(square(2), {downward(8)}, {.drop_back_faces = true}).points.size(), 64u);
}

TEST(VirtualScanner, GrazingRaysDoNotReturn) {
  EXPECT_EQ(scan(square(100, 0, 59), {downward(8)}, {.max_incidence = 60}).points.size(), 64u);
  EXPECT_EQ(scan(square(100, 0, 61), {downward(8)}, {.max_incidence = 60}).points.size(), 0u);
  // Turned over, the angle is the same.
  EXPECT_EQ(scan(square(100, 0, 180 - 59), {downward(8)}, {.max_incidence = 60}).points.size(), 64u);
  EXPECT_EQ(scan(square(100, 0, 180 - 61), {downward(8)}, {.max_incidence = 60}).points.size(), 0u);
  // On the unit sphere parallel rays at radius r meet the surface at asin(r); facets are 1.8 degrees.
  for (const Vec3& p : scan(sphere(100), {downward(60)}, {.max_incidence = 60}).points)
    EXPECT_LT(std::hypot(p.x, p.y), std::sin(62 * degree));
}

// ---- noise ----

struct Moments {
  double mean = 0, deviation = 0, within_one = 0;
};
Moments moments(const std::vector<double>& values) {
  Moments m;
  for (const double v : values) m.mean += v / static_cast<double>(values.size());
  for (const double v : values) m.deviation += (v - m.mean) * (v - m.mean) / static_cast<double>(values.size());
  m.deviation = std::sqrt(m.deviation);
  for (const double v : values)
    if (std::abs(v - m.mean) < m.deviation) m.within_one += 1 / static_cast<double>(values.size());
  return m;
}

void expect_normal(const std::vector<double>& values, double sigma) {
  const double n = static_cast<double>(values.size());
  const Moments m = moments(values);
  EXPECT_NEAR(m.mean, 0, 4 * sigma / std::sqrt(n));
  EXPECT_NEAR(m.deviation, sigma, 4 * sigma / std::sqrt(2 * n));
  EXPECT_NEAR(m.within_one, 0.6827, 4 * std::sqrt(0.6827 * 0.3173 / n));
}

TEST(VirtualScanner, RangeNoiseIsGaussianAlongTheRay) {
  const double sigma = 0.02;
  const PointCloud exact = scan(square(2), {downward(200)});
  const PointCloud noisy = scan(square(2), {downward(200)}, {.range_noise = sigma});
  ASSERT_EQ(noisy.points.size(), 40000u);
  std::vector<double> error;
  for (std::size_t i = 0; i < noisy.points.size(); ++i) {
    EXPECT_NEAR(noisy.points[i].x, exact.points[i].x, 1e-12);
    EXPECT_NEAR(noisy.points[i].y, exact.points[i].y, 1e-12);
    error.push_back(noisy.points[i].z);
  }
  expect_normal(error, sigma);
  // Neighbouring rays are independent: the correlation of n pairs has deviation 1/sqrt(n).
  double correlation = 0;
  for (std::size_t i = 1; i < error.size(); ++i) correlation += error[i] * error[i - 1];
  EXPECT_NEAR(correlation / (sigma * sigma * 40000), 0, 4 / 200.0);
}

TEST(VirtualScanner, IsotropicNoiseIsGaussianInEachCoordinate) {
  const PointCloud exact = scan(square(2), {downward(200)});
  const PointCloud noisy = scan(square(2), {downward(200)}, {.isotropic_noise = 0.01, .seed = 7});
  std::vector<double> x, y, z;
  for (std::size_t i = 0; i < noisy.points.size(); ++i) {
    const Vec3 e = noisy.points[i] - exact.points[i];
    x.push_back(e.x), y.push_back(e.y), z.push_back(e.z);
  }
  for (const auto& values : {x, y, z}) expect_normal(values, 0.01);
  double xy = 0, yz = 0, zx = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xy += x[i] * y[i];
    yz += y[i] * z[i];
    zx += z[i] * x[i];
  }
  for (const double sum : {xy, yz, zx}) EXPECT_NEAR(sum / (1e-4 * 40000), 0, 4 / 200.0);
}

TEST(VirtualScanner, QuantizedRangesAreMultiples) {
  const PointCloud cloud = scan(square(2), {downward(50)}, {.range_noise = 0.2, .range_quantum = 0.125});
  std::size_t moved = 0;
  for (const double r : column(cloud, "range")) {
    EXPECT_EQ(r / 0.125, std::round(r / 0.125));
    if (r != 5) ++moved;
  }
  EXPECT_GT(moved, 1000u);
}

TEST(VirtualScanner, OutliersAreAsManyAsAskedAndInTheBox) {
  const TriangleMesh mesh = sphere(20);
  const PointCloud cloud = scan(mesh, {downward(200)}, {.outlier_fraction = 0.1, .outlier_box = 1.5, .truth = true});
  const auto flag = column(cloud, "outlier"), off = column(cloud, "surface_distance");
  std::size_t outliers = 0, beyond_box = 0;
  for (std::size_t i = 0; i < flag.size(); ++i) {
    const Vec3 p = cloud.points[i];
    const double largest = std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    if (flag[i] == 0) {
      EXPECT_NEAR(off[i], 0, 1e-6);
      continue;
    }
    ++outliers;
    EXPECT_LE(largest, 1.5);
    if (largest > 1) ++beyond_box;
    // The distance to the sphere is | |p| - 1 | up to the facets.
    EXPECT_NEAR(off[i], std::abs(norm(p) - 1), 0.013);
  }
  const double n = static_cast<double>(cloud.points.size()), k = static_cast<double>(outliers);
  EXPECT_NEAR(k, 0.1 * n, 4 * std::sqrt(0.09 * n));
  // The box [-1, 1]³ holds 1/1.5³ of the large one.
  EXPECT_NEAR(static_cast<double>(beyond_box), k * (1 - 1 / 3.375), 4 * std::sqrt(0.21 * k));
}

TEST(VirtualScanner, OutliersOnTheRayLieBeforeTheSurface) {
  const PointCloud cloud =
      scan(square(2), {downward(50)}, {.outlier_fraction = 1, .outliers = OutlierKind::ray, .truth = true});
  ASSERT_EQ(cloud.points.size(), 2500u);
  double mean = 0;
  for (const Vec3& p : cloud.points) {
    EXPECT_GE(p.z, 0);
    EXPECT_LE(p.z, 5);
    mean += p.z / 2500;
  }
  EXPECT_NEAR(mean, 2.5, 4 * 5 / std::sqrt(12.0 * 2500));
}

TEST(VirtualScanner, DropoutLosesReturnsAndLeavesTheOthersAlone) {
  const ScanOptions full{.range_noise = 0.1};
  ScanOptions lossy = full;
  lossy.dropout = 0.3;
  const PointCloud all = scan(square(2), {downward(100)}, full), some = scan(square(2), {downward(100)}, lossy);
  EXPECT_NEAR(static_cast<double>(some.points.size()), 7000, 4 * std::sqrt(2100));
  std::size_t at = 0; // `some` is a subsequence of `all`
  for (const Vec3& p : some.points) {
    while (at < all.points.size() && all.points[at] != p) ++at;
    ASSERT_LT(at++, all.points.size());
  }
}

// ---- the same bytes ----

ScanOptions everything(std::uint64_t seed, unsigned threads) {
  return {.range_noise = 0.01,
          .isotropic_noise = 0.003,
          .range_quantum = 0.001,
          .max_incidence = 80,
          .dropout = 0.1,
          .outlier_fraction = 0.05,
          .truth = true,
          .seed = seed,
          .threads = threads};
}

TEST(VirtualScanner, SameSeedSameCloudForAnyNumberOfThreads) {
  const TriangleMesh mesh = sphere(20);
  std::vector<Sensor> sensors;
  for (const Vec3& d : fibonacci_directions(3)) sensors.push_back(aim_pinhole({0, 0, 0}, d, 1.1, 3, 100, {0, 0, 1}));
  const PointCloud one = scan(mesh, sensors, everything(5, 1));
  ASSERT_GT(one.points.size(), 10000u);
  for (const unsigned threads : {2u, 5u}) {
    const PointCloud many = scan(mesh, sensors, everything(5, threads));
    EXPECT_EQ(many.points, one.points);
    EXPECT_EQ(many.scan_index, one.scan_index);
    ASSERT_EQ(many.attributes.size(), one.attributes.size());
    for (std::size_t i = 0; i < one.attributes.size(); ++i)
      EXPECT_EQ(many.attributes[i].values, one.attributes[i].values) << one.attributes[i].name;
  }
  EXPECT_NE(scan(mesh, sensors, everything(6, 1)).points, one.points);
}

TEST(VirtualScanner, ScansAreNumberedAndCarryTheirSensor) {
  std::vector<Sensor> sensors(3, downward(4));
  for (std::size_t s = 0; s < 3; ++s) {
    sensors[s].projection = Projection::pinhole;
    sensors[s].position = {0.5 * static_cast<double>(s), 0, 5};
  }
  const PointCloud cloud = scan(square(100), sensors);
  ASSERT_EQ(cloud.points.size(), 48u);
  ASSERT_EQ(cloud.scan_index.size(), 48u);
  const auto number = column(cloud, "scan"), sx = column(cloud, "sx");
  for (std::size_t i = 0; i < 48; ++i) {
    EXPECT_EQ(cloud.scan_index[i], i / 16);
    EXPECT_EQ(number[i], static_cast<double>(i / 16));
    EXPECT_EQ(sx[i], 0.5 * static_cast<double>(i / 16));
  }
  EXPECT_EQ(find_attribute(cloud.attributes, "scan")->type, ScalarType::uint8);
  const PointCloud many = scan(square(100), std::vector<Sensor>(257, downward(1)));
  EXPECT_EQ(find_attribute(many.attributes, "scan")->type, ScalarType::uint16);
  EXPECT_EQ(column(many, "scan").back(), 256);
}

TEST(CounterRandom, IsTheSameOnEveryMachineAndUniform) {
  // Written down once; a change of the generator changes every scan that was ever made with a seed.
  EXPECT_EQ(CounterRandom(1, 0, 0).uniform(0), 0x1.b56c0a4dcd968p-1);
  EXPECT_EQ(CounterRandom(1, 2, 3).uniform(4), 0x1.5c976a06ec07p-5);
  std::array<double, 16> bin{};
  for (std::uint64_t i = 0; i < 16000; ++i) {
    const double u = CounterRandom(9, i % 7, i).uniform(i % 5);
    ASSERT_GE(u, 0);
    ASSERT_LT(u, 1);
    bin[static_cast<std::size_t>(16 * u)] += 1;
  }
  double chi2 = 0; // 15 degrees of freedom: 37.7 is exceeded once in 1000
  for (const double k : bin) chi2 += (k - 1000) * (k - 1000) / 1000;
  EXPECT_LT(chi2, 37.7);
}

// ---- sensors ----

TEST(Sensors, DirectionsAreUnitAndSpread) {
  const std::vector<Vec3> directions = fibonacci_directions(100, {1, 2, 3});
  Vec3 sum;
  for (const Vec3& d : directions) {
    EXPECT_NEAR(norm(d), 1, 1e-12);
    sum = sum + d;
  }
  EXPECT_LT(norm(sum) / 100, 0.01);
  for (std::size_t i = 0; i < 100; ++i)
    for (std::size_t k = 0; k < i; ++k) EXPECT_GT(distance(directions[i], directions[k]), 0.2); // even: about 0.35
}

TEST(Sensors, RingsStandAtTheirElevation) {
  const std::vector<Vec3> ring = ring_directions(4, 30, 90);
  EXPECT_LT(distance(ring[0], {0, std::cos(30 * degree), 0.5}), 1e-12);
  EXPECT_LT(distance(ring[1], {-std::cos(30 * degree), 0, 0.5}), 1e-12);
  for (const Vec3& d : ring_directions(5, -20, 0, {0, 1, 0})) EXPECT_NEAR(d.y, std::sin(-20 * degree), 1e-12);
}

TEST(Sensors, TheWholeSphereIsInView) {
  // Also from straight above, where `up` runs along the line of sight.
  for (const Vec3& direction : {Vec3{0, 0, 1}, Vec3{1, 0, 0}, Vec3{0.6, 0, -0.8}})
    for (const bool parallel : {false, true}) {
      const Sensor sensor = parallel ? aim_parallel({5, 0, 0}, direction, 1, 3, 0.05, {0, 0, 1})
                                     : aim_pinhole({5, 0, 0}, direction, 1, 3, 40, {0, 0, 1});
      const RayGrid grid(sensor);
      // The outer rays pass the sphere, the middle ones go through it.
      const auto distance_to_centre = [&](std::uint64_t i) {
        const Ray ray = grid.ray(i);
        return norm(cross(Vec3{5, 0, 0} - ray.origin, ray.direction));
      };
      const std::uint64_t half = sensor.columns / 2;
      EXPECT_GT(distance_to_centre(half), 0.95);
      EXPECT_GT(distance_to_centre(half * sensor.columns), 0.95);
      EXPECT_LT(distance_to_centre(half * sensor.columns + half), 0.06);
    }
}

// ---- refusals ----

template <class F>
ErrorKind kind_of(F&& call) {
  try {
    call();
  } catch (const Error& e) {
    return e.kind();
  }
  return ErrorKind{};
}

TEST(VirtualScanner, OptionsOutOfRangeAreRefused) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<ScanOptions> bad{{.range_noise = -1},   {.range_noise = nan},     {.isotropic_noise = -1},
                                     {.range_quantum = -1}, {.max_incidence = 0},     {.max_incidence = 91},
                                     {.dropout = 1.1},      {.outlier_fraction = -1}, {.outlier_fraction = nan},
                                     {.outlier_box = 0}};
  for (std::size_t i = 0; i < bad.size(); ++i)
    EXPECT_EQ(kind_of([&] { scan(square(1), {downward(2)}, bad[i]); }), ErrorKind::usage) << i;
  EXPECT_EQ(kind_of([] { scan(square(1), {}); }), ErrorKind::usage);
}

TEST(VirtualScanner, SensorsOutOfRangeAreRefused) {
  std::vector<Sensor> bad(7, downward(2));
  bad[0].columns = 0;
  bad[1].rows = 65537;
  bad[2].target = bad[2].position;
  bad[3].position.x = std::numeric_limits<double>::infinity();
  bad[4].spacing = 0;
  bad[5].projection = bad[6].projection = Projection::pinhole;
  bad[5].field_of_view = 180;
  bad[6].field_of_view = 0;
  for (std::size_t i = 0; i < bad.size(); ++i)
    EXPECT_EQ(kind_of([&] { scan(square(1), {bad[i]}); }), ErrorKind::usage) << i;
  EXPECT_EQ(kind_of([] { aim_pinhole({}, {1, 0, 0}, 2, 1, 10, {0, 0, 1}); }), ErrorKind::usage);
  EXPECT_EQ(kind_of([] { aim_parallel({}, {1, 0, 0}, 1, 3, 1e-9, {0, 0, 1}); }), ErrorKind::usage);
  EXPECT_EQ(kind_of([] { fibonacci_directions(3, {0, 0, 0}); }), ErrorKind::usage);
}

TEST(VirtualScanner, BrokenMeshesAreRefused) {
  TriangleMesh empty = square(1), beyond = square(1), infinite = square(1);
  empty.triangles.clear();
  beyond.triangles[0][1] = 4;
  infinite.vertices[2].y = std::numeric_limits<double>::infinity();
  for (const TriangleMesh& mesh : {empty, beyond, infinite})
    EXPECT_EQ(kind_of([&] { scan(mesh, {downward(2)}); }), ErrorKind::input);
}

} // namespace
} // namespace eigencrust::tools
