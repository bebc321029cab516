// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Point clouds whose surface is known, and short ways through the stages, for tests.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <span>
#include <utility>
#include <vector>

#include <eigencrust/stages.h>

namespace eigencrust::clouds {

/// Random numbers that are the same with every standard library.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  /// in [0, 1)
  double uniform() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  std::uint32_t below(std::uint32_t n) { return static_cast<std::uint32_t>(engine_() % n); }
  Vec3 in_box(double half_side) {
    return {uniform(-half_side, half_side), uniform(-half_side, half_side), uniform(-half_side, half_side)};
  }

 private:
  std::mt19937_64 engine_;
};

using Points = std::vector<Vec3>;

inline PointCloud cloud_of(Points points) { return {std::move(points), {}, {}}; }

inline Points joined(Points a, const Points& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// factor · p + shift for every point.
inline Points moved(Points points, const Vec3& shift, double factor = 1) {
  for (Vec3& p : points) p = factor * p + shift;
  return points;
}

inline Points shuffled(Points points, std::uint64_t seed) {
  Random random(seed);
  for (std::size_t i = points.size(); i > 1; --i)
    std::swap(points[i - 1], points[random.below(static_cast<std::uint32_t>(i))]);
  return points;
}

inline Points random_box(std::size_t n, std::uint64_t seed, double half_side = 1) {
  Random random(seed);
  Points points;
  for (std::size_t i = 0; i < n; ++i) points.push_back(random.in_box(half_side));
  return points;
}

/// nx · ny · nz points with that spacing: every cell's eight corners lie on one sphere.
inline Points lattice(unsigned nx, unsigned ny, unsigned nz, double spacing = 1) {
  Points points;
  for (unsigned i = 0; i < nx; ++i)
    for (unsigned j = 0; j < ny; ++j)
      for (unsigned k = 0; k < nz; ++k) points.push_back({i * spacing, j * spacing, k * spacing});
  return points;
}

/// Surface of the cube [0, n]³ at the integer points: 6 n² + 2 of them.
inline Points cube_surface(unsigned n) {
  Points points;
  for (const Vec3& p : lattice(n + 1, n + 1, n + 1))
    if (p.x == 0 || p.y == 0 || p.z == 0 || p.x == n || p.y == n || p.z == n) points.push_back(p);
  return points;
}

/// n points spread evenly over a sphere (Fibonacci lattice); spacing about 3.5 radius / √n.
inline Points sphere(std::size_t n, double radius = 1, const Vec3& centre = {}) {
  Points points;
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
  for (std::size_t i = 0; i < n; ++i) {
    const double z = 1 - (2 * static_cast<double>(i) + 1) / static_cast<double>(n);
    const double r = std::sqrt(1 - z * z), u = golden * static_cast<double>(i);
    points.push_back(radius * Vec3{r * std::cos(u), r * std::sin(u), z} + centre);
  }
  return points;
}

/// One point at random for each unit of a rectangle's area.
inline void cover(const Vec3& corner, const Vec3& u, const Vec3& v, Random& random, Points& points) {
  for (std::size_t k = 0; k < static_cast<std::size_t>(norm(u) * norm(v)); ++k)
    points.push_back(corner + random.uniform() * u + random.uniform() * v);
}

/// A plate with nx times ny windows of 8 by 12, 8 from one another and from the rim; one point at random for each unit
/// of its area.
inline Points plate_with_windows(unsigned nx, unsigned ny, double thickness, std::uint64_t seed) {
  constexpr double bar = 8, width = 8, height = 12;
  const double x_end = bar + nx * (width + bar), y_end = bar + ny * (height + bar);
  Random random(seed);
  Points points;
  const auto rim = [&](double x, double y, double dx, double dy) {
    const Vec3 up{0, 0, thickness};
    for (const double side : {0.0, 1.0}) {
      cover({x, y + side * dy, 0}, {dx, 0, 0}, up, random, points);
      cover({x + side * dx, y, 0}, {0, dy, 0}, up, random, points);
    }
  };
  for (const double z : {0.0, thickness}) cover({0, 0, z}, {x_end, 0, 0}, {0, y_end, 0}, random, points);
  std::erase_if(points,
                [&](const Vec3& p) { return std::fmod(p.x, bar + width) > bar && std::fmod(p.y, bar + height) > bar; });
  rim(0, 0, x_end, y_end);
  for (unsigned i = 0; i < nx; ++i)
    for (unsigned j = 0; j < ny; ++j) rim(bar + i * (bar + width), bar + j * (bar + height), width, height);
  return points;
}

/// Every coordinate moved by up to `size` either way.
inline Points jittered(Points points, double size, std::uint64_t seed) {
  Random random(seed);
  for (Vec3& p : points) p = p + random.in_box(size);
  return points;
}

/// Torus around the z axis, every second ring turned by half a step.
inline Points torus(double major, double minor, unsigned around, unsigned across) {
  Points points;
  for (unsigned i = 0; i < around; ++i)
    for (unsigned j = 0; j < across; ++j) {
      const double u = 2 * std::numbers::pi * i / around;
      const double v = 2 * std::numbers::pi * (j + 0.5 * (i % 2)) / across;
      const double ring = major + minor * std::cos(v);
      points.push_back({ring * std::cos(u), ring * std::sin(u), minor * std::sin(v)});
    }
  return points;
}

/// Tetrahedralization with what most stages ask for beside it.
struct Prepared {
  Tetrahedralization t;
  std::vector<SampleIndex> sample_of_row;
  VertexStars stars;
  Labels known;
  Poles poles;
};
inline Prepared prepare(const Points& points, unsigned threads = 1) {
  const Threads team(threads);
  Prepared p;
  Samples samples = prepare_samples(points, team);
  p.sample_of_row = samples.of_row;
  p.t = tetrahedralize(std::move(samples), team);
  p.stars = vertex_stars(p.t, team);
  p.poles = find_poles(p.t, p.stars, {}, Weights::evidence, team);
  p.known = known_labels(p.t, p.stars, {}, {}, {}, team);
  return p;
}

inline Vec3 centroid(const Tetrahedralization& t, TetrahedronIndex i) {
  Vec3 sum;
  for (const VertexIndex s : t.tetrahedra[i]) sum = sum + 0.25 * t.positions[s];
  return sum;
}

inline double volume(const Tetrahedralization& t, TetrahedronIndex i) {
  const auto& [a, b, c, d] = t.tetrahedra[i];
  const Vec3& o = t.positions[a];
  return dot(cross(t.positions[b] - o, t.positions[c] - o), t.positions[d] - o) / 6;
}

/// Labels made by hand: all outside at first.
struct HandMade {
  Labels labels;
  IndexedArray<TetrahedronIndex, float> certainty;

  HandMade(std::size_t n, float all) : labels(n, Label::outside), certainty(n, all) {}
  void set(TetrahedronIndex i, Label label, float value) {
    labels[i] = label;
    certainty[i] = value;
  }
  [[nodiscard]] TetrahedronLabels done() const { return {labels, certainty}; }
};
/// Another side, as sure as before.
inline void put(TetrahedronLabels& labels, TetrahedronIndex i, Label label) {
  if (labels[i] != label) labels.turn(i);
}
/// Slow: for a few of a small cloud.
inline void put(TetrahedronLabels& labels, TetrahedronIndex i, Label label, float certainty) {
  HandMade made(0, 0);
  made.labels = labels.labels();
  made.certainty = labels.values();
  made.set(i, label, certainty);
  labels = made.done();
}

/// Tetrahedra at the cube outside, each other one inside with probability `share`; values to match.
inline TetrahedronLabels random_labels(const Tetrahedralization& t, double share, std::uint64_t seed) {
  Random random(seed);
  HandMade result(t.tetrahedra.size(), 1);
  for (std::uint32_t i = 0; i < t.tetrahedra.size(); ++i) {
    const TetrahedronIndex index{i};
    const double inside = random.uniform(), size = random.uniform(0.01, 1);
    if (t.touches_cube(index)) continue;
    result.set(index, inside < share ? Label::inside : Label::outside, static_cast<float>(size));
  }
  return result.done();
}

/// The triangles as sorted lists of corner coordinates, turned so that the smallest corner is first:
/// equal for meshes that differ only in the order of their rows.
inline std::vector<std::array<Vec3, 3>> triangle_set(const TriangleMesh& mesh) {
  std::vector<std::array<Vec3, 3>> set;
  for (const auto& [a, b, c] : mesh.triangles) {
    std::array<Vec3, 3> corners{mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]};
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    set.push_back(corners);
  }
  std::sort(set.begin(), set.end());
  return set;
}

} // namespace eigencrust::clouds
