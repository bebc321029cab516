// SPDX-License-Identifier: GPL-3.0-or-later
#include "sampling.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <unordered_map>

#include <eigencrust/metrics.h>

#include "counter_random.h"
#include "geometry/nearest.h"
#include "sensors.h"

namespace eigencrust::bench {
namespace {

double area_of(const TriangleMesh& mesh, const std::array<std::uint32_t, 3>& t) {
  const Vec3& a = mesh.vertices[t[0]];
  return 0.5 * norm(cross(mesh.vertices[t[1]] - a, mesh.vertices[t[2]] - a));
}

/// Points in cubes of a grid, to ask whether one is near.
class Grid {
 public:
  explicit Grid(double cell) : cell_(cell) {}

  void add(const Vec3& p) { cubes_[key(cube(p.x), cube(p.y), cube(p.z))].push_back(p); }

  /// Is there a point nearer than radius <= cell?
  [[nodiscard]] bool any_within(const Vec3& p, double radius) const {
    const std::int64_t x = cube(p.x), y = cube(p.y), z = cube(p.z);
    for (std::int64_t i = x - 1; i <= x + 1; ++i)
      for (std::int64_t j = y - 1; j <= y + 1; ++j)
        for (std::int64_t k = z - 1; k <= z + 1; ++k) {
          const auto found = cubes_.find(key(i, j, k));
          if (found == cubes_.end()) continue;
          for (const Vec3& q : found->second)
            if (squared_norm(p - q) < radius * radius) return true;
        }
    return false;
  }

 private:
  [[nodiscard]] std::int64_t cube(double x) const { return static_cast<std::int64_t>(std::floor(x / cell_)); }
  /// 21 bits of each coordinate; two cubes with one key cost time, nothing else.
  static std::uint64_t key(std::int64_t i, std::int64_t j, std::int64_t k) {
    constexpr std::int64_t mask = (1 << 21) - 1;
    return static_cast<std::uint64_t>((i & mask) << 42 | (j & mask) << 21 | (k & mask));
  }

  double cell_;
  std::unordered_map<std::uint64_t, std::vector<Vec3>> cubes_;
};

} // namespace

double median_spacing(std::span<const Vec3> points, unsigned threads) {
  std::vector<Vec3> distinct;
  std::copy_if(points.begin(), points.end(), std::back_inserter(distinct), [](const Vec3& p) { return is_finite(p); });
  std::sort(distinct.begin(), distinct.end());
  distinct.erase(std::unique(distinct.begin(), distinct.end()), distinct.end());
  return summarize(nearest_other(distinct, Threads(threads))).median;
}

std::vector<Vec3> even_samples(const TriangleMesh& mesh, std::size_t count, std::uint64_t seed,
                               const std::function<double(const Vec3&)>& relative_radius) {
  const auto relative = [&](const Vec3& p) { return relative_radius ? relative_radius(p) : 1.0; };
  double weighted_area = 0, area = 0, smallest = relative(mesh.vertices.front()), largest = smallest;
  for (const auto& t : mesh.triangles) {
    const double r = relative(mesh.vertices[t[0]]);
    smallest = std::min(smallest, r);
    largest = std::max(largest, r);
    area += area_of(mesh, t);
    weighted_area += area_of(mesh, t) / (r * r);
  }
  // Eleven darts per sample leave 0.575 samples per squared radius, as measured (infinitely many: 0.70).
  const double radius = std::sqrt(0.575 * weighted_area / static_cast<double>(count));
  const auto darts = static_cast<std::size_t>(6.4 * area / (radius * radius * smallest * smallest));
  std::vector<Vec3> points = sample_surface(mesh, darts, seed);
  const tools::CounterRandom random(seed, 0, 0);
  for (std::size_t i = points.size(); i > 1; --i) // they come in the order of triangles: shuffle
    std::swap(points[i - 1], points[static_cast<std::size_t>(random.uniform(i) * static_cast<double>(i))]);

  Grid grid(1.001 * radius * largest); // the radius at a point inside a triangle may pass that at its corners
  std::erase_if(points, [&](const Vec3& p) {
    if (grid.any_within(p, radius * std::min(relative(p), largest))) return true;
    grid.add(p);
    return false;
  });
  return points;
}

std::vector<Vec3> thinned(std::vector<Vec3> points, double radius) {
  Grid grid(radius);
  std::erase_if(points, [&](const Vec3& p) {
    if (grid.any_within(p, radius)) return true;
    grid.add(p);
    return false;
  });
  return points;
}

std::vector<Vec3> ball_with_sheet_samples(double spacing, std::uint64_t seed) {
  constexpr double half = 1.5, jitter = 0.05, seam = 0.6; // half a side; of the spacing
  // A spiral of n points on the unit sphere has spacing 3.5 / √n.
  const auto count = static_cast<std::uint32_t>(std::lround(3.5 * 3.5 / (spacing * spacing)));
  std::vector<Vec3> points = tools::fibonacci_directions(count);
  std::erase_if(points, [&](const Vec3& p) { return std::fabs(p.y) <= spacing; });
  const auto n = static_cast<std::uint32_t>(std::lround(2 * half / spacing));
  for (std::uint32_t i = 0; i <= n; ++i)
    for (std::uint32_t j = 0; j <= n; ++j)
      for (int k = -1; k <= 1; ++k) {
        const bool rim = i == 0 || j == 0 || i == n || j == n;
        if (k == 0 && !rim) continue;
        const tools::CounterRandom random(seed, static_cast<std::uint64_t>(k + 1), i * std::uint64_t{n + 1} + j);
        const auto moved = [&](std::uint64_t draw) {
          return rim ? 0 : jitter * spacing * (2 * random.uniform(draw) - 1);
        };
        const Vec3 p{-half + 2 * half * i / n + moved(0), k * spacing, -half + 2 * half * j / n + moved(1)};
        if (norm(p) > 1) points.push_back(p);
      }
  return thinned(std::move(points), seam * spacing); // where the two meet
}

std::vector<double> vertex_areas(const TriangleMesh& mesh) {
  std::vector<double> areas(mesh.vertices.size());
  for (const auto& t : mesh.triangles)
    for (const std::uint32_t v : t) areas[v] += area_of(mesh, t) / 3;
  return areas;
}

std::uint64_t fingerprint(std::span<const Vec3> points) {
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const Vec3& p : points)
    for (const double x : {p.x, p.y, p.z})
      for (int byte = 0; byte < 8; ++byte)
        hash = (hash ^ (std::bit_cast<std::uint64_t>(x) >> (8 * byte) & 0xff)) * 0x100000001b3;
  return hash;
}

} // namespace eigencrust::bench
