// SPDX-License-Identifier: GPL-3.0-or-later
#include "open_scenes.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "counter_random.h"
#include "sensors.h"
#include "virtual_scanner.h"

namespace eigencrust::bench {
namespace {

using tools::CounterRandom;

bool holds(const Box3& box, const Vec3& p) {
  return p.x >= box.min.x && p.x <= box.max.x && p.y >= box.min.y && p.y <= box.max.y && p.z >= box.min.z &&
         p.z <= box.max.z;
}

/// Places of a rectangle, about `spacing` apart: work(u, v, random).
template <class Work>
void for_lattice(double u0, double u1, double v0, double v1, double spacing, std::uint64_t seed, Work&& work) {
  const auto across = static_cast<unsigned>(std::lround((u1 - u0) / spacing));
  const auto up = static_cast<unsigned>(std::lround((v1 - v0) / spacing));
  for (unsigned i = 0; i <= across; ++i)
    for (unsigned j = 0; j <= up; ++j) {
      const CounterRandom random(seed, i, j);
      const double u = u0 + spacing * (i + 0.5 * random.uniform(0)), v = v0 + spacing * (j + 0.5 * random.uniform(1));
      work(u, v, random);
    }
}

} // namespace

Scene block_scan(const BlockScan& scan, std::uint64_t seed, unsigned threads) {
  constexpr double cell = 0.1; // of the truth's lattice; walls are at least as thick
  Truth truth = block_part(scan.blocks, cell).truth;
  std::vector<tools::Sensor> views;
  for (const Vec3& place : scan.scanners)
    for (const tools::Sensor& view : tools::all_around(place, scan.rays)) views.push_back(view);
  tools::ScanOptions options;
  options.range_noise = scan.noise;
  options.seed = seed;
  options.threads = threads;
  const PointCloud all = tools::scan(*truth.mesh, views, options);
  PointCloud cloud;
  for (const Vec3& place : scan.scanners) cloud.sensors.push_back({place, false});
  for (std::size_t i = 0; i < all.points.size(); ++i) {
    if (std::any_of(scan.blind.begin(), scan.blind.end(), [&](const Box3& b) { return holds(b, all.points[i]); }))
      continue;
    cloud.points.push_back(all.points[i]);
    cloud.sensor_of.push_back(all.scan_index[i] / 6);
  }
  Scene scene = clean_scene(cloud.points, std::move(truth), threads);
  scene.cloud = std::move(cloud);
  return scene;
}

Scene height_scan(const HeightScan& scan, std::uint64_t seed, unsigned threads) {
  std::vector<Vec3> points;
  for_lattice(-scan.half, scan.half, -scan.half, scan.half, scan.spacing, seed,
              [&](double x, double y, const CounterRandom& random) {
                if (!scan.seen || scan.seen(x, y))
                  points.push_back({x, y, scan.height(x, y) + scan.noise * random.normal(2)});
              });
  return clean_scene(std::move(points), {}, threads);
}

double cone_height(double radius, double height, double x, double y) {
  return std::max(0.0, height * (1 - std::hypot(x, y) / radius));
}

Scene houses_from_the_air(double spacing, double noise, std::uint64_t seed, unsigned threads) {
  struct House {
    double x0, x1, y0, y1, eaves;
  };
  constexpr std::array<House, 4> houses{
      {{5, 12, 5, 15, 6}, {20, 33, 6, 14, 9}, {8, 18, 22, 34, 7}, {26, 36, 24, 35, 12}}};
  std::vector<Vec3> points;
  for_lattice(0, 40, 0, 40, spacing, seed, [&](double x, double y, const CounterRandom& random) {
    double z = 0;
    for (const House& h : houses)
      if (x > h.x0 && x < h.x1 && y > h.y0 && y < h.y1) z = h.eaves + 0.5 * std::min(x - h.x0, h.x1 - x);
    points.push_back({x, y, z + noise * random.normal(2)});
  });
  // The aircraft flew to the left of them: only walls that face it were hit, at a flat angle.
  for (const House& h : houses)
    for_lattice(h.y0, h.y1, 0, h.eaves, 2 * spacing, seed + 1, [&](double y, double z, const CounterRandom& random) {
      if (y < h.y1 && z < h.eaves) points.push_back({h.x0 + noise * random.normal(2), y, z});
    });
  return clean_scene(std::move(points), {}, threads);
}

Scene street(double spacing, double noise, std::uint64_t seed, unsigned threads) {
  std::vector<Vec3> points;
  for_lattice(-15, 15, 0, 8, spacing, seed, [&](double x, double y, const CounterRandom& random) {
    points.push_back({x, y, noise * random.normal(2)});
  });
  for_lattice(-15, 15, 0, 7, spacing, seed + 1, [&](double x, double z, const CounterRandom& random) {
    const double along = x - 3 * std::floor(x / 3), up = z - 3 * std::floor(z / 3);
    const bool window = along < 1.2 && up > 1 && up < 2.4;
    points.push_back({x, (window ? 8.3 : 8.0) + noise * random.normal(2), z});
  });
  return clean_scene(std::move(points), {}, threads);
}

} // namespace eigencrust::bench
