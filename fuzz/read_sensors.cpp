// SPDX-License-Identifier: GPL-3.0-or-later
// The files beside a cloud that tell its sensors: any bytes are either read or refused with an Error. The environment
// variable EIGENCRUST_FUZZ_FORMAT says which kind they are taken for: vis, images.bin, images.txt, sensors.csv,
// index.txt.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string>

#include <eigencrust/error.h>

#include "io/colmap.h"
#include "io/scan_files.h"

namespace {

using namespace eigencrust;

void require(bool condition) {
  if (!condition) std::abort();
}

/// A few points of three scans.
PointCloud cloud_of(std::size_t points) {
  PointCloud cloud;
  for (std::size_t i = 0; i < points; ++i) {
    cloud.points.push_back({static_cast<double>(i), static_cast<double>(i * i), 1});
    cloud.scan_index.push_back(static_cast<std::uint32_t>(i % 3));
  }
  return cloud;
}

void read(const std::string& kind, const std::string& bytes) {
  const io::FileContent file("input." + kind, bytes);
  if (kind.starts_with("images")) {
    for (const Vec3& place : io::read_colmap_images(io::FileContent(kind, bytes))) require(is_finite(place));
    return;
  }
  std::uint64_t points = 7;
  // As many points as the file says, as far as that is sensible: else hardly any file would get past the count.
  if (kind == "vis" && bytes.size() >= 8) std::memcpy(&points, bytes.data(), 8);
  if (kind == "index.txt") points = static_cast<std::uint64_t>(std::count(bytes.begin(), bytes.end(), '\n'));
  PointCloud cloud = cloud_of(std::min<std::uint64_t>(points, 1000));
  if (kind == "index.txt") {
    require(io::read_scan_index(file, cloud.points.size()).size() == cloud.points.size());
    return;
  }
  if (kind == "vis")
    io::set_colmap_sensors(cloud, file, {{0, 0, 9}, {5, 5, 5}, {-3, 1, 0}, {0, 0, 1}});
  else
    io::read_scan_sensors(file, cloud);
  require(cloud.sensor_of.size() == cloud.points.size());
  for (const std::uint32_t sensor : cloud.sensor_of)
    require(sensor == PointCloud::no_sensor || sensor < cloud.sensors.size());
  for (const Sensor& sensor : cloud.sensors) require(is_finite(sensor.place));
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const char* const kind = std::getenv("EIGENCRUST_FUZZ_FORMAT");
  try {
    read(kind == nullptr ? "sensors.csv" : kind, std::string(reinterpret_cast<const char*>(data), size));
  } catch (const Error& error) {
    require(error.kind() == ErrorKind::input && !error.place().empty() && !error.remedy().empty());
  }
  return 0;
}
