// SPDX-License-Identifier: GPL-3.0-or-later
#include <eigencrust/memory_forecast.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <string_view>

#include <eigencrust/error.h>

namespace eigencrust {
namespace {

// Measured, see docs/decisions/0018-memory-forecast.md; to be changed here alone.
constexpr double bytes_of_the_program = 12e6;
constexpr double bytes_per_point = 1050; ///< distinct ones, coordinates included
constexpr double bytes_per_other = 60;   ///< rows that are no sample of their own
// Of all stages, per tetrahedron: seven of them for a point.
constexpr double bytes_per_tetrahedron = bytes_per_point / 7;
constexpr double copies_of_further = 2; ///< attributes of the cloud and of the mesh
constexpr double seconds_per_point = 1.7e-5;

constexpr std::uint64_t unknown = std::numeric_limits<std::uint64_t>::max();

std::uint64_t whole(double bytes) {
  return bytes < 9e18 ? static_cast<std::uint64_t>(bytes) : std::uint64_t{9'000'000'000'000'000'000};
}

/// The number a file begins with; unknown without one ("max", or no file).
std::uint64_t first_number(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::uint64_t value = 0;
  return file >> value ? value : unknown;
}

/// Of /proc/meminfo, in bytes.
std::uint64_t spare_memory(const std::filesystem::path& root) {
  std::ifstream file(root / "proc/meminfo");
  std::uint64_t kilobytes = 0;
  for (std::string word; file >> word;)
    if (word == "MemAvailable:" && file >> kilobytes) return kilobytes * 1024;
  return unknown;
}

/// What the process holds, in bytes; 0 if not known.
std::uint64_t resident_memory(const std::filesystem::path& root) {
  std::ifstream file(root / "proc/self/status");
  std::uint64_t kilobytes = 0;
  for (std::string word; file >> word;)
    if (word == "VmRSS:" && file >> kilobytes) return kilobytes * 1024;
  return 0;
}

/// The least of the limits of a group and of those it lies in. A container may see its own group as the topmost
/// one whatever path it is told, so folders that are not there are passed over.
std::uint64_t least_limit(const std::filesystem::path& top, std::filesystem::path group, const char* file) {
  std::uint64_t least = first_number(top / file);
  group = group.relative_path();
  while (!group.empty()) {
    least = std::min(least, first_number(top / group / file));
    group = group.parent_path();
  }
  return least;
}

/// Lines of /proc/self/cgroup are NUMBER:CONTROLLERS:PATH, version 2 with 0 and no controllers.
std::uint64_t group_limit(const std::filesystem::path& root) {
  const std::filesystem::path top = root / "sys/fs/cgroup";
  std::uint64_t least =
      std::min(least_limit(top, "", "memory.max"), least_limit(top / "memory", "", "memory.limit_in_bytes"));
  std::ifstream file(root / "proc/self/cgroup");
  for (std::string line; std::getline(file, line);) {
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1), path = line.substr(second + 1);
    if (controllers.empty()) least = std::min(least, least_limit(top, path, "memory.max"));
    if (("," + controllers + ",").find(",memory,") != std::string::npos)
      least = std::min(least, least_limit(top / "memory", path, "memory.limit_in_bytes"));
  }
  return least;
}

/// Mixes the bits of a point's coordinates (the finalizer of MurmurHash3 by Appleby, public domain).
std::uint64_t hash_of(const Vec3& p) {
  std::uint64_t hash = 0;
  for (const double c : {p.x, p.y, p.z}) {
    hash ^= std::bit_cast<std::uint64_t>(c + 0.0); // -0 is 0
    hash = (hash ^ (hash >> 33)) * 0xff51afd7ed558ccdULL;
    hash = (hash ^ (hash >> 33)) * 0xc4ceb9fe1a85ec53ULL;
    hash ^= hash >> 33;
  }
  return hash;
}

/// About how many rows have finite coordinates that no row before has. Rows are looked at whose hash is small, so that
/// of equal ones either all or none are.
double distinct_points(const std::vector<Vec3>& points) {
  constexpr std::size_t enough = 1 << 16;
  const std::uint64_t every = std::max<std::uint64_t>(1, points.size() / enough);
  std::vector<std::uint64_t> seen;
  std::uint64_t finite = 0;
  for (const Vec3& p : points) {
    if (!is_finite(p)) continue;
    ++finite;
    if (const std::uint64_t hash = hash_of(p); hash % every == 0) seen.push_back(hash);
  }
  if (seen.empty()) return static_cast<double>(finite);
  const auto looked_at = static_cast<double>(seen.size());
  std::sort(seen.begin(), seen.end());
  const auto distinct = static_cast<double>(std::unique(seen.begin(), seen.end()) - seen.begin());
  return distinct / looked_at * static_cast<double>(finite);
}

/// How many points without attributes fit.
std::uint64_t points_within(std::uint64_t limit, double further_per_point) {
  const double room = static_cast<double>(limit) - bytes_of_the_program;
  return room > 0 ? whole(room / (bytes_per_point + copies_of_further * further_per_point)) : 0;
}

[[noreturn]] void reject_size(const std::string& text) {
  throw Error(ErrorKind::usage, "options", "'" + text + "' is no size of memory", "use 4G, 500M, 1.5Gi or bytes");
}

} // namespace

Forecast forecast(std::uint64_t points, std::uint64_t further) {
  const auto n = static_cast<double>(points);
  return {whole(bytes_of_the_program + bytes_per_point * n + copies_of_further * static_cast<double>(further)),
          seconds_per_point * n};
}

std::uint64_t further_bytes(const PointCloud& cloud) {
  std::uint64_t bytes = (cloud.scan_index.size() + cloud.sensor_of.size()) * sizeof(std::uint32_t);
  bytes += cloud.sensors.size() * sizeof(Sensor);
  for (const Attribute& a : cloud.attributes) bytes += a.values.size() + a.offsets.size() * sizeof(std::uint64_t);
  return bytes;
}

Forecast forecast(const PointCloud& cloud) {
  const double distinct = distinct_points(cloud.points);
  const double others = static_cast<double>(cloud.points.size()) - distinct;
  return {whole(bytes_of_the_program + bytes_per_point * distinct + bytes_per_other * others +
                copies_of_further * static_cast<double>(further_bytes(cloud))),
          seconds_per_point * distinct};
}

void check_memory(const PointCloud& cloud, std::uint64_t limit) {
  const std::uint64_t needed = forecast(cloud).memory_bytes, n = cloud.points.size();
  if (limit == 0 || needed <= limit) return;
  const double further = n > 0 ? static_cast<double>(further_bytes(cloud)) / static_cast<double>(n) : 0;
  throw Error(ErrorKind::memory, "memory",
              "the forecast for " + std::to_string(n) + " points, " + describe_bytes(needed) +
                  ", exceeds the limit of " + describe_bytes(limit),
              "raise --max-memory to " + std::to_string(needed / 1'000'000 + 1) +
                  "M, let a disk take the rest with --temp-dir, or give fewer points, about " +
                  std::to_string(points_within(limit, further)) + " fit");
}

void check_memory_of_tetrahedra(std::uint64_t tetrahedra, std::uint64_t further, std::uint64_t limit) {
  if (limit == 0) return;
  const auto needed = whole(bytes_of_the_program + bytes_per_tetrahedron * static_cast<double>(tetrahedra) +
                            copies_of_further * static_cast<double>(further));
  if (needed <= limit) return;
  throw Error(ErrorKind::memory, "delaunay",
              "the samples have " + std::to_string(tetrahedra) +
                  " tetrahedra already, many more than usual: more than " + describe_bytes(limit) + " are needed",
              "raise --max-memory, or give fewer points; noise or stray points far from the surface can be the reason");
}

std::uint64_t available_memory_bytes(const std::filesystem::path& root) {
  const std::uint64_t spare = spare_memory(root);
  const std::uint64_t least = std::min(spare == unknown ? unknown : spare + resident_memory(root), group_limit(root));
  return least == unknown ? 0 : least;
}

std::string memory_warning(const Forecast& f, std::uint64_t available) {
  if (available == 0 || f.memory_bytes <= available) return {};
  return "the forecast of memory, " + describe_bytes(f.memory_bytes) + ", exceeds the " + describe_bytes(available) +
         " that are available; the system may end the run. Let a disk take the rest (--max-memory and --temp-dir), or "
         "give fewer points";
}

std::uint64_t parse_memory_size(const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed);
  if (error != std::errc{}) reject_size(text);
  std::string_view unit(end, static_cast<std::size_t>(text.data() + text.size() - end));
  if (!unit.empty() && (unit.back() == 'B' || unit.back() == 'b')) unit.remove_suffix(1);
  const bool binary = unit.size() == 2 && unit.back() == 'i';
  if (binary) unit.remove_suffix(1);
  constexpr std::string_view units = "KMGT";
  if (!unit.empty()) {
    const char letter = static_cast<char>(std::toupper(static_cast<unsigned char>(unit.front())));
    const std::size_t power = units.find(letter);
    if (unit.size() != 1 || power == std::string_view::npos) reject_size(text);
    value *= std::pow(binary ? 1024.0 : 1000.0, static_cast<double>(power + 1));
  }
  if (!(value >= 1 && value < 9e18)) reject_size(text);
  return static_cast<std::uint64_t>(value);
}

std::string describe_bytes(std::uint64_t bytes) {
  constexpr std::array<const char*, 5> units{"bytes", "kB", "MB", "GB", "TB"};
  auto value = static_cast<double>(bytes);
  std::size_t unit = 0;
  while (value >= 999.5 && unit + 1 < units.size()) {
    value /= 1000;
    ++unit;
  }
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), value < 9.95 && unit > 0 ? "%.1f %s" : "%.0f %s", value, units[unit]);
  return text.data();
}

} // namespace eigencrust
