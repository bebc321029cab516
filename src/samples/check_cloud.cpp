// SPDX-License-Identifier: GPL-3.0-or-later
#include "samples/check_cloud.h"

#include <cmath>

#include <eigencrust/error.h>

namespace eigencrust {
namespace {

void check_sensors(const PointCloud& cloud) {
  if (!cloud.sensor_of.empty() && cloud.sensor_of.size() != cloud.points.size())
    throw Error(ErrorKind::input, "input",
                "the sensor index has " + std::to_string(cloud.sensor_of.size()) + " entries for " +
                    std::to_string(cloud.points.size()) + " points",
                "give one sensor number per point");
  for (const std::uint32_t sensor : cloud.sensor_of)
    if (sensor != PointCloud::no_sensor && sensor >= cloud.sensors.size())
      throw Error(ErrorKind::input, "input",
                  "a point names sensor " + std::to_string(sensor) + " of " + std::to_string(cloud.sensors.size()),
                  "number the sensors from 0, or say no_sensor");
  for (const Sensor& sensor : cloud.sensors) {
    if (!is_finite(sensor.place))
      throw Error(ErrorKind::input, "input", "the place of a sensor is not finite", "give finite coordinates");
    if (sensor.at_infinity && std::abs(norm(sensor.place) - 1) > 1e-6)
      throw Error(ErrorKind::input, "input", "the direction of a sensor at infinity is no unit vector",
                  "divide it by its length");
  }
}

void check_grids(const PointCloud& cloud) {
  if (cloud.cell.empty()) return;
  if (cloud.cell.size() != cloud.points.size())
    throw Error(ErrorKind::input, "input",
                "there are " + std::to_string(cloud.cell.size()) + " cells of grids for " +
                    std::to_string(cloud.points.size()) + " points",
                "give one cell per point");
  for (std::size_t i = 0; i < cloud.cell.size(); ++i) {
    if (cloud.cell[i] == no_index) continue;
    const std::size_t scan = cloud.scan_index.empty() ? 0 : cloud.scan_index[i];
    const ScanGrid grid = scan < cloud.grids.size() ? cloud.grids[scan] : ScanGrid{};
    if (cloud.cell[i] >= std::uint64_t{grid.columns} * grid.rows)
      throw Error(ErrorKind::input, "input", "a point names a cell that its scan's grid does not have",
                  "number the cells from 0, or say no_index");
  }
}

} // namespace

void check_cloud(const PointCloud& cloud) {
  const std::size_t n = cloud.points.size();
  for (const Attribute& attribute : cloud.attributes)
    if (attribute.rows() != n)
      throw Error(ErrorKind::input, "input",
                  "attribute " + attribute.name + " has " + std::to_string(attribute.rows()) + " rows for " +
                      std::to_string(n) + " points",
                  "give one value per point");
  if (!cloud.scan_index.empty() && cloud.scan_index.size() != n)
    throw Error(ErrorKind::input, "input",
                "the scan index has " + std::to_string(cloud.scan_index.size()) + " entries for " + std::to_string(n) +
                    " points",
                "give one scan number per point");
  check_sensors(cloud);
  check_grids(cloud);
}

} // namespace eigencrust
