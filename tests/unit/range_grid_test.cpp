// SPDX-License-Identifier: GPL-3.0-or-later
#include "surface/range_grid.h"

#include <eigencrust/error.h>
#include <gmock/gmock.h>

#include "clouds.h"
#include "io/grid_sensor.h"
#include "samples/check_cloud.h"

namespace eigencrust {
namespace {

constexpr std::uint32_t columns = 24, rows = 18;
constexpr double pixel = 0.01;

/// A frame of a depth camera at the origin that looks along z.
template <class Depth>
PointCloud frame_of(Depth&& depth) {
  PointCloud cloud;
  cloud.grids = {{columns, rows}};
  for (std::uint32_t r = 0; r < rows; ++r)
    for (std::uint32_t c = 0; c < columns; ++c) {
      const double z = depth(c, r);
      cloud.points.push_back({(c - 11.5) * pixel * z, (r - 8.5) * pixel * z, z});
      cloud.cell.push_back(r * columns + c);
    }
  return cloud;
}

/// A bump before a plane: the range jumps around it.
PointCloud bump() {
  return frame_of([](std::uint32_t c, std::uint32_t r) {
    return c > 6 && c < 16 && r > 4 && r < 13 ? 1 + 0.002 * c : 2 + 0.01 * r;
  });
}

struct Grid {
  PointCloud cloud = bump();
  clouds::Prepared p;
  RangeGrid grid;
  Grid() {
    cloud.sensors = {{{0, 0, 0}, false}};
    cloud.sensor_of.assign(cloud.points.size(), 0);
    p = clouds::prepare(cloud.points);
    const auto lines = sight_lines(cloud, p.sample_of_row, p.t, std::vector<float>(p.t.sample_count, 0), {});
    grid = RangeGrid(cloud, p.sample_of_row, p.t, lines);
  }
  [[nodiscard]] SampleIndex at(std::uint32_t c, std::uint32_t r) const { return p.sample_of_row[r * columns + c]; }
};

TEST(RangeGrid, NeighboursMakeASurfaceUnlessTheRangeJumps) {
  const Grid g;
  EXPECT_EQ(g.grid.between({g.at(1, 1), g.at(2, 1), g.at(1, 2)}), Between::surface);
  EXPECT_EQ(g.grid.between({g.at(8, 8), g.at(10, 9), g.at(9, 11)}), Between::surface);
  EXPECT_EQ(g.grid.between({g.at(5, 8), g.at(6, 8), g.at(7, 8)}), Between::jump);    // onto the bump
  EXPECT_EQ(g.grid.between({g.at(1, 1), g.at(2, 1), g.at(9, 1)}), Between::unknown); // too far apart
}

TEST(RangeGrid, KnowsNothingWithoutCellsOrSensors) {
  Grid g;
  EXPECT_FALSE(g.grid.empty());
  EXPECT_TRUE(RangeGrid().empty());
  EXPECT_TRUE(RangeGrid(clouds::cloud_of(g.cloud.points), g.p.sample_of_row, g.p.t, {}).empty());
  EXPECT_EQ(RangeGrid(g.cloud, g.p.sample_of_row, g.p.t, {}).between({g.at(1, 1), g.at(2, 1), g.at(1, 2)}),
            Between::unknown);
}

TEST(RangeGrid, CellsAreChecked) {
  PointCloud cloud = bump();
  EXPECT_NO_THROW(check_cloud(cloud));
  cloud.cell[3] = no_index;
  EXPECT_NO_THROW(check_cloud(cloud));
  cloud.cell[3] = columns * rows;
  EXPECT_THROW(check_cloud(cloud), Error);
  cloud.cell.pop_back();
  EXPECT_THROW(check_cloud(cloud), Error);
}

TEST(GridSensor, IsAtTheOriginOfAFramesRays) {
  PointCloud cloud = bump();
  cloud.points[5] = {NAN, NAN, NAN}; // no return
  EXPECT_TRUE(io::set_sensor_from_grid(cloud));
  ASSERT_EQ(cloud.sensors.size(), 1u);
  EXPECT_EQ(cloud.sensors[0], (Sensor{{0, 0, 0}, false}));
  EXPECT_EQ(cloud.sensor_of.size(), cloud.points.size());
}

TEST(GridSensor, IsNotReadIntoOtherGrids) {
  PointCloud heights = frame_of([](std::uint32_t, std::uint32_t) { return 1.0; });
  EXPECT_FALSE(io::set_sensor_from_grid(heights)); // a plane: parallel rays fit as well
  for (std::size_t i = 0; i < heights.points.size(); ++i) heights.points[i].z += 0.1 * static_cast<double>(i % 7);
  EXPECT_FALSE(io::set_sensor_from_grid(heights)); // a height for each place of a map
  PointCloud known = bump();
  known.sensors = {{{1, 2, 3}, false}};
  known.sensor_of.assign(known.points.size(), 0);
  EXPECT_FALSE(io::set_sensor_from_grid(known));
  PointCloud loose = clouds::cloud_of(bump().points);
  EXPECT_FALSE(io::set_sensor_from_grid(loose));
}

} // namespace
} // namespace eigencrust
