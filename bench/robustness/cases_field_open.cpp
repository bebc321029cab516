// SPDX-License-Identifier: GPL-3.0-or-later
// Rooms from within, buildings from both sides, ground with what stands on it, streets: made from formulas.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "cases.h"
#include "degradations.h"
#include "field_scenes.h"
#include "open_scenes.h"

namespace eigencrust::bench {
namespace {

/// faces_scanner: share of the surface's area that faces some sensor; interior: 1 where that is what was read.
void measure_facing(const Scene& scene, const Result& result, Sources&, Figures& figures) {
  double facing = 0, all = 0;
  for (const auto& t : result.mesh.triangles) {
    const auto& v = result.mesh.vertices;
    const Vec3 normal = cross(v[t[1]] - v[t[0]], v[t[2]] - v[t[0]]);
    const auto seen_by = [&](const Sensor& s) { return dot(s.place - v[t[0]], normal) > 0; };
    all += norm(normal);
    if (std::any_of(scene.cloud.sensors.begin(), scene.cloud.sensors.end(), seen_by)) facing += norm(normal);
  }
  figures.set("faces_scanner", facing / all);
  figures.set("interior", result.report.surroundings.kind == SceneKind::interior ? 1 : 0);
}

struct BlockRow {
  const char *name, *description;
  BlockScan scan;
  bool interior;
  double components, genus, volume_error;
};

/// Two rooms side by side with a wall of that thickness between them, and a door in it.
std::vector<Block> two_rooms(double wall) {
  return {{{0, 0, 0}, {4, 4, 2.7}}, {{4 + wall, 0, 0}, {8, 4, 2.7}}, {{4, 1.5, 0}, {4 + wall, 2.4, 2.1}}};
}

/// The walls around two rooms, one of them with a door to the outside.
std::vector<Block> house() {
  std::vector<Block> blocks{{{-0.3, -0.3, -0.3}, {8.3, 4.3, 3}}};
  for (const Block& room : two_rooms(0.2)) blocks.push_back({room.low, room.high, false});
  blocks.push_back({{1, -0.3, 0}, {2, 0, 2.1}, false});
  return blocks;
}

/// On a circle around the house, and above it.
std::vector<Vec3> around_and_in_house() {
  std::vector<Vec3> scanners{{2, 2, 1.5}, {6, 1.9, 1.5}, {4, 2, 15}};
  for (int i = 0; i < 8; ++i) {
    const double angle = 0.2 + std::numbers::pi / 4 * i;
    scanners.push_back({4 + 14 * std::cos(angle), 2 + 14 * std::sin(angle), 1.5});
  }
  return scanners;
}

std::vector<BlockRow> block_rows() {
  const std::vector<Block> room{{{0, 0, 0}, {5, 4, 2.7}}};
  const std::vector<Block> angled{{{0, 0, 0}, {6, 3, 2.7}}, {{0, 0, 0}, {2.5, 6, 2.7}}};
  std::vector<Block> furnished = room;
  for (const auto& [low, high] : {std::pair{Vec3{3.6, 2.4, 0}, Vec3{3.9, 2.7, 2.7}},
                                  {Vec3{0, 0, 0}, Vec3{0.6, 1.8, 2}},
                                  {Vec3{4.4, 0.3, 0}, Vec3{5, 1.5, 0.8}}})
    furnished.push_back({low, high, false});
  return {
      {"room", "an empty room, the scanner inside", {room, {{2.2, 1.9, 1.4}}}, true, 1, 0, 0.02},
      {"room-angled", "an L-shaped room, one scanner", {angled, {{1.4, 1.6, 1.5}}, 60, {}, 0.003}, true, 1, 0, 0.02},
      {"room-filled",
       "a room with pillar, cupboard and sideboard, two scanners",
       {furnished, {{2.6, 2, 1.5}, {0.7, 3.4, 1.5}}, 60, {}, 0.004},
       true,
       1,
       1,
       0.02},
      {"room-window",
       "a room with a window from which nothing returns",
       {room, {{2.2, 1.9, 1.4}}, 60, {{{4.9, 1, 0.9}, {5.1, 2.5, 2.1}}}},
       true,
       1,
       0,
       0.02},
      {"rooms-door",
       "two rooms joined by a door, a scanner in each",
       {two_rooms(0.2), {{2, 2, 1.5}, {6, 1.9, 1.5}}, 60, {}, 0.002},
       true,
       1,
       0,
       0.02},
      {"house-both-sides",
       "walls of 0.3 m seen from without and from within, the door open",
       {house(), around_and_in_house(), 120, {}, 0.002},
       false,
       1,
       0,
       0.05},
  };
}

/// From one side: rims of the surface, the share of its area that faces up, and whether a façade was read.
void measure_open(const Scene&, const Result& result, Sources&, Figures& figures) {
  double up = 0, all = 0;
  for (const auto& t : result.mesh.triangles) {
    const auto& v = result.mesh.vertices;
    const Vec3 normal = cross(v[t[1]] - v[t[0]], v[t[2]] - v[t[0]]);
    all += norm(normal);
    if (normal.z > 0) up += norm(normal);
  }
  figures.set("faces_up", up / all);
  figures.set("rims", static_cast<double>(result.report.mesh.boundary_loops));
  figures.set("facade", result.report.surroundings.kind == SceneKind::facade ? 1 : 0);
}

struct GroundRow {
  const char *name, *description;
  std::function<Scene(std::uint64_t seed, unsigned threads)> make;
  double kept, up;
};

Scene roofs(double strays, std::uint64_t seed, unsigned threads) {
  HeightScan scan{10, 0.2, 0.06, [](double x, double y) {
                    const bool is_round = std::hypot(x + 5, y + 5) < 2.2;
                    const bool is_long = std::fabs(x - 4) < 1.6 && std::fabs(y + 4) < 4;
                    const bool is_wide = std::fabs(x + 1) < 5 && std::fabs(y - 5) < 2;
                    return is_round || is_long || is_wide ? 3.0 : 0.0;
                  }};
  Scene scene = height_scan(scan, seed, threads);
  add_outliers(scene, {strays, OutlierPlace::box, 1.5}, seed + 1);
  return scene;
}

std::vector<GroundRow> ground_rows() {
  const auto heights = [](HeightScan scan) {
    return [scan](std::uint64_t seed, unsigned threads) { return height_scan(scan, seed, threads); };
  };
  const auto waves = [](double x, double y) { return 2 * std::sin(x / 2) + 1.5 * std::cos(y / 1.7 + 1); };
  const auto slope = [](double x, double y) { return 0.6 * x - 0.3 * y; };
  return {
      {"terrain", "hills, a height for each square metre, coordinates of a survey",
       [](std::uint64_t seed, unsigned threads) { return terrain(60, 60, 1, seed, threads); }, 0.99, 0.99},
      {"ball-on-ground", "a ball on flat ground, seen from above",
       [](std::uint64_t seed, unsigned threads) { return ball_on_ground(12, 1.5, 0.25, seed, threads); }, 0.95, 0.95},
      {"ground-flat", "flat ground, noise 0.05 spacings", heights({10, 0.2, 0.01, [](double, double) { return 0.0; }}),
       0.99, 0.99},
      {"ground-slope", "a slope of 34 degrees", heights({10, 0.2, 0.01, slope}), 0.99, 0.99},
      {"ground-hills", "hills of 45 degrees, noise 0.15 spacings", heights({10, 0.2, 0.03, waves}), 0.97, 0.99},
      {"ground-holes", "hills with a pond where nothing returns",
       heights({10, 0.2, 0.01, waves, [](double x, double y) { return std::hypot(x - 2, y + 1) > 2.5; }}), 0.97, 0.99},
      {"houses", "houses on flat ground from the air, few samples on their walls",
       [](std::uint64_t seed, unsigned threads) { return houses_from_the_air(0.35, 0.02, seed, threads); }, 0.95,
       0.8}, // walls do not look up
      {"roofs", "flat roofs 15 spacings high of which no wall was seen, noise 0.3 spacings",
       [](std::uint64_t seed, unsigned threads) { return roofs(0, seed, threads); }, 0.95, 0.45},
      {"roofs+1%", "the same among strays from above the roofs to below the ground",
       [](std::uint64_t seed, unsigned threads) { return roofs(0.01, seed, threads); }, 0.95, 0.45},
      {"street", "a street before a facade with windows set back",
       [](std::uint64_t seed, unsigned threads) { return street(0.15, 0.004, seed, threads); }, 0.95, 0.5},
  };
}

void add_pile(std::vector<Case>& cases, const char* name, const char* description, double ground, double noise) {
  Case c = field_case(name, description, [=](Sources& sources, std::uint64_t seed) {
    const HeightScan scan{10, 0.2, noise,
                          [=](double x, double y) { return cone_height(4, 2.6, x + 0.5, y - 1) + ground * x; }};
    return height_scan(scan, seed, sources.threads());
  });
  c.how = [](Options& options) { options.base = true; };
  c.requirements = {equals("components", 1), equals("genus", 0), at_most("pile_error", 0.02)};
  c.measure_more = [](const Scene&, const Result& result, Sources&, Figures& figures) {
    const double pile = std::numbers::pi * 4 * 4 * 2.6 / 3;
    const double found = result.report.base ? result.report.base->volume_above_rim : 0;
    figures.set("pile_error", std::fabs(found / pile - 1));
  };
  cases.push_back(std::move(c));
}

} // namespace

void add_open_field_cases(std::vector<Case>& cases) {
  for (const BlockRow& row : block_rows()) {
    Case c = field_case(row.name, row.description, [scan = row.scan](Sources& sources, std::uint64_t seed) {
      return block_scan(scan, seed, sources.threads());
    });
    c.requirements = {equals("components", row.components), equals("genus", row.genus),
                      at_most("volume_error", row.volume_error), at_least("true_samples_kept", 0.98),
                      equals("interior", row.interior ? 1 : 0)};
    if (row.interior) c.requirements.push_back(at_least("faces_scanner", 0.98));
    c.measure_more = measure_facing;
    cases.push_back(std::move(c));
  }
  constexpr std::array<Vec3, 2> scanners{{{2.6, 2.2, 1.5}, {0.6, 3.2, 1.5}}};
  Case c = field_case(
      "room-furnished", "a room with pillar and table, two scanners",
      [=](Sources& sources, std::uint64_t seed) { return room(scanners, true, 0.004, seed, sources.threads()); });
  c.requirements = {equals("components", 1), at_least("genus", 1), at_most("volume_error", 0.03),
                    at_least("true_samples_kept", 0.98), equals("interior", 1)};
  c.measure_more = measure_facing;
  cases.push_back(std::move(c));
  for (const GroundRow& row : ground_rows()) {
    c = field_case(row.name, row.description,
                   [make = row.make](Sources& sources, std::uint64_t seed) { return make(seed, sources.threads()); });
    c.requirements = {equals("components", 1),
                      equals("genus", 0),
                      equals("rims", 1),
                      equals("facade", 1),
                      at_least("true_samples_kept", row.kept),
                      at_least("faces_up", row.up)};
    c.measure_more = measure_open;
    cases.push_back(std::move(c));
  }
  add_pile(cases, "pile", "a pile on flat ground, with --base", 0, 0);
  add_pile(cases, "pile-noise", "the same, noise 0.1 spacings", 0, 0.02);
  add_pile(cases, "pile-slope", "a pile on sloping ground, with --base", 0.2, 0.01);
}

} // namespace eigencrust::bench
