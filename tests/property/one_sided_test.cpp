// SPDX-License-Identifier: GPL-3.0-or-later
// Scans from one side: what is kept was seen, and what was invented is told.
#include <eigencrust/eigencrust.h>
#include <eigencrust/io.h>
#include <eigencrust/stages.h>
#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <map>
#include <numeric>
#include <sstream>

#include "parallel/threads.h"
#include "samples/sample_model.h"
#include "support.h"

namespace eigencrust {
namespace {

/// The castle with the camera nearest to the mean direction of those that saw a point.
PointCloud castle() {
  PointCloud cloud;
  std::ifstream cameras(data_path("castle/cameras.txt")), points(data_path("castle/points_vis.txt"));
  for (std::string line; std::getline(cameras, line);) {
    std::istringstream words(line);
    int index = 0;
    Vec3 p;
    if (words >> index >> p.x >> p.y >> p.z) cloud.sensors.push_back({p, false});
  }
  for (std::string line; std::getline(points, line);) {
    std::istringstream words(line);
    Vec3 p, mean;
    std::size_t views = 0, camera = 0;
    if (!(words >> p.x >> p.y >> p.z >> views)) continue;
    std::vector<std::uint32_t> seen_by;
    const auto direction = [&](std::uint32_t c) {
      const Vec3 way = cloud.sensors[c].place - p;
      return (1 / norm(way)) * way;
    };
    while (words >> camera) {
      seen_by.push_back(static_cast<std::uint32_t>(camera));
      mean = mean + direction(seen_by.back());
    }
    cloud.points.push_back(p);
    cloud.sensor_of.push_back(*std::max_element(seen_by.begin(), seen_by.end(), [&](auto a, auto b) {
      return dot(direction(a), mean) < dot(direction(b), mean);
    }));
  }
  return cloud;
}

PointCloud kinect(const std::filesystem::path& file) {
  PointCloud cloud = read_point_cloud(file);
  cloud.sensors = {{{0, 0, 0}, false}};
  cloud.sensor_of.assign(cloud.points.size(), 0);
  return cloud;
}

std::vector<std::uint32_t> rows_of_vertices(const Result& result) {
  const Attribute& source = *find_attribute(result.mesh.vertex_attributes, "source_index");
  std::vector<std::uint32_t> row(result.mesh.vertices.size());
  for (std::uint32_t v = 0; v < row.size(); ++v) row[v] = static_cast<std::uint32_t>(attribute_value(source, v));
  return row;
}

/// No triangle, between the samples that are its vertices, has an edge longer than 10 local spacings.
void expect_no_wide_triangles(const Result& result, const PointCloud& cloud) {
  const Samples samples = prepare_samples(cloud.points, Threads(2));
  const SampleModel model = sample_model(samples.positions.raw(), std::nullopt, Threads(2));
  std::vector<double> spacing(cloud.points.size(), 0);
  for (std::uint32_t s = 0; s < samples.source.size(); ++s)
    spacing[samples.source.raw()[s]] = static_cast<double>(model.spacing[SampleIndex{s}]);
  const std::vector<std::uint32_t> row = rows_of_vertices(result);
  std::size_t wide = 0;
  for (const auto& triangle : result.mesh.triangles) {
    double longest = 0, local = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < 3; ++k) {
      longest = std::max(longest, distance(cloud.points[row[triangle[k]]], cloud.points[row[triangle[(k + 1) % 3]]]));
      local = std::min(local, spacing[row[triangle[k]]]);
    }
    wide += longest > 10 * local;
  }
  EXPECT_EQ(wide, 0u);
}

/// Every triangle, between the samples that are its vertices, has been seen by their sensors and has no long edge.
void expect_seen(const Result& result, const PointCloud& cloud) {
  expect_no_wide_triangles(result, cloud);
  const std::vector<std::uint32_t> row = rows_of_vertices(result);
  std::size_t flat = 0;
  for (const auto& triangle : result.mesh.triangles) {
    std::array<Vec3, 3> p;
    for (std::size_t k = 0; k < 3; ++k) p[k] = cloud.points[row[triangle[k]]];
    const Vec3 normal = cross(p[1] - p[0], p[2] - p[0]);
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 way = cloud.sensors[cloud.sensor_of[row[triangle[k]]]].place - p[k];
      flat += dot(way, normal) < std::cos(85.001 * 3.141592653589793 / 180) * norm(way) * norm(normal);
    }
  }
  // Samples with a duplicate may have been seen by the sensor of another row.
  EXPECT_LE(flat, prepare_samples(cloud.points, Threads(2)).duplicates / 20);
  testing::Test::RecordProperty("flat", static_cast<int>(flat));
}

void expect_trimmed(const PointCloud& cloud, double least_kept) {
  Options options;
  const Result closed = reconstruct(cloud, options);
  EXPECT_TRUE(closed.report.mesh.closed());
  EXPECT_TRUE(closed.report.one_sided.has_value());
  EXPECT_GT(closed.report.unsupported_area, 0.3);
  EXPECT_THAT(closed.report.warnings, testing::Contains(testing::HasSubstr("invented")));
  options.trim = true;
  const Result open = reconstruct(cloud, options);
  EXPECT_THAT(open.report.broken_guarantees, testing::IsEmpty());
  EXPECT_GT(open.report.mesh.boundary_loops, 0u);
  EXPECT_TRUE(open.report.mesh.manifold() && open.report.mesh.oriented());
  EXPECT_THAT(open.report.warnings, testing::Not(testing::Contains(testing::HasSubstr("invented"))));
  EXPECT_GT(static_cast<double>(open.mesh.vertices.size()),
            least_kept * static_cast<double>(closed.mesh.vertices.size()));
  expect_seen(open, cloud);
}

TEST(OneSided, CastleFacadeIsTrimmedToWhatWasSeen) {
  EIGENCRUST_NEED_DATA(data_path("castle/points_vis.txt"));
  EIGENCRUST_NEED_DATA(data_path("castle/cameras.txt"));
  expect_trimmed(castle(), 0.95);
}

// As rows without their grid, which tells more (below).
TEST(OneSided, RangeImageIsTrimmedToWhatWasSeen) {
  const auto file = data_path("range_images/capture0001.pcd");
  EIGENCRUST_NEED_DATA(file);
  PointCloud cloud = kinect(file);
  cloud.grids.clear();
  cloud.cell.clear();
  expect_trimmed(cloud, 0.95);
}

/// The share of a frame's pixels with returns that are vertices, and of edges at holes that nothing explains: whose
/// pixels have returns all around, without a jump, over the triangles.
void expect_whole(const Result& result, const PointCloud& cloud, std::int64_t columns, std::int64_t rows) {
  const Attribute& source = *find_attribute(result.mesh.vertex_attributes, "source_index");
  const auto row_of = [&](std::uint32_t v) { return static_cast<std::int64_t>(attribute_value(source, v)); };
  const auto depth = [&](std::int64_t row) { return std::fabs(cloud.points[static_cast<std::size_t>(row)].z); };
  constexpr double focal = 525, jump = 10; // pixels
  const auto is_jump = [&](std::int64_t a, std::int64_t b) {
    return std::fabs(depth(a) - depth(b)) > jump * std::min(depth(a), depth(b)) / focal;
  };
  const auto is_amid = [&](std::int64_t row) {
    const std::int64_t c = row % columns, r = row / columns;
    for (const std::int64_t i : {r - 1, r, r + 1})
      for (const std::int64_t j : {c - 1, c, c + 1})
        if (i < 0 || j < 0 || i >= rows || j >= columns || !(depth(i * columns + j) > 0) ||
            is_jump(row, i * columns + j))
          return false;
    return true;
  };
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> sides;
  std::size_t across = 0;
  for (const auto& t : result.mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      ++sides[std::minmax(t[k], t[(k + 1) % 3])];
      // Three pixels apart a slope may be steeper than a jump between neighbours.
      across += std::fabs(depth(row_of(t[k])) - depth(row_of(t[(k + 1) % 3]))) >
                45 * std::min(depth(row_of(t[k])), depth(row_of(t[(k + 1) % 3]))) / focal;
    }
  std::size_t unexplained = 0;
  for (const auto& [edge, count] : sides)
    unexplained += count == 1 && is_amid(row_of(edge.first)) && is_amid(row_of(edge.second));
  const auto returns =
      std::count_if(cloud.points.begin(), cloud.points.end(), [](const Vec3& p) { return is_finite(p); });
  EXPECT_LE(static_cast<double>(unexplained), 0.03 * static_cast<double>(result.mesh.triangles.size()));
  EXPECT_GE(static_cast<double>(result.mesh.vertices.size()), 0.95 * static_cast<double>(returns));
  EXPECT_EQ(across, 0u);
}

TEST(OneSided, AGridLeavesNoHolesInARangeImage) {
  for (const char* name : {"range_images/capture0001.pcd", "range_images/milk_cartoon_all_small_clorox.pcd"}) {
    const auto file = data_path(name);
    EIGENCRUST_NEED_DATA(file);
    PointCloud cloud = kinect(file);
    cloud.grids = {{640, 480}};
    cloud.cell.resize(cloud.points.size());
    std::iota(cloud.cell.begin(), cloud.cell.end(), 0u);
    Options options;
    options.trim = true;
    const Result result = reconstruct(cloud, options);
    EXPECT_TRUE(result.report.mesh.manifold() && result.report.mesh.oriented());
    expect_whole(result, cloud, 640, 480);
    expect_no_wide_triangles(result, cloud);
  }
}

TEST(OneSided, AScanFromAroundIsNot) {
  const auto file = data_path("ignatius/ignatius_99_sensors.ply");
  EIGENCRUST_NEED_DATA(file);
  EXPECT_FALSE(reconstruct(read_point_cloud(file)).report.one_sided.has_value());
}

} // namespace
} // namespace eigencrust
