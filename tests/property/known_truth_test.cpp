// SPDX-License-Identifier: GPL-3.0-or-later
// Simulated scans whose truth is known, with their sensors and without. The figures are printed.
#include <eigencrust/eigencrust.h>
#include <eigencrust/io.h>
#include <eigencrust/metrics.h>
#include <eigencrust/validate.h>
#include <gmock/gmock.h>

#include <cstring>
#include <iostream>

#include "io/npy.h"
#include "io/zip.h"
#include "support.h"

namespace eigencrust {
namespace {

PointCloud without_sensors(PointCloud cloud) {
  cloud.sensors.clear();
  cloud.sensor_of.clear();
  return cloud;
}

/// Query points and whether they are inside, as bits from the highest on.
struct Occupancy {
  std::vector<Vec3> points;
  std::vector<std::uint8_t> bits;

  explicit Occupancy(const std::filesystem::path& path) {
    const io::FileContent file(path);
    std::uint64_t budget = io::zip_budget(file.bytes().size());
    for (const io::ZipMember& member : io::read_zip_directory(file)) {
      const std::string bytes = io::unpack_zip_member(file, member, budget);
      const io::NpyArray array(file, bytes, member.name);
      if (member.name == "points.npy") points = array.points();
      if (member.name != "occupancies.npy") continue;
      const Attribute column = array.column(0, "bits");
      bits.resize(column.values.size());
      std::memcpy(bits.data(), column.values.data(), bits.size());
    }
  }
  [[nodiscard]] double iou(const TriangleMesh& mesh) const {
    const TriangleTree tree(mesh);
    const Vec3 direction{0.5377, 0.3331, 0.7745}; // along no edge
    std::uint64_t both = 0, either = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      bool inside = false;
      Vec3 at = points[i];
      for (int hits = 0; hits < 1000; ++hits) {
        const TriangleTree::Hit hit = tree.first_hit(at, direction);
        if (!hit.valid()) break;
        inside = !inside;
        at = at + (hit.distance * (1 + 1e-12) + 1e-9) * direction;
      }
      const bool truly = (bits[i / 8] >> (7 - i % 8) & 1) != 0;
      both += inside && truly;
      either += inside || truly;
    }
    return static_cast<double>(both) / static_cast<double>(either);
  }
};

TEST(KnownTruth, BenchmarkScans) {
  double with_sum = 0, without_sum = 0;
  for (const std::string name : {"anchor", "lordquas", "gargoyle"}) {
    const auto scan = data_path("reconbench/" + name + "_mvs_sensors.ply"),
               truth = data_path("reconbench/" + name + "_points.npz");
    EIGENCRUST_NEED_DATA(scan);
    EIGENCRUST_NEED_DATA(truth);
    const Occupancy occupancy(truth);
    ASSERT_EQ(occupancy.points.size(), 100000u);
    ASSERT_EQ(occupancy.bits.size(), 12500u);
    const PointCloud cloud = read_point_cloud(scan);
    ASSERT_EQ(cloud.sensor_of.size(), 3000u);
    const double with = occupancy.iou(reconstruct(cloud).mesh),
                 without = occupancy.iou(reconstruct(without_sensors(cloud)).mesh);
    std::cout << name << ": IoU with sensors " << with << ", without " << without << "\n";
    EXPECT_GE(with, without - 0.003) << name;
    with_sum += with;
    without_sum += without;
  }
  std::cout << "mean: with sensors " << with_sum / 3 << ", without " << without_sum / 3 << "\n";
  EXPECT_GE(with_sum / 3, 0.90);
  EXPECT_GE(without_sum / 3, 0.885);
}

TEST(KnownTruth, ScanTheBunny) {
  const auto truth_file = data_path("scan_the_bunny/bunny1.obj");
  EIGENCRUST_NEED_DATA(truth_file);
  const TriangleMesh truth = merge_equal_vertices(read_mesh(truth_file));
  for (const std::string name : {"pointcloud_sensors", "pointcloud_mvs_sensors"}) {
    const auto scan = data_path("scan_the_bunny/" + name + ".ply");
    EIGENCRUST_NEED_DATA(scan);
    const PointCloud cloud = read_point_cloud(scan);
    ASSERT_EQ(cloud.sensor_of.size(), cloud.points.size());
    const double with = volume_iou(reconstruct(cloud).mesh, truth),
                 without = volume_iou(reconstruct(without_sensors(cloud)).mesh, truth);
    std::cout << name << ": IoU with sensors " << with << ", without " << without << "\n";
    EXPECT_GE(with, without) << name;
  }
}

} // namespace
} // namespace eigencrust
