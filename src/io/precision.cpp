// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/precision.h"

#include <algorithm>
#include <bit>

#include <eigencrust/error.h>

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

Vec3 offset_for_float(const TriangleMesh& mesh, double spacing, const std::string& format,
                      std::vector<std::string>& warnings) {
  const double moved = rounding_error(mesh.vertices);
  if (moved == 0) return {};
  const double allowed = allowed_rounding * (spacing > 0 ? spacing : median_edge(mesh));
  if (moved <= allowed && distinct_as_float(mesh.vertices)) return {};
  Box3 box;
  for (const Vec3& p : mesh.vertices)
    if (is_finite(p)) box.add(p);
  const Vec3 offset = box.centre();
  if (!distinct_as_float(mesh.vertices, offset))
    throw Error(ErrorKind::guarantee, format,
                "the 32-bit coordinates of " + format + " would make different vertices equal",
                "write PLY, OBJ or OFF");
  if (rounding_error(mesh.vertices, offset) > allowed)
    warnings.emplace_back("rounding to 32 bits moves vertices by more than 1/1000 of the spacing");
  return offset;
}

void require_finite(const TriangleMesh& mesh, const std::string& format) {
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    if (!is_finite(mesh.vertices[v]))
      throw Error(ErrorKind::input, format,
                  "vertex " + std::to_string(v) + " is not finite, which " + format + " cannot hold", "write PLY");
}

CoordinateType choose_coordinates(std::span<const Vec3> points, double spacing, const WriteOptions& options) {
  if (options.coordinates != CoordinateType::automatic) return options.coordinates;
  const double moved = rounding_error(points);
  if (moved == 0) return CoordinateType::float32;
  return moved <= allowed_rounding * spacing && distinct_as_float(points) ? CoordinateType::float32
                                                                          : CoordinateType::float64;
}

} // namespace eigencrust::io
