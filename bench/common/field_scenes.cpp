// SPDX-License-Identifier: GPL-3.0-or-later
#include "field_scenes.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "counter_random.h"
#include "degradations.h"
#include "open_scenes.h"
#include "sampling.h"
#include "sensors.h"
#include "shapes.h"

namespace eigencrust::bench {
namespace {

constexpr double pi = std::numbers::pi;
using tools::CounterRandom;

/// Area that two discs have in common.
double lens(double distance, double a, double b) {
  if (distance >= a + b) return 0;
  const double least = std::min(a, b);
  if (distance <= std::fabs(a - b)) return pi * least * least;
  // Half the chord's angle as seen from either centre.
  const double u = std::acos((distance * distance + a * a - b * b) / (2 * distance * a));
  const double v = std::acos((distance * distance + b * b - a * a) / (2 * distance * b));
  return a * a * (u - std::sin(2 * u) / 2) + b * b * (v - std::sin(2 * v) / 2);
}

/// Spread evenly over a sphere, about `spacing` apart.
std::vector<Vec3> on_sphere(double radius, const Vec3& centre, double spacing) {
  // A spiral of n points on the unit sphere has spacing 3.5 / √n.
  const double n = std::pow(3.5 * radius / spacing, 2);
  std::vector<Vec3> points = tools::fibonacci_directions(static_cast<std::uint32_t>(std::lround(n)));
  for (Vec3& p : points) p = radius * p + centre;
  return points;
}

Part ball(double radius, const Vec3& centre, double spacing) {
  Part part;
  part.samples = on_sphere(radius, centre, spacing);
  part.truth = truth_of(shapes::icosphere(6, radius, centre));
  part.truth.volume = 4 * pi / 3 * std::pow(radius, 3);
  part.truth.area = 4 * pi * radius * radius;
  return part;
}

} // namespace

Scene part_scene(Part part, double noise, std::uint64_t seed, unsigned threads) {
  Scene scene = clean_scene(std::move(part.samples), std::move(part.truth), threads);
  scene.sharp_edges = std::move(part.sharp_edges);
  if (noise > 0) add_noise(scene.cloud.points, noise * scene.spacing, seed);
  return scene;
}

std::vector<Organ::Section> Organ::sections(double z) const {
  std::vector<Section> list;
  for (const Vessel& v : vessels_) {
    if (z < v.from.z || z > v.to.z) continue;
    const double t = (z - v.from.z) / (v.to.z - v.from.z);
    const double radius = v.radius_from + t * (v.radius_to - v.radius_from);
    const Vec3 centre = v.from + t * (v.to - v.from);
    list.push_back({{centre.x, centre.y, z}, radius, v.ratio * radius}); // z to the last bit: a slice is flat
  }
  return list;
}

double Organ::section_area(double z) const {
  const std::vector<Section> list = sections(z);
  double area = 0;
  for (std::size_t i = 0; i < list.size(); ++i) {
    area += pi * list[i].a * list[i].b;
    for (std::size_t j = 0; j < i; ++j) area -= lens(distance(list[i].centre, list[j].centre), list[i].a, list[j].a);
  }
  return area;
}

bool Organ::inside(const Vec3& p) const {
  const std::vector<Section> list = sections(p.z);
  return std::any_of(list.begin(), list.end(), [&](const Section& s) {
    return std::hypot((p.x - s.centre.x) / s.a, (p.y - s.centre.y) / s.b) < 1;
  });
}

std::vector<Vec3> Organ::contour(double z, double step) const {
  const std::vector<Section> list = sections(z);
  std::vector<Vec3> points;
  for (const Section& s : list) {
    const auto n = static_cast<unsigned>(std::lround(pi * (s.a + s.b) / step));
    for (unsigned j = 0; j < n; ++j) {
      const double u = 2 * pi * j / n;
      const Vec3 p = s.centre + Vec3{s.a * std::cos(u), s.b * std::sin(u), 0};
      const bool covered = std::any_of(list.begin(), list.end(), [&](const Section& other) {
        return &other != &s && std::hypot((p.x - other.centre.x) / other.a, (p.y - other.centre.y) / other.b) < 1;
      });
      if (!covered) points.push_back(p);
    }
  }
  return points;
}

double Organ::low() const {
  double z = vessels_.front().from.z;
  for (const Vessel& v : vessels_) z = std::min(z, v.from.z);
  return z;
}

double Organ::high() const {
  double z = vessels_.front().to.z;
  for (const Vessel& v : vessels_) z = std::max(z, v.to.z);
  return z;
}

Scene Organ::contours(unsigned slices, double step, unsigned threads) const {
  std::vector<Vec3> points;
  for (unsigned i = 0; i < slices; ++i) {
    const std::vector<Vec3> slice = contour(low() + (high() - low()) * i / (slices - 1), step);
    points.insert(points.end(), slice.begin(), slice.end());
  }
  Truth truth;
  constexpr unsigned layers = 20'000; // midpoints: exact to the digits that matter
  for (unsigned i = 0; i < layers; ++i) {
    const double thickness = (high() - low()) / layers;
    truth.volume += thickness * section_area(low() + thickness * (i + 0.5));
  }
  truth.inside = [organ = *this](const Vec3& p) { return organ.inside(p); };
  return clean_scene(std::move(points), std::move(truth), threads);
}

Scene tunnel(double length, double gap, double a, double b, double swing, unsigned per_ring, unsigned threads) {
  std::vector<Vec3> points;
  const auto rings = static_cast<unsigned>(std::lround(length / gap));
  for (unsigned i = 0; i <= rings; ++i)
    for (unsigned j = 0; j < per_ring; ++j) {
      const double x = length * i / rings, u = 2 * pi * (j + 0.5 * (i % 2)) / per_ring;
      points.push_back({x, swing * std::sin(pi * x / length) + a * std::cos(u), b * std::sin(u)});
    }
  Truth truth;
  truth.volume = pi * a * b * length; // Cavalieri
  return clean_scene(std::move(points), std::move(truth), threads);
}

Scene noisy_beside_clean(std::size_t count, double noise, std::uint64_t seed, unsigned threads) {
  constexpr double radius = 2, clean = 0.5, fine = 0.7; // of the noisy ball's spacing
  const double spacing = 3.5 * radius / std::sqrt(static_cast<double>(count));
  const std::array<Block, 1> plate{Block{{5.5, 2.5, 0}, {6.5, 3.5, 0.06}}};
  Part parts = beside(ball(clean, {6, 0, 0}, fine * spacing), block_part(plate, fine * spacing));
  const std::size_t clean_end = parts.samples.size(), ball_end = on_sphere(clean, {}, fine * spacing).size();
  parts = beside(std::move(parts), ball(radius, {}, spacing));
  Scene scene = clean_scene(std::move(parts.samples), std::move(parts.truth), threads);
  std::vector<Vec3>& points = scene.cloud.points;
  std::vector<Vec3> noisy(points.begin() + static_cast<std::ptrdiff_t>(clean_end), points.end());
  add_noise(noisy, noise * spacing, seed);
  std::copy(noisy.begin(), noisy.end(), points.begin() + static_cast<std::ptrdiff_t>(clean_end));
  scene.clean_rows = {{0, ball_end}, {ball_end, clean_end}};
  return scene;
}

Scene ball_with_cavities(double radius, std::span<const Cavity> cavities, double spacing, unsigned threads) {
  Part part = ball(radius, {}, spacing);
  TriangleMesh mesh = *part.truth.mesh;
  for (const auto& [centre, r] : cavities) {
    const Part hollow = ball(r, centre, spacing);
    part.samples.insert(part.samples.end(), hollow.samples.begin(), hollow.samples.end());
    mesh = shapes::joined(std::move(mesh), shapes::flipped(*hollow.truth.mesh));
    part.truth.volume -= hollow.truth.volume;
    part.truth.area += hollow.truth.area;
    ++part.truth.components;
  }
  part.truth.mesh = std::make_shared<const TriangleMesh>(std::move(mesh));
  part.truth.inside = [=, holes = std::vector<Cavity>(cavities.begin(), cavities.end())](const Vec3& p) {
    return norm(p) < radius &&
           std::none_of(holes.begin(), holes.end(), [&](const Cavity& c) { return distance(p, c.centre) < c.radius; });
  };
  return part_scene(std::move(part), 0, 0, threads);
}

Scene filled_ellipsoid(const Vec3& half_axes, std::size_t count, std::uint64_t seed, unsigned threads) {
  std::vector<Vec3> points;
  const auto add = [&](const Vec3& p) {
    if (norm(Vec3{p.x / half_axes.x, p.y / half_axes.y, p.z / half_axes.z}) <= 1) points.push_back(p);
  };
  for (std::uint64_t i = 0; points.size() < count; ++i) {
    const CounterRandom random(seed, 0, i);
    add({half_axes.x * (2 * random.uniform(0) - 1), half_axes.y * (2 * random.uniform(1) - 1),
         half_axes.z * (2 * random.uniform(2) - 1)});
  }
  if (count == 0)
    for (double x = -std::floor(half_axes.x); x <= half_axes.x; ++x)
      for (double y = -std::floor(half_axes.y); y <= half_axes.y; ++y)
        for (double z = -std::floor(half_axes.z); z <= half_axes.z; ++z) add({x, y, z});
  return clean_scene(std::move(points), {}, threads);
}

Scene room(std::span<const Vec3> scanners, bool furnished, double noise, std::uint64_t seed, unsigned threads) {
  BlockScan scan{{{{0, 0, 0}, {5, 4, 2.7}}}, {scanners.begin(), scanners.end()}};
  scan.noise = noise;
  if (furnished) {
    scan.blocks.push_back({{3.6, 2.4, 0}, {3.9, 2.7, 2.7}, false});     // pillar, from floor to ceiling
    scan.blocks.push_back({{1.2, 2.4, 0.72}, {2.4, 3.2, 0.78}, false}); // table top
    scan.blocks.push_back({{1.7, 2.7, 0}, {1.9, 2.9, 0.72}, false});    // its leg
  }
  return block_scan(scan, seed, threads);
}

Scene terrain(unsigned columns, unsigned rows, double cell, std::uint64_t seed, unsigned threads) {
  struct Hill {
    double x, y, height, width;
  };
  std::vector<Hill> hills;
  for (std::uint64_t i = 0; i < 12; ++i) {
    const CounterRandom random(seed, 0, i);
    hills.push_back({columns * random.uniform(0), rows * random.uniform(1), 6 * random.uniform(2) - 2,
                     columns * (0.05 + 0.15 * random.uniform(3))});
  }
  std::vector<Vec3> points;
  for (unsigned j = 0; j < rows; ++j)
    for (unsigned i = 0; i < columns; ++i) {
      double z = 345;
      for (const Hill& h : hills)
        z += h.height * std::exp(-(std::pow(i - h.x, 2) + std::pow(j - h.y, 2)) / (h.width * h.width));
      points.push_back({432'100.5 + cell * i, 5'480'200.5 + cell * j, std::round(100 * z) / 100});
    }
  return clean_scene(std::move(points), {}, threads);
}

Scene ball_on_ground(double ground, double radius, double spacing, std::uint64_t seed, unsigned threads) {
  std::vector<Vec3> points;
  const auto n = static_cast<unsigned>(std::lround(2 * ground / spacing));
  for (unsigned i = 0; i <= n; ++i)
    for (unsigned j = 0; j <= n; ++j) {
      const CounterRandom random(seed, i, j);
      const Vec3 p{-ground + spacing * (i + 0.6 * random.uniform(0)), -ground + spacing * (j + 0.6 * random.uniform(1)),
                   0};
      if (norm(p) > radius) points.push_back(p); // the ball's shadow from above
    }
  for (const Vec3& p : on_sphere(radius, {0, 0, radius}, spacing))
    if (p.z > radius) points.push_back(p);
  return clean_scene(std::move(points), {}, threads);
}

} // namespace eigencrust::bench
