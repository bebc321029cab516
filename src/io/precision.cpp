// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/precision.h"

#include <algorithm>
#include <bit>

namespace eigencrust::io {
namespace {

using FloatKey = std::array<std::uint32_t, 3>;

/// Equal for equal floats; a total order, unlike that of floats with NaN.
FloatKey key(const Vec3& p) {
  const auto bits = [](double v) {
    const auto f = static_cast<float>(v);
    return f == 0 ? 0u : std::bit_cast<std::uint32_t>(f);
  };
  return {bits(p.x), bits(p.y), bits(p.z)};
}

} // namespace

double median_edge(const TriangleMesh& mesh) {
  std::vector<double> lengths;
  lengths.reserve(3 * mesh.triangles.size());
  for (const auto& triangle : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const double length = distance(mesh.vertices[triangle[k]], mesh.vertices[triangle[(k + 1) % 3]]);
      if (std::isfinite(length)) lengths.push_back(length);
    }
  if (lengths.empty()) return 0;
  const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
  std::nth_element(lengths.begin(), middle, lengths.end());
  return *middle;
}

double rounding_error(std::span<const Vec3> points, const Vec3& offset) {
  double largest = 0;
  for (const Vec3& p : points) {
    if (!is_finite(p)) continue;
    const Vec3 q = p - offset;
    const Vec3 moved{static_cast<double>(static_cast<float>(q.x)) - q.x,
                     static_cast<double>(static_cast<float>(q.y)) - q.y,
                     static_cast<double>(static_cast<float>(q.z)) - q.z};
    largest = std::max(largest, norm(moved));
  }
  return largest;
}

bool distinct_as_float(std::span<const Vec3> points, const Vec3& offset) {
  struct Entry {
    FloatKey key;
    std::size_t point;
  };
  std::vector<Entry> entries(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) entries[i] = {key(points[i] - offset), i};
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.key < b.key; });
  for (std::size_t i = 1; i < entries.size(); ++i) {
    const Vec3 &a = points[entries[i - 1].point], &b = points[entries[i].point];
    if (entries[i - 1].key == entries[i].key && is_finite(a) && is_finite(b) && !(a == b)) return false;
  }
  return true;
}

CoordinateType choose_coordinates(std::span<const Vec3> points, double spacing, const WriteOptions& options) {
  if (options.coordinates != CoordinateType::automatic) return options.coordinates;
  const double moved = rounding_error(points);
  if (moved == 0) return CoordinateType::float32;
  return moved <= allowed_rounding * spacing && distinct_as_float(points) ? CoordinateType::float32
                                                                          : CoordinateType::float64;
}

} // namespace eigencrust::io
