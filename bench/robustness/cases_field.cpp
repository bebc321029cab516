// SPDX-License-Identifier: GPL-3.0-or-later
// Clouds of the kind that people bring, made from formulas: thin walls, sharp parts, contours, noise beside clean
// parts, tiny bodies.
#include <eigencrust/metrics.h>

#include <array>
#include <cmath>
#include <numbers>

#include "cases.h"
#include "field_scenes.h"
#include "parts.h"
#include "shapes.h"

namespace eigencrust::bench {
namespace {

constexpr double pi = std::numbers::pi;

/// A part with noise in spacings; one piece of that genus.
Case part_case(std::string name, std::string description, std::function<Part(std::uint64_t)> part, double noise,
               double genus) {
  Case c = field_case(std::move(name), std::move(description), [=](Sources& sources, std::uint64_t seed) {
    return part_scene(part(seed), noise, seed, sources.threads());
  });
  c.requirements = {equals("components", 1), equals("genus", genus)};
  return c;
}

/// The part of a table that its seed does not change.
template <class Make>
std::function<Part(std::uint64_t)> fixed(Make make) {
  return [make](std::uint64_t) { return make(); };
}

struct ThinRow {
  const char *name, *description;
  std::function<Part(std::uint64_t)> part;
  double noise, genus, volume_error;
  bool may_say_why_not = false; ///< below two spacings without samples of the rim, or near one
};

/// Half a sphere's shell, open at the top, with a flat rim.
Part bowl(double radius, double wall, double spacing) {
  constexpr unsigned pieces = 30;
  std::vector<ProfilePoint> profile;
  for (unsigned i = 0; i <= pieces; ++i) {
    const double u = pi / 2 * i / pieces;
    profile.push_back({i == 0 ? 0 : radius * std::sin(u), -radius * std::cos(u)});
  }
  for (unsigned i = 0; i <= pieces; ++i) {
    const double u = pi / 2 * (pieces - i) / pieces;
    profile.push_back({i == pieces ? 0 : (radius - wall) * std::sin(u), -(radius - wall) * std::cos(u)});
  }
  return turned_part(profile, spacing);
}

/// A foot, an upright plate and a thin rib between the two.
Part ribbed_bracket(double rib, double spacing) {
  const std::array<Block, 3> blocks{Block{{0, 0, 0}, {40, 24, 6}}, Block{{0, 0, 6}, {6, 24, 30}},
                                    Block{{6, 12 - 0.5 * rib, 6}, {28, 12 + 0.5 * rib, 20}}};
  return block_part(blocks, spacing);
}

std::vector<ThinRow> walls_of_the_field() {
  const auto cup_a = [](double wall) { return fixed([=] { return cup(20, 40, wall, 0.875); }); };
  const auto cup_b = [](double spacing) { return fixed([=] { return cup(40, 90, 3, spacing); }); };
  return {
      {"cup-1.83", "a beaker whose wall is 1.83 spacings thick", cup_a(1.6), 0, 0, 0.02},
      {"cup-1.83-noise", "the same with noise of 0.05 spacings", cup_a(1.6), 0.05, 0, 0.02},
      {"cup-2.3-noise", "a wall of 2.3 spacings with noise of 0.05", cup_a(2), 0.05, 0, 0.02},
      {"cup-1.37-noise", "a wall of 1.37 spacings with noise of 0.05", cup_a(1.2), 0.05, 0, 0.05, true},
      {"cup-1.9-noise", "a large beaker, wall 1.9 spacings, noise 0.1", cup_b(1.6), 0.1, 0, 0.02},
      {"cup-1.4-noise", "the same with a wall of 1.4 spacings", cup_b(2.2), 0.1, 0, 0.02},
      {"bin-1.33", "an open box of boards 1.33 spacings thick, gridded", fixed([] {
         return open_bin({50, 40, 40}, 2, 1.5);
       }),
       0, 0, 0.02},
      {"bin-1.33-noise", "a larger one, noise 0.1 spacings", fixed([] {
         return open_bin({100, 75, 75}, 2, 1.5);
       }),
       0.1, 0, 0.02},
      {"plate-1", "a plate one spacing thick with samples on its rims, gridded", fixed([] {
         const std::array<Block, 1> plate{Block{{0, 0, 0}, {30, 30, 1}}};
         return block_part(plate, 1);
       }),
       0, 0, 0.02},
      {"plate-0.8-no-rims", "a plate with a hole, 0.8 spacings thick: two sheets without samples on the rims",
       fixed([] {
         return holed_plate({100, 80, 0.8}, 15, 1, false);
       }),
       0, 1, 0.05, true},
      {"sheet-metal", "sheet metal with a hole, 1.4 spacings thick, noise 0.03", fixed([] {
         return holed_plate({60, 40, 2}, 8, 1.4, true);
       }),
       0.03, 1, 0.03},
  };
}

std::vector<ThinRow> other_walls() {
  return {
      {"cup-darts-3", "a beaker of 3 spacings, samples at random places and none on its edges",
       [](std::uint64_t seed) { return darted(cup(20, 40, 2.4, 0.9), 12'200, seed); }, 0, 0, 0.03},
      {"cup-small-1.6", "a narrow beaker, wall 1.6 spacings, noise 0.1", fixed([] { return cup(7, 30, 0.8, 0.5); }),
       0.1, 0, 0.02},
      {"bowl-1.7", "half a sphere's shell, 1.7 spacings thick, noise 0.1", fixed([] { return bowl(30, 2.6, 1.55); }),
       0.1, 0, 0.02},
      {"tray-1.5", "a flat tray of 1.5 spacings, turned in space, noise 0.05",
       [](std::uint64_t seed) {
         return rotated(open_bin({60, 40, 12}, 1.5, 1), seed);
       },
       0.05, 0, 0.02},
      {"pipe-bend-1.8", "a quarter bend of pipe, open at both ends, wall 1.8 spacings",
       fixed([] { return pipe_bend(30, 8, 6, 1.1); }), 0, 1, 0.02},
      {"pipe-bend-1.6-noise", "another one, wall 1.6 spacings, noise 0.1",
       fixed([] { return pipe_bend(40, 12, 10.4, 1); }), 0.1, 1, 0.02},
      {"ribbed-bracket-1.6", "a bracket with a rib 1.6 spacings thick, gridded",
       fixed([] { return ribbed_bracket(1.6, 1); }), 0, 0, 0.01},
      {"ribbed-bracket-1.2", "the same, rib of 1.2 spacings, turned in space, noise 0.05",
       [](std::uint64_t seed) { return rotated(ribbed_bracket(1.2, 1), seed); }, 0.05, 0, 0.01},
      {"plate-1.5-turned", "a plate of 1.5 spacings, turned in space, noise 0.05",
       [](std::uint64_t seed) {
         const std::array<Block, 1> plate{Block{{0, 0, 0}, {36, 24, 1.5}}};
         return rotated(block_part(plate, 1), seed);
       },
       0.05, 0, 0.02},
      {"washer-1.3", "a square washer of 1.3 spacings, noise 0.05", fixed([] {
         return holed_plate({30, 30, 1.3}, 9, 1, true);
       }),
       0.05, 1, 0.03},
  };
}

void add_thin_cases(std::vector<Case>& cases) {
  for (const auto& rows : {walls_of_the_field(), other_walls()})
    for (const ThinRow& row : rows) {
      Case c = part_case(row.name, row.description, row.part, row.noise, row.genus);
      c.requirements.push_back(at_most("volume_error", row.volume_error));
      if (row.may_say_why_not) c.excuse = "thin";
      cases.push_back(std::move(c));
    }
}

struct SharpRow {
  const char *name, *description;
  std::function<Part(std::uint64_t)> part;
  double genus = 0, noise = 0, volume_error = 0.002, area_error = 0.005;
};

std::function<Part(std::uint64_t)> box_grid(const Vec3& size) {
  return fixed([=] {
    const std::array<Block, 1> box{Block{{0, 0, 0}, size}};
    return block_part(box, 1);
  });
}

Part bracket() {
  const std::array<Block, 2> blocks{Block{{0, 0, 0}, {20, 20, 10}}, Block{{8, 8, 0}, {20, 20, 10}, false}};
  return block_part(blocks, 1);
}

Part stairs() {
  std::vector<Block> blocks;
  for (int i = 0; i < 4; ++i) blocks.push_back({{5.0 * i, 0, 0}, {5.0 * (i + 1), 14, 4.0 * (i + 1)}});
  return block_part(blocks, 1);
}

Part block_with_window() {
  const std::array<Block, 2> blocks{Block{{0, 0, 0}, {20, 8, 20}}, Block{{6, 0, 6}, {14, 8, 14}, false}};
  return block_part(blocks, 1);
}

Part bolt() {
  const std::array<ProfilePoint, 6> profile{{{0, 0}, {9, 0}, {9, 6}, {4, 6}, {4, 24}, {0, 24}}};
  return turned_part(profile, 0.5);
}

void add_sharp_cases(std::vector<Case>& cases) {
  const auto box = box_grid({20, 16, 12});
  const auto turned = [](auto make) { return [make](std::uint64_t seed) { return rotated(make(seed), seed); }; };
  const auto cylinder = fixed([] {
    const std::array<ProfilePoint, 4> profile{{{0, 0}, {6, 0}, {6, 20}, {0, 20}}};
    return turned_part(profile, 0.6);
  });
  const std::vector<SharpRow> rows{
      {"box-20x16x12", "a gridded box", box},
      {"box-40x30x20", "a gridded box", box_grid({40, 30, 20})},
      {"box-3x3x3", "a cube of 56 samples", box_grid({3, 3, 3})},
      {"box-2x2x2", "a cube of 26 samples", box_grid({2, 2, 2})},
      {"box-turned", "a gridded box turned in space", turned(box)},
      {"box-jittered", "the same, noise 0.02 spacings", box, 0, 0.02, 0.003, 0.003},
      {"bracket", "an L bracket, gridded", fixed(bracket)},
      // The samples' polygon lacks 0.2 % of the circle.
      {"cylinder", "a cylinder with its caps", cylinder, 0, 0, 0.005},
      {"bracket-turned", "an L bracket turned in space, noise 0.02 spacings", turned(fixed(bracket)), 0, 0.02, 0.003,
       0.005},
      {"stairs", "four steps, gridded", fixed(stairs)},
      {"window", "a block with a square hole, gridded", fixed(block_with_window), 1},
      {"window-turned", "the same turned in space", turned(fixed(block_with_window)), 1},
      {"bolt", "a bolt: two cylinders", fixed(bolt), 0, 0, 0.005},
  };
  for (const SharpRow& row : rows) {
    Case c = part_case(row.name, row.description, row.part, row.noise, row.genus);
    c.requirements.insert(c.requirements.end(), {at_most("volume_error", row.volume_error),
                                                 at_most("area_error", row.area_error), equals("sharp_edges_kept", 1)});
    cases.push_back(std::move(c));
  }
}

/// flat_caps: the least share of an end's section that lies in one plane in the mesh.
void measure_flat_caps(const Organ& organ, const TriangleMesh& mesh, Figures& figures) {
  double least = 1;
  for (const double z : {organ.low(), organ.high()}) {
    double flat = 0;
    for (const auto& t : mesh.triangles) {
      const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
      if (a.z == z && b.z == z && c.z == z) flat += 0.5 * norm(cross(b - a, c - a));
    }
    least = std::min(least, flat / organ.section_area(z));
  }
  figures.set("flat_caps", least);
}

void add_contour_cases(std::vector<Case>& cases) {
  struct Row {
    const char *name, *description;
    Organ organ;
    unsigned slices;
    double step;
  };
  const Organ trunk({{{0, 0, -21}, {6, 3, 21}, 16, 11, 0.8}});
  // Two vessels meet between two slices.
  const Organ branching(
      {{{-13, 0, 0}, {-4.5, 0, 21}, 5, 5.5}, {{13, 0, 0}, {4.5, 0, 21}, 5, 5.5}, {{0, 0, 21}, {0, 0, 40}, 9, 7, 0.7}});
  const Organ forked(
      {{{0, 2, 0}, {0, 0, 19}, 6, 7}, {{-4, 0, 19}, {-12, -3, 45}, 5, 3}, {{4, 0, 19}, {13, 4, 45}, 5, 4}});
  for (const Row& row : {Row{"contours", "contours of an organ, 3 apart, samples 0.5 apart along them", trunk, 15, 0.5},
                         Row{"contours-40:1", "5.25 apart, samples 0.13 apart", trunk, 9, 0.13},
                         Row{"contours-branching", "two vessels that become one", branching, 17, 0.2},
                         Row{"contours-forked", "one vessel that parts in two", forked, 16, 0.3}}) {
    Case c = field_case(row.name, row.description, [=](Sources& sources, std::uint64_t) {
      return row.organ.contours(row.slices, row.step, sources.threads());
    });
    c.requirements = {equals("components", 1), equals("genus", 0), at_most("volume_error", 0.05),
                      at_least("flat_caps", 0.99)};
    c.measure_more = [organ = row.organ](const Scene&, const Result& result, Sources&, Figures& figures) {
      measure_flat_caps(organ, result.mesh, figures);
    };
    cases.push_back(std::move(c));
  }
}

/// A figure that is 1 where some warning holds the word, else 0.
void measure_warning(const Result& result, const std::string& figure, const std::string& word, Figures& figures) {
  const auto& warnings = result.report.warnings;
  figures.set(figure, std::any_of(warnings.begin(), warnings.end(),
                                  [&](const std::string& text) { return text.find(word) != std::string::npos; })
                          ? 1
                          : 0);
}

void add_smooth_cases(std::vector<Case>& cases) {
  const auto trefoil = [](double t) {
    return 3.0 * Vec3{std::sin(t) + 2 * std::sin(2 * t), std::cos(t) - 2 * std::cos(2 * t), -std::sin(3 * t)};
  };
  Case c = part_case("knot", "a knotted ring", fixed([=] { return closed_tube(trefoil, 1.2, 0.15); }), 0, 1);
  c.requirements.push_back(at_most("volume_error", 0.01));
  cases.push_back(std::move(c));
  struct Row {
    const char *name, *description;
    double length, gap, a, b, swing;
    unsigned per_ring;
    double volume_error;
  };
  for (const Row& row : {Row{"tunnel", "rings of points across a tunnel, its ends open", 30, 1, 3, 2.5, 3, 72, 0.01},
                         Row{"tunnel-sparse", "rings five samples' distance apart", 60, 2.5, 5, 4, 6, 60, 0.02}}) {
    c = field_case(row.name, row.description, [=](Sources& sources, std::uint64_t) {
      return tunnel(row.length, row.gap, row.a, row.b, row.swing, row.per_ring, sources.threads());
    });
    c.requirements = {equals("components", 1), equals("genus", 0), at_most("volume_error", row.volume_error)};
    cases.push_back(std::move(c));
  }
  const std::vector<std::vector<Cavity>> cavities{{{{0.42, 0, 0}, 0.5}},
                                                  {{{0.45, 0, 0.1}, 0.4}, {{-0.35, 0.2, 0}, 0.35}}};
  for (const auto& list : cavities) {
    c = field_case(
        "cavities-" + std::to_string(list.size()), "round cavities two spacings beneath a ball's surface",
        [=](Sources& sources, std::uint64_t) { return ball_with_cavities(1, list, 0.038, sources.threads()); });
    c.requirements = {equals("components", 1.0 + static_cast<double>(list.size())), equals("genus", 0),
                      at_most("volume_error", 0.01), at_least("true_samples_kept", 0.99)};
    cases.push_back(std::move(c));
  }
}

void add_noisy_cases(std::vector<Case>& cases) {
  struct Row {
    const char* name;
    std::size_t count;
    double noise;
    std::uint64_t seed;
  };
  for (const auto& [name, count, noise, seed] :
       {Row{"beside-noise1.7", 60'000, 1.7, 1}, Row{"beside-noise1", 30'000, 1, 2},
        Row{"beside-noise2.5", 60'000, 2.5, 3}}) {
    Case c = field_case(
        name, "a clean ball and a clean plate beside a ball with noise of " + short_number(noise) + " spacings",
        [n = count, sigma = noise](Sources& sources, std::uint64_t s) {
          return noisy_beside_clean(n, sigma, s, sources.threads());
        });
    c.seed = seed;
    c.requirements = {equals("components", 3), at_least("clean_rows_kept", 0.99)};
    cases.push_back(std::move(c));
  }
  Case c = field_case("bracket-noise3", "an L bracket, noise of 3 spacings", [](Sources& sources, std::uint64_t seed) {
    return part_scene(darted(bracket(), 30'000, seed), 3, seed, sources.threads());
  });
  c.requirements = {at_least("volume_iou", 0.6), equals("warns_of_noise", 1)};
  c.measure_more = [](const Scene& scene, const Result& result, Sources& sources, Figures& figures) {
    figures.set("volume_iou", volume_iou(result.mesh, *scene.truth.mesh, 256, sources.threads()));
    measure_warning(result, "warns_of_noise", "nois", figures);
  };
  cases.push_back(std::move(c));
}

void add_filled_cases(std::vector<Case>& cases) {
  struct Row {
    const char *name, *description;
    Vec3 half_axes;
    std::size_t count;
  };
  for (const Row& row : {Row{"filled-random", "points at random in an ellipsoid", {14, 10, 8}, 20'000},
                         Row{"filled-flat", "the same in a flat one", {20, 16, 4}, 8'000},
                         Row{"filled-voxels", "all whole-numbered points in an ellipsoid", {14, 10, 9}, 0}}) {
    Case c = field_case(row.name, row.description, [=](Sources& sources, std::uint64_t seed) {
      return filled_ellipsoid(row.half_axes, row.count, seed, sources.threads());
    });
    c.requirements = {equals("warns_of_filling", 1)};
    c.measure_more = [](const Scene&, const Result& result, Sources&, Figures& figures) {
      measure_warning(result, "warns_of_filling", "fill", figures);
    };
    cases.push_back(std::move(c));
  }
}

Part ball(double radius, double spacing) {
  constexpr unsigned pieces = 60;
  std::vector<ProfilePoint> profile;
  for (unsigned i = 0; i <= pieces; ++i) {
    const double u = pi * i / pieces;
    profile.push_back({i % pieces == 0 ? 0 : radius * std::sin(u), -radius * std::cos(u)});
  }
  return turned_part(profile, spacing);
}

/// Along z, its middle at the origin.
Part rod(double radius, double length, double spacing) {
  const double end = 0.5 * length;
  return turned_part(std::vector<ProfilePoint>{{0, -end}, {radius, -end}, {radius, end}, {0, end}}, spacing);
}

/// Bodies that were sampled one by one, as patches of the teapot in the paper's figure 10: solid where they overlap.
void add_overlap_cases(std::vector<Case>& cases) {
  struct Row {
    const char *name, *description;
    std::function<Part(std::uint64_t)> part;
    double noise;
  };
  const auto balls = fixed([] {
    // Two caps, each as high as half of what the distance leaves of the radii (Harris and Stocker 1998).
    constexpr double radius = 10, apart = 11, cap = radius - apart / 2;
    return through_each_other(ball(radius, 0.5), moved(ball(radius, 0.5), {apart, 0, 0}),
                              2 * pi * cap * cap * (radius - cap / 3));
  });
  const auto rods = fixed([] {
    constexpr double radius = 4; // Steinmetz' solid
    return through_each_other(rod(radius, 30, 0.4), laid_down(rod(radius, 30, 0.4)), 16 * radius * radius * radius / 3);
  });
  const auto ball_on_rod = [](std::uint64_t seed) {
    constexpr double radius = 10, hole = 4; // what a hole of the rod's radius takes from the ball
    const double left = std::pow(radius * radius - hole * hole, 1.5);
    const double in_common = 4 * pi / 3 * (radius * radius * radius - left);
    return through_each_other(ball(radius, 0.4), rotated(rod(hole, 40, 0.4), seed), in_common);
  };
  for (const Row& row : {Row{"overlap-balls", "two balls that go through each other, each sampled all over", balls, 0},
                         Row{"overlap-rods", "two rods across each other, each sampled all over", rods, 0},
                         Row{"overlap-ball-rod", "a rod through a ball, each sampled all over", ball_on_rod, 0},
                         Row{"overlap-rods-noise", "the rods with noise of 0.2 spacings", rods, 0.2}}) {
    Case c = part_case(row.name, row.description, row.part, row.noise, 0);
    c.requirements.insert(c.requirements.end(), {at_most("volume_error", 0.015), equals("warns_of_overlap", 1)});
    c.measure_more = [](const Scene&, const Result& result, Sources&, Figures& figures) {
      measure_warning(result, "warns_of_overlap", "overlap", figures);
    };
    cases.push_back(std::move(c));
  }
}

void add_tiny_cases(std::vector<Case>& cases) {
  const TriangleMesh prism{{{0, 0, 0}, {1, 0, 0}, {0.5, 0.9, 0}, {0, 0, 1}, {1, 0, 1}, {0.5, 0.9, 1}},
                           {{0, 2, 1}, {3, 4, 5}, {0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}, {2, 0, 3}, {2, 3, 5}},
                           {},
                           {}};
  const TriangleMesh octahedron{
      {{1, 0, 0}, {-1.2, 0, 0}, {0, 0.9, 0}, {0, -1, 0}, {0, 0, 1.1}, {0, 0, -0.8}},
      {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}},
      {},
      {}};
  struct Row {
    const char *name, *description;
    TriangleMesh mesh;
    bool turned;
  };
  for (const Row& row : {Row{"tiny-cube", "the 8 corners of a cube", shapes::box({0, 0, 0}, {1, 1, 1}), false},
                         Row{"tiny-brick", "the 8 corners of a brick", shapes::box({0, 0, 0}, {3, 2, 1}), false},
                         Row{"tiny-brick-turned", "the same turned in space", shapes::box({0, 0, 0}, {3, 2, 1}), true},
                         Row{"tiny-prism", "the 6 corners of a prism", prism, false},
                         Row{"tiny-octahedron", "6 points on three axes", octahedron, false}}) {
    Case c = part_case(
        row.name, row.description,
        [=](std::uint64_t seed) {
          Part part = mesh_part(row.mesh);
          return row.turned ? rotated(std::move(part), seed) : part;
        },
        0, 0);
    c.requirements.push_back(at_most("volume_error", 1e-9));
    cases.push_back(std::move(c));
  }
}

} // namespace

Case field_case(std::string name, std::string description, std::function<Scene(Sources&, std::uint64_t)> make) {
  Case c;
  c.group = "field";
  c.name = std::move(name);
  c.description = std::move(description);
  c.make = std::move(make);
  return c;
}

void add_field_cases(std::vector<Case>& cases) {
  add_thin_cases(cases);
  add_sharp_cases(cases);
  add_contour_cases(cases);
  add_smooth_cases(cases);
  add_noisy_cases(cases);
  add_filled_cases(cases);
  add_overlap_cases(cases);
  add_tiny_cases(cases);
}

} // namespace eigencrust::bench
