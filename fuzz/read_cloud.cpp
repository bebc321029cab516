// SPDX-License-Identifier: GPL-3.0-or-later
// Any bytes are either read or refused with an Error. The environment variable EIGENCRUST_FUZZ_FORMAT is
// the extension of the file that they are taken for.
#include <zlib.h>

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string>

#include <eigencrust/error.h>

#include "io/crc32c.h"
#include "io/formats.h"

namespace {

using namespace eigencrust;

void require(bool condition) {
  if (!condition) std::abort();
}

void check(const PointCloud& cloud) {
  for (const Attribute& attribute : cloud.attributes) require(attribute.rows() == cloud.points.size());
  require(cloud.scan_index.empty() || cloud.scan_index.size() == cloud.points.size());
  require(cloud.sensor_of.empty() || cloud.sensor_of.size() == cloud.points.size());
  for (const std::uint32_t sensor : cloud.sensor_of)
    require(sensor == PointCloud::no_sensor || sensor < cloud.sensors.size());
  for (const Sensor& sensor : cloud.sensors) require(is_finite(sensor.place));
}

/// Makes the checksums of the stored members right.
void repair_zip(std::string& bytes) {
  constexpr std::size_t entry = 46, local = 30;
  if (!bytes.starts_with("PK")) return;
  const auto number = [&](std::size_t at, std::size_t size) {
    std::uint64_t value = 0;
    std::memcpy(&value, bytes.data() + at, size);
    return value;
  };
  for (std::size_t at = 0; (at = bytes.find("PK\1\2", at)) != std::string::npos && at + entry <= bytes.size(); ++at) {
    const std::uint64_t method = number(at + 10, 2), size = number(at + 20, 4), header = number(at + 42, 4);
    if (method != 0 || header + local > bytes.size()) continue;
    const std::uint64_t begin = header + local + number(header + 26, 2) + number(header + 28, 2);
    if (begin > bytes.size() || size > bytes.size() - begin) continue;
    const auto crc = static_cast<std::uint32_t>(crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()) + begin, size));
    std::memcpy(bytes.data() + at + 16, &crc, 4);
  }
}

/// Makes length and checksums right: the fuzzer would hardly ever get past them.
void repair_e57(std::string& bytes) {
  constexpr std::size_t page = 1024, content = 1020;
  if (bytes.size() < 48 || !bytes.starts_with("ASTM-E57")) return;
  bytes.resize((bytes.size() + page - 1) / page * page);
  const std::uint64_t length = bytes.size(), page_size = page;
  std::memcpy(bytes.data() + 16, &length, 8);
  std::memcpy(bytes.data() + 40, &page_size, 8);
  for (std::size_t begin = 0; begin < bytes.size(); begin += page) {
    const std::uint32_t crc = io::crc32c(std::string_view(bytes).substr(begin, content));
    for (std::size_t k = 0; k < 4; ++k) bytes[begin + content + k] = static_cast<char>(crc >> (24 - 8 * k) & 0xff);
  }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const char* const extension = std::getenv("EIGENCRUST_FUZZ_FORMAT");
  std::string bytes(reinterpret_cast<const char*>(data), size);
  repair_e57(bytes);
  repair_zip(bytes);
  const io::FileContent file(std::string("input") + (extension == nullptr ? "" : std::string(".") + extension), bytes);
  for (const PcdViewpoint mode : {PcdViewpoint::automatic, PcdViewpoint::pose}) {
    ReadOptions options;
    options.pcd_viewpoint = mode;
    try {
      ReadNotes notes;
      check(io::read_cloud(file, options, notes));
    } catch (const Error& error) {
      require(error.kind() == ErrorKind::input && !error.place().empty() && !error.remedy().empty());
    }
    if (!std::string_view(file.name()).ends_with(".pcd")) break;
  }
  try {
    MeshNotes notes;
    const TriangleMesh mesh = io::read_mesh(file, notes);
    for (const auto& triangle : mesh.triangles)
      for (const std::uint32_t vertex : triangle) require(vertex < mesh.vertices.size());
  } catch (const Error&) {
  }
  return 0;
}
