// SPDX-License-Identifier: GPL-3.0-or-later
// What reconstruct() says of each input row: inlier, confidence, normal.
#include <eigencrust/eigencrust.h>
#include <eigencrust/io.h>
#include <eigencrust/metrics.h>
#include <gmock/gmock.h>

#include <limits>
#include <numeric>

#include "clouds.h"
#include "support.h"

namespace eigencrust {
namespace {

using clouds::Points;

Result with_points(const Points& points, Options options = {}) {
  options.point_results = true;
  return reconstruct(clouds::cloud_of(points), options);
}

bool is_nan(const Vec3& v) { return std::isnan(v.x) && std::isnan(v.y) && std::isnan(v.z); }

std::size_t count(const std::vector<std::uint8_t>& flags, std::size_t begin, std::size_t end) {
  return std::accumulate(flags.begin() + static_cast<std::ptrdiff_t>(begin),
                         flags.begin() + static_cast<std::ptrdiff_t>(end), std::size_t{0});
}

TEST(PointResults, AreLeftOutUnlessAskedFor) {
  const Result result = reconstruct(clouds::cloud_of(clouds::sphere(500)));
  EXPECT_TRUE(result.inlier.empty() && result.confidence.empty() && result.normals.empty());
  EXPECT_THAT(result.report.stages, testing::Not(testing::Contains(testing::Field(&StageReport::name, "points"))));
}

TEST(PointResults, DoNotChangeTheMesh) {
  const Points points = clouds::joined(clouds::jittered(clouds::sphere(2000), 0.02, 1), clouds::random_box(60, 2, 2));
  const Result plain = reconstruct(clouds::cloud_of(points)), more = with_points(points);
  EXPECT_EQ(plain.mesh.vertices, more.mesh.vertices);
  EXPECT_EQ(plain.mesh.triangles, more.mesh.triangles);
}

TEST(PointResults, SphereAndOutliers) {
  const std::size_t n = 5000, m = 250;
  const Points points = clouds::joined(clouds::sphere(n), clouds::random_box(m, 5, 1.5));
  const Result result = with_points(points);
  ASSERT_EQ(result.inlier.size(), n + m);
  ASSERT_EQ(result.confidence.size(), n + m);
  ASSERT_EQ(result.normals.size(), n + m);
  EXPECT_GE(count(result.inlier, 0, n), n - 5);
  std::size_t straight = 0; // outliers that touch the sphere bend a few normals
  for (std::size_t i = 0; i < n; ++i) {
    if (!result.inlier[i]) continue;
    EXPECT_GT(dot(result.normals[i], points[i]), 0.5) << i;
    straight += dot(result.normals[i], points[i]) > std::cos(0.1);
  }
  EXPECT_GE(straight, n * 98 / 100);
  for (std::size_t i = n; i < n + m; ++i) {
    const double off = std::fabs(norm(points[i]) - 1);
    if (off > 3 * result.report.spacing) {
      EXPECT_EQ(result.inlier[i], 0) << off;
    }
    EXPECT_EQ(is_nan(result.normals[i]), result.inlier[i] == 0);
  }
  const auto stage = std::find_if(result.report.stages.begin(), result.report.stages.end(),
                                  [](const StageReport& s) { return s.name == "points"; });
  ASSERT_NE(stage, result.report.stages.end());
  EXPECT_EQ(stage->counts, (decltype(stage->counts){{"inliers", double(count(result.inlier, 0, n + m))}}));
}

TEST(PointResults, TorusLooksOutwardEverywhere) {
  const Points points = clouds::jittered(clouds::torus(1, 0.4, 150, 60), 0.003, 3);
  const Result result = with_points(points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double ring = std::hypot(points[i].x, points[i].y);
    const Vec3 centre{points[i].x / ring, points[i].y / ring, 0};
    ASSERT_EQ(result.inlier[i], 1) << i;
    EXPECT_GT(dot(result.normals[i], points[i] - centre), 0) << i;
  }
}

TEST(PointResults, AHollowBallLooksIntoItsCavity) {
  const Points points = clouds::joined(clouds::sphere(6000), clouds::sphere(2000, 0.5));
  Options options;
  options.outside_points = {{0.01, 0.02, 0.03}}; // the cavity is outside
  const Result result = with_points(points, options);
  for (std::size_t i = 0; i < points.size(); ++i) {
    ASSERT_EQ(result.inlier[i], 1) << i;
    EXPECT_GT((i < 6000 ? 1 : -1) * dot(result.normals[i], points[i]), 0) << i;
  }
}

TEST(PointResults, RowsKeepTheirPlacesInAnyOrder) {
  const Points points = clouds::joined(clouds::jittered(clouds::sphere(2500), 0.02, 1), clouds::random_box(120, 2, 2));
  std::vector<std::uint32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0u);
  clouds::Random random(9);
  for (std::size_t i = order.size(); i > 1; --i)
    std::swap(order[i - 1], order[random.below(static_cast<std::uint32_t>(i))]);
  Points mixed;
  for (const std::uint32_t row : order) mixed.push_back(points[row]);
  const Result a = with_points(points), b = with_points(mixed);
  for (std::size_t i = 0; i < order.size(); ++i) {
    EXPECT_EQ(b.inlier[i], a.inlier[order[i]]);
    EXPECT_EQ(b.confidence[i], a.confidence[order[i]]);
    if (b.inlier[i]) {
      EXPECT_EQ(b.normals[i], a.normals[order[i]]);
    }
  }
}

TEST(PointResults, ThreadsDoNotMatter) {
  const Points points = clouds::joined(clouds::jittered(clouds::sphere(9000), 0.02, 1), clouds::random_box(500, 2, 2));
  Options options;
  options.threads = 1;
  const Result one = with_points(points, options);
  for (const unsigned threads : {2u, 5u}) {
    options.threads = threads;
    const Result other = with_points(points, options);
    EXPECT_EQ(other.inlier, one.inlier);
    EXPECT_EQ(other.confidence, one.confidence);
    for (std::size_t i = 0; i < points.size(); ++i)
      if (one.inlier[i]) {
        EXPECT_EQ(other.normals[i], one.normals[i]);
      }
  }
}

TEST(PointResults, DuplicatesAndRowsThatAreNotFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();
  const Points sphere = clouds::sphere(800);
  Points points = clouds::joined({{nan, 0, 0}}, sphere);
  points = clouds::joined(points, {{0, infinite, 0}, {40, 0, 0}, {40, 0, 0}}); // a lone outlier twice
  points = clouds::joined(points, sphere);                                     // every sample once more
  points = clouds::moved(points, {1e3 / 3, 1e3 / 7, -0.1});
  const Result result = with_points(points);
  const std::size_t again = 1 + sphere.size() + 3;
  for (std::size_t i = 0; i < sphere.size(); ++i) {
    EXPECT_EQ(result.inlier[1 + i], 1);
    EXPECT_EQ(result.inlier[again + i], 1);
    EXPECT_EQ(result.confidence[again + i], result.confidence[1 + i]);
    EXPECT_EQ(result.normals[again + i], result.normals[1 + i]);
  }
  for (const std::size_t row : {std::size_t{0}, 1 + sphere.size(), 2 + sphere.size(), 3 + sphere.size()}) {
    EXPECT_EQ(result.inlier[row], 0) << row;
    EXPECT_TRUE(is_nan(result.normals[row])) << row;
  }
  EXPECT_EQ(result.confidence[0], 0);
}

TEST(PointResults, DroppedPiecesHaveNoInliers) {
  const Points points = clouds::joined(clouds::sphere(1500), clouds::sphere(600, 0.5, {10, 0, 0}));
  Options options;
  options.components.kind = KeepComponents::Kind::largest;
  const Result result = with_points(points, options);
  EXPECT_EQ(count(result.inlier, 0, 1500), 1500u);
  EXPECT_EQ(count(result.inlier, 1500, 2100), 0u);
}

TEST(PointResults, AFacadeLooksToItsFront) {
  Points points;
  for (const Vec3& p : clouds::lattice(40, 40, 1)) points.push_back({p.x, p.y, 2 * std::sin(p.x / 5)});
  Options options;
  options.facade = Axis::plus_z;
  const Result result = with_points(points, options);
  EXPECT_EQ(count(result.inlier, 0, points.size()), points.size());
  for (const Vec3& n : result.normals) EXPECT_GT(n.z, 0);
}

TEST(PointResults, SmallCloudsAndThePaper) {
  for (const std::size_t n : {5u, 6u, 8u, 12u, 30u})
    for (const Preset preset : {Preset::robust, Preset::paper}) try {
        const Result result = with_points(clouds::sphere(n), Options::of(preset));
        EXPECT_EQ(result.inlier.size(), n);
      } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::no_surface);
      }
}

/// Vertices of a mesh with their outward normals, and uniform outliers in its box, 1.2 times as large.
struct Mixture {
  Points points;
  std::vector<Vec3> normals;    ///< of the vertices
  std::vector<double> distance; ///< of the outliers to the surface
};
Mixture mixture_of(const TriangleMesh& mesh, double share, std::uint64_t seed) {
  Mixture mixture;
  mixture.points = mesh.vertices;
  mixture.normals.resize(mesh.vertices.size());
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vec3 area = cross(mesh.vertices[b] - mesh.vertices[a], mesh.vertices[c] - mesh.vertices[a]);
    for (const std::uint32_t v : {a, b, c}) mixture.normals[v] = mixture.normals[v] + area;
  }
  const double sign = validate(mesh, {.self_intersections = false}).volume < 0 ? -1 : 1; // the horse is stored inward
  for (Vec3& n : mixture.normals) n = sign * n;
  Box3 box;
  for (const Vec3& p : mesh.vertices) box.add(p);
  const Vec3 half = 0.6 * (box.max - box.min);
  clouds::Random random(seed);
  Points outliers;
  for (std::size_t i = 0; i < static_cast<std::size_t>(share * static_cast<double>(mesh.vertices.size())); ++i)
    outliers.push_back(box.centre() + Vec3{random.uniform(-half.x, half.x), random.uniform(-half.y, half.y),
                                           random.uniform(-half.z, half.z)});
  mixture.distance = distances_to_surface(outliers, mesh);
  mixture.points = clouds::joined(mixture.points, outliers);
  return mixture;
}

TEST(PointResults, OrientRealMeshesAmongOutliers) {
  for (const char* name : {"meshes/armadillo.obj", "meshes/horse.ply"}) {
    const auto file = data_path(name);
    EIGENCRUST_NEED_DATA(file);
    SCOPED_TRACE(name);
    const Mixture mixture = mixture_of(read_mesh(file), 0.05, 11);
    const Result result = with_points(mixture.points);
    std::size_t right = 0;
    for (std::size_t i = 0; i < mixture.normals.size(); ++i) right += dot(result.normals[i], mixture.normals[i]) > 0;
    EXPECT_GE(static_cast<double>(right), 0.999 * static_cast<double>(mixture.normals.size()));
  }
}

TEST(PointResults, ClassifyRealMeshesAmongOutliers) {
  for (const char* name : {"meshes/armadillo.obj", "meshes/horse.ply"}) {
    const auto file = data_path(name);
    EIGENCRUST_NEED_DATA(file);
    SCOPED_TRACE(name);
    const Mixture mixture = mixture_of(read_mesh(file), 0.1, 12);
    const Result result = with_points(mixture.points);
    const std::size_t n = mixture.normals.size();
    const std::size_t found = count(result.inlier, 0, n), all = count(result.inlier, 0, mixture.points.size());
    EXPECT_GE(static_cast<double>(found), 0.99 * static_cast<double>(n));
    EXPECT_GE(static_cast<double>(found), 0.99 * static_cast<double>(all));
    std::size_t far = 0, told = 0;
    for (std::size_t i = 0; i < mixture.distance.size(); ++i) {
      if (mixture.distance[i] <= 2 * result.report.spacing) continue;
      ++far;
      told += !result.inlier[n + i];
    }
    EXPECT_GE(static_cast<double>(told), 0.99 * static_cast<double>(far));
  }
}

TEST(PointResults, NoisyBunnyIsMadeOfInliersThatLookOutward) {
  const auto file = data_path("bunny/bunny_raw.ply"), zipper = data_path("bunny/bun_zipper.ply");
  EIGENCRUST_NEED_DATA(file);
  EIGENCRUST_NEED_DATA(zipper);
  Points points = read_point_cloud(file).points;
  clouds::Random random(1);
  const auto deviate = [&] { // twelve uniform numbers: mean 0, standard deviation 1
    double sum = -6;
    for (int k = 0; k < 12; ++k) sum += random.uniform();
    return sum;
  };
  for (Vec3& p : points) p = p + 0.0005 * Vec3{deviate(), deviate(), deviate()};
  const Result result = with_points(points);
  const double n = static_cast<double>(points.size());
  EXPECT_LT(static_cast<double>(result.report.mesh.vertices), 0.6 * n); // most samples are no vertices
  EXPECT_GT(static_cast<double>(count(result.inlier, 0, points.size())), 0.98 * n);
  const TriangleMesh reference = read_mesh(zipper); // open, oriented outward
  const TriangleTree tree(reference);
  std::vector<double> angles;
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < points.size(); i += 7) {
    const auto nearest = tree.nearest(points[i]);
    if (!result.inlier[i] || nearest.distance > 0.002) continue;
    const auto& [a, b, c] = reference.triangles[nearest.triangle];
    const auto& at = reference.vertices;
    const Vec3 area = cross(at[b] - at[a], at[c] - at[a]);
    const double cosine = dot(result.normals[i], area) / norm(area);
    wrong += !(cosine > 0);
    angles.push_back(std::acos(std::clamp(cosine, -1.0, 1.0)));
  }
  EXPECT_GT(angles.size(), 40000u);
  EXPECT_LE(static_cast<double>(wrong), 1e-3 * static_cast<double>(angles.size()));
  EXPECT_LT(summarize(angles).median, 8 * std::numbers::pi / 180);
}

} // namespace
} // namespace eigencrust
