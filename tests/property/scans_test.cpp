// SPDX-License-Identifier: GPL-3.0-or-later
// Real data; each test is skipped where the data are absent.
#include <eigencrust/eigencrust.h>
#include <eigencrust/io.h>
#include <gmock/gmock.h>

#include "support.h"

namespace eigencrust {
namespace {

void expect_sound(const Result& result) {
  EXPECT_THAT(result.report.broken_guarantees, testing::IsEmpty());
  EXPECT_TRUE(result.report.mesh.closed());
  EXPECT_TRUE(result.report.mesh.manifold());
  EXPECT_TRUE(result.report.mesh.oriented());
  EXPECT_EQ(result.report.mesh.self_intersections, 0);
  EXPECT_GT(result.report.mesh.volume, 0);
}

TEST(Scans, RawBunnyIsOneBodyWithoutHandles) {
  const auto file = data_path("bunny/bunny_raw.ply"), index = data_path("bunny/scan_index.u8");
  EIGENCRUST_NEED_DATA(file);
  EIGENCRUST_NEED_DATA(index);
  PointCloud cloud = read_point_cloud(file);
  cloud.scan_index = read_scan_index(index, cloud.points.size());
  const Result result = reconstruct(cloud);
  expect_sound(result);
  EXPECT_EQ(result.report.points, 362272u);
  EXPECT_NEAR(result.report.grid_spacing, 0.7e-3, 0.1e-3); // ℓ of its grid
  ASSERT_FALSE(result.report.mesh.component_list.empty());
  EXPECT_EQ(result.report.mesh.component_list[0].genus, 0);
  EXPECT_GT(result.report.mesh.component_list[0].vertices, 100000u);
  EXPECT_NEAR(result.report.mesh.volume, 7.5e-4, 0.5e-4); // cubic metres: about 0.75 litres
}

TEST(Scans, VerticesOfACleanMeshGiveItBack) {
  const auto file = data_path("meshes/horse.ply");
  EIGENCRUST_NEED_DATA(file);
  const TriangleMesh truth = read_mesh(file);
  const Result result = reconstruct(read_point_cloud(file));
  expect_sound(result);
  EXPECT_EQ(result.report.mesh.component_list[0].genus, 0);
  const double volume = std::fabs(validate(truth, {.self_intersections = false}).volume); // stored inward
  EXPECT_NEAR(result.report.mesh.volume / volume, 1, 0.01);
  EXPECT_GT(result.report.mesh.vertices, 0.97 * 48485);
}

TEST(Scans, SmallClassicsAreSound) {
  for (const char* name :
       {"classics/hotdogs.xyz", "classics/hotdogs.pts", "classics/knot.pts", "classics/cactus.pts"}) {
    const auto file = data_path(name);
    if (!std::filesystem::exists(file)) continue;
    SCOPED_TRACE(name);
    PointCloud cloud;
    if (!error_of([&] { cloud = read_point_cloud(file); }).empty()) continue; // a format of its own
    for (const Preset preset : {Preset::robust, Preset::paper}) {
      const Result result = reconstruct(cloud, Options::of(preset));
      EXPECT_THAT(result.report.broken_guarantees, testing::IsEmpty());
    }
  }
}

} // namespace
} // namespace eigencrust
