// SPDX-License-Identifier: GPL-3.0-or-later
// The bundled scan of the teapot: that it can be made again, and what is said of it in examples/README.md.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>

#include <eigencrust/io.h>

#include "bezier_patches.h"
#include "support.h"
#include "virtual_scanner.h"

namespace eigencrust::tools {
namespace {

const std::filesystem::path examples = source_folder() / "examples";

constexpr double noise = 0.002;

/// The scan of examples/make_teapot_scan.sh.
PointCloud teapot_scan(bool truth = false) {
  const TriangleMesh mesh = tessellate(read_bezier_patches(examples / "teapot_patches.txt"), 64);
  Box3 box;
  for (const Vec3& p : mesh.vertices) box.add(p);
  const double radius = 0.5 * box.diagonal();
  std::vector<Sensor> sensors;
  for (const double y : {2.5, -2.5})
    sensors.push_back(
        {.position = {6, y, 5.5}, .target = {3.1, 0, 2.4}, .columns = 84, .rows = 84, .field_of_view = 11});
  for (const auto& ring : {ring_directions(4, 10, 45), ring_directions(2, 45, 90), ring_directions(1, 45, 180),
                           ring_directions(2, -25, 90)})
    for (const Vec3& direction : ring)
      sensors.push_back(aim_pinhole(box.centre(), direction, radius, 3 * radius, 240, {0, 0, 1}));
  return scan(mesh, sensors,
              {.range_noise = noise,
               .max_incidence = 75,
               .drop_back_faces = true,
               .outlier_fraction = 0.002,
               .truth = truth,
               .seed = 1975});
}

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

TEST(TeapotScan, MadeAgainItIsTheSameFile) {
  const std::string bundled = bytes_of(examples / "teapot_scan.ply");
  ASSERT_FALSE(bundled.empty());
  EXPECT_LT(bundled.size(), 3'000'000u);
  const TempDir folder;
  WriteOptions write;
  write.coordinates = CoordinateType::float32;
  write_point_cloud(folder / "scan.ply", teapot_scan(), write);
  EXPECT_TRUE(bytes_of(folder / "scan.ply") == bundled);
}

TEST(TeapotScan, IsWhatItsDescriptionSays) {
  const PointCloud cloud = teapot_scan(true);
  const double n = static_cast<double>(cloud.points.size());
  EXPECT_GT(n, 60'000);
  EXPECT_LT(n, 100'000);
  const Attribute* outlier = find_attribute(cloud.attributes, "outlier");
  const Attribute* off = find_attribute(cloud.attributes, "surface_distance");
  ASSERT_TRUE(outlier != nullptr && off != nullptr);
  std::vector<double> distances;
  std::map<std::uint32_t, std::size_t> of_scan;
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    ++of_scan[cloud.scan_index[i]];
    if (attribute_value(*outlier, i) == 0) distances.push_back(attribute_value(*off, i));
  }
  EXPECT_NEAR(n - static_cast<double>(distances.size()), 0.002 * n, 4 * std::sqrt(0.002 * n));
  EXPECT_EQ(of_scan.size(), 11u);
  for (const auto& [scan, points] : of_scan) EXPECT_GT(points, 2500u) << scan;
  // Noise along the ray shows across the surface as its share along the normal.
  std::nth_element(distances.begin(), distances.begin() + 40'000, distances.end());
  EXPECT_LT(distances[40'000], 0.6745 * noise);
}

TEST(TeapotScan, SeesNothingInsideTheBody) {
  // Radius of the body by height, from its upper and lower patch at y = 0.
  const BezierPatches patches = read_bezier_patches(examples / "teapot_patches.txt");
  std::vector<Vec3> profile;
  for (const std::size_t patch : {4u, 8u})
    for (std::uint32_t i = 0; i <= 256; ++i) profile.push_back(bezier_position(patches, patch, i, 0, 256));
  const auto radius_at = [&](double z) {
    return std::min_element(profile.begin(), profile.end(),
                            [z](const Vec3& a, const Vec3& b) { return std::abs(a.z - z) < std::abs(b.z - z); })
        ->x;
  };
  const PointCloud cloud = teapot_scan(true);
  const Attribute& outlier = *find_attribute(cloud.attributes, "outlier");
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const Vec3 p = cloud.points[i];
    if (attribute_value(outlier, i) != 0 || p.z < 0.2 || p.z > 2.35) continue; // between bottom and rim
    EXPECT_GT(std::hypot(p.x, p.y), radius_at(p.z) - 0.03);
  }
}

} // namespace
} // namespace eigencrust::tools
