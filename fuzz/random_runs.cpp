// SPDX-License-Identifier: GPL-3.0-or-later
#include "random_runs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

namespace eigencrust::fuzz {
namespace {

/// Draws that are the same everywhere: the standard library's distributions are not.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : engine_(seed * 0x9e3779b97f4a7c15u + 1) {}
  double uniform() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  double between(double low, double high) { return low + (high - low) * uniform(); }
  std::uint32_t below(std::uint32_t n) { return static_cast<std::uint32_t>(engine_() % n); }
  bool one_in(std::uint32_t n) { return below(n) == 0; }
  double normal() { return std::sqrt(-2 * std::log(1 - uniform())) * std::cos(2 * std::numbers::pi * uniform()); }
  Vec3 in_cube() { return {between(-1, 1), between(-1, 1), between(-1, 1)}; }
  Vec3 on_sphere() {
    for (;;) {
      const Vec3 p = in_cube();
      if (const double length = norm(p); length > 0.1 && length <= 1) return (1 / length) * p;
    }
  }
  template <class T, std::size_t n>
  T among(const std::array<T, n>& values) {
    return values[below(n)];
  }

 private:
  std::mt19937_64 engine_;
};

double lattice(Dice& dice, std::uint32_t side) { return static_cast<double>(dice.below(side)); }

using Shape = Vec3 (*)(Dice&, std::uint32_t i, std::uint32_t n);
struct NamedShape {
  const char* name;
  Shape point;
};

Vec3 on_moment_curve(Dice&, std::uint32_t i, std::uint32_t n) {
  const double t = static_cast<double>(i) / n;
  return {t, t * t, t * t * t};
}

Vec3 on_cosphere(Dice& dice, std::uint32_t, std::uint32_t) { // all permutations lie on one sphere, exactly
  std::array<double, 3> v =
      dice.among(std::array<std::array<double, 3>, 4>{{{1, 4, 8}, {4, 4, 7}, {0, 0, 9}, {3, 6, 6}}});
  for (std::size_t k = 3; k-- > 1;) std::swap(v[k], v[dice.below(static_cast<std::uint32_t>(k + 1))]);
  for (double& x : v) x = dice.one_in(2) ? x : -x;
  return {v[0], v[1], v[2]};
}

constexpr std::array<NamedShape, 17> shapes{{
    {"ball", [](Dice& d, std::uint32_t, std::uint32_t) { return std::cbrt(d.uniform()) * d.on_sphere(); }},
    {"sphere", [](Dice& d, std::uint32_t, std::uint32_t) { return d.on_sphere(); }},
    {"noisy sphere", [](Dice& d, std::uint32_t, std::uint32_t) { return (1 + 0.1 * d.normal()) * d.on_sphere(); }},
    {"cosphere", on_cosphere},
    {"lattice",
     [](Dice& d, std::uint32_t, std::uint32_t) {
       return Vec3{lattice(d, 6), lattice(d, 6), lattice(d, 6)};
     }},
    {"corners",
     [](Dice& d, std::uint32_t, std::uint32_t) {
       return Vec3{lattice(d, 2), lattice(d, 2), lattice(d, 3)};
     }},
    {"flat",
     [](Dice& d, std::uint32_t, std::uint32_t) {
       return Vec3{d.uniform(), d.uniform(), 1e-14 * d.normal()};
     }},
    {"plane and strays",
     [](Dice& d, std::uint32_t i, std::uint32_t) {
       return i < 3 ? d.in_cube() : Vec3{lattice(d, 9), lattice(d, 9), 0};
     }},
    {"line and strays",
     [](Dice& d, std::uint32_t i, std::uint32_t) {
       return i < 4 ? d.in_cube() : Vec3{lattice(d, 99), 0, 0};
     }},
    {"moment curve", on_moment_curve},
    {"two skew lines",
     [](Dice&, std::uint32_t i, std::uint32_t n) {
       const double t = static_cast<double>(i / 2) / n;
       return i % 2 == 0 ? Vec3{t, 0, 0} : Vec3{0, t, 1};
     }},
    {"two balls",
     [](Dice& d, std::uint32_t i, std::uint32_t) {
       return d.on_sphere() + Vec3{i % 3 == 0 ? 2.5 : 0.0, 0, 0};
     }},
    {"shell", [](Dice& d, std::uint32_t i, std::uint32_t) { return (i % 2 == 0 ? 1.0 : 0.6) * d.on_sphere(); }},
    {"hidden shell", [](Dice& d, std::uint32_t i, std::uint32_t) { return (i % 8 == 0 ? 2.0 : 0.6) * d.on_sphere(); }},
    {"sheet",
     [](Dice& d, std::uint32_t, std::uint32_t) {
       const double x = d.between(-1, 1), y = d.between(-1, 1);
       return Vec3{x, y, 0.2 * std::sin(4 * x) * std::cos(3 * y) + 0.01 * d.normal()};
     }},
    {"tube",
     [](Dice& d, std::uint32_t, std::uint32_t) {
       const double u = d.between(0, 2 * std::numbers::pi);
       return Vec3{std::cos(u), std::sin(u), d.between(-3, 3)};
     }},
    {"all scales",
     [](Dice& d, std::uint32_t, std::uint32_t) { return std::pow(10.0, d.between(-12, 3)) * d.in_cube(); }},
}};

void place(Dice& dice, std::vector<Vec3>& points) {
  if (dice.one_in(3)) {
    const double scale = std::pow(10.0, dice.among(std::array{-28.0, -15.0, -6.0, 6.0, 15.0, 28.0}));
    for (Vec3& p : points) p = scale * p;
  }
  if (dice.one_in(4)) {
    const double far = std::pow(10.0, dice.among(std::array{1.0, 3.0, 6.0, 9.0, 16.0}));
    const Vec3 offset = far * dice.on_sphere();
    for (Vec3& p : points) p = p + offset;
  }
  if (dice.one_in(4))
    for (Vec3& p : points)
      p = {static_cast<double>(static_cast<float>(p.x)), static_cast<double>(static_cast<float>(p.y)),
           static_cast<double>(static_cast<float>(p.z))};
  if (dice.one_in(5)) // repeated rows
    for (std::size_t i = 1; i < points.size(); i += 3) points[i] = points[i / 2];
  if (dice.one_in(8))
    points[dice.below(static_cast<std::uint32_t>(points.size()))].y = std::numeric_limits<double>::quiet_NaN();
  if (dice.one_in(16)) points.back() = 1e29 * dice.in_cube();
}

void scan(Dice& dice, PointCloud& cloud) {
  const auto n = static_cast<std::uint32_t>(cloud.points.size());
  if (dice.one_in(4))
    for (std::uint32_t i = 0; i < n; ++i) cloud.scan_index.push_back(i % 3);
  if (!dice.one_in(3)) return;
  for (int k = 0; k < 3; ++k) {
    const bool parallel = dice.one_in(3);
    cloud.sensors.push_back({parallel ? dice.on_sphere() : 5 * dice.in_cube(), parallel});
  }
  for (std::uint32_t i = 0; i < n; ++i) cloud.sensor_of.push_back(dice.one_in(9) ? PointCloud::no_sensor : i % 3);
}

LengthChoice length(Dice& dice) {
  using Kind = LengthChoice::Kind;
  switch (dice.below(5)) {
    case 0:
      return {Kind::off, 0};
    case 1:
      return {Kind::length, std::pow(10.0, dice.between(-6, 2))};
    case 2:
      return {Kind::percent, dice.between(0.01, 30)};
    default:
      return {};
  }
}

void choose_method(Dice& dice, Options& o) {
  if (dice.one_in(3)) o.weights = dice.one_in(2) ? Weights::evidence : Weights::paper;
  if (dice.one_in(3))
    o.second_stage = dice.among(std::array{SecondStage::cut, SecondStage::harmonic, SecondStage::eigenvector});
  if (dice.one_in(6)) o.solver.eigensolver = Eigensolver::lanczos;
  if (dice.one_in(6)) o.solver.max_steps = 1 + dice.below(4);
  if (dice.one_in(3))
    o.questionable = dice.among(std::array{Questionable::before, Questionable::after, Questionable::never});
  if (dice.one_in(4)) o.global_sign = dice.one_in(2) ? GlobalSign::vote : GlobalSign::supernode;
  if (dice.one_in(4)) o.manifold_rule = dice.one_in(2) ? ManifoldRule::cheapest : ManifoldRule::paper;
  if (dice.one_in(8)) o.manifold = false;
  o.noise = length(dice);
  o.grid_spacing = length(dice);
}

SurfaceLength surface_length(Dice& dice) {
  using Kind = SurfaceLength::Kind;
  switch (dice.below(3)) {
    case 0:
      return {Kind::length, std::pow(10.0, dice.between(-3, 0))};
    case 1:
      return {Kind::percent, dice.between(0.01, 30)};
    default:
      return {Kind::sigma, dice.between(0.1, 3)};
  }
}

void choose_triangles(Dice& dice, Options& o) {
  if (!o.manifold || !dice.one_in(3)) return;
  if (dice.one_in(3)) {
    // Whatever the cloud's size, not hundreds of triangles for each sample.
    o.edge = {SurfaceLength::Kind::percent, dice.between(3, 30)};
    return;
  }
  const bool by_error = dice.one_in(2);
  if (by_error) o.max_error = surface_length(dice);
  if (!by_error || dice.one_in(4)) o.triangles = 1 + dice.below(dice.one_in(2) ? 20 : 400);
}

void choose_surface(Dice& dice, Options& o) {
  if (dice.one_in(2)) o.surface = dice.one_in(2) ? SurfaceKind::automatic : SurfaceKind::fitted;
  if (!o.trim && dice.one_in(6)) o.base = true;
  if (!dice.one_in(8)) return;
  o.method = dice.among(std::array{Method::powercrust, Method::spectral_powercrust, Method::tight_cocone,
                                   Method::robust_cocone, Method::spectral_cocone});
  if (o.method == Method::spectral_cocone) return;
  o.facade.reset();
  o.point_results = o.base = o.trim = false;
  if (o.method == Method::powercrust || o.method == Method::spectral_powercrust) o.surface = SurfaceKind::automatic;
}

Options options_of(Dice& dice, const PointCloud& cloud) {
  Options o = Options::of(dice.one_in(3) ? Preset::paper : Preset::robust);
  choose_method(dice, o);
  if (dice.one_in(2))
    o.components = {dice.among(std::array{KeepComponents::Kind::supported, KeepComponents::Kind::all,
                                          KeepComponents::Kind::largest, KeepComponents::Kind::count}),
                    1 + dice.below(3)};
  if (dice.one_in(4)) o.smooth = 1 + dice.below(12);
  if (dice.one_in(2)) o.smoothing = Smoothing::taubin;
  if (dice.one_in(3))
    o.facade =
        dice.among(std::array{Axis::plus_x, Axis::minus_x, Axis::plus_y, Axis::minus_y, Axis::plus_z, Axis::minus_z});
  if (dice.one_in(3)) o.detect_facade = false;
  if (dice.one_in(5)) o.trim = true;
  if (dice.one_in(6)) o.crossing_depth = dice.between(0, 0.1);
  const auto near = [&] {
    return cloud.points[dice.below(static_cast<std::uint32_t>(cloud.points.size()))] + 0.3 * dice.in_cube();
  };
  if (dice.one_in(8)) o.outside_points.push_back(near());
  if (dice.one_in(8)) o.inside_points.push_back(near());
  if (dice.one_in(3)) o.point_results = true;
  if (dice.one_in(16)) o.max_memory = 12'000'000 + 2000u * dice.below(400);
  choose_surface(dice, o);
  if (o.method == Method::eigencrust || o.method == Method::spectral_cocone) choose_triangles(dice, o);
  o.threads = 1;
  return o;
}

} // namespace

RandomRun random_run(std::uint64_t seed) {
  Dice dice(seed);
  RandomRun run;
  const NamedShape& shape = dice.among(shapes);
  run.shape = shape.name;
  const std::uint32_t most = dice.one_in(8) ? 600 : dice.one_in(2) ? 40 : 150, n = 4 + dice.below(most);
  for (std::uint32_t i = 0; i < n; ++i) run.cloud.points.push_back(shape.point(dice, i, n));
  place(dice, run.cloud.points);
  scan(dice, run.cloud);
  run.options = options_of(dice, run.cloud);
  return run;
}

std::string describe(const Options& o) {
  std::string text = "--preset " + to_string(o.preset) + " --weights " + to_string(o.weights) + " --second-stage " +
                     to_string(o.second_stage) + " --eigensolver " + to_string(o.solver.eigensolver) + " --max-steps " +
                     std::to_string(o.solver.max_steps) + " --questionable " + to_string(o.questionable) + " --noise " +
                     to_string(o.noise) + " --grid-spacing " + to_string(o.grid_spacing) + " --components " +
                     to_string(o.components) + " --smooth " + std::to_string(o.smooth) + " --smoothing " +
                     to_string(o.smoothing) + " --surface " + to_string(o.surface) + " --method " +
                     to_string(o.method) + " (sign: " + to_string(o.global_sign) +
                     ", manifold rule: " + to_string(o.manifold_rule) + ")";
  if (o.triangles > 0) text += " --triangles " + std::to_string(o.triangles);
  if (o.max_error.kind != SurfaceLength::Kind::off) text += " --max-error '" + to_string(o.max_error) + "'";
  if (o.edge.kind != SurfaceLength::Kind::off) text += " --edge '" + to_string(o.edge) + "'";
  if (!o.manifold) text += " --no-manifold";
  text += o.facade ? " --facade=" + to_string(*o.facade) : o.detect_facade ? "" : " --facade off";
  if (o.base) text += " --base";
  if (o.trim) text += " --trim";
  if (o.crossing_depth) text += " --crossing-depth " + std::to_string(*o.crossing_depth);
  if (o.max_memory > 0) text += " --max-memory " + std::to_string(o.max_memory);
  if (!o.outside_points.empty()) text += " --outside-point ...";
  if (!o.inside_points.empty()) text += " --inside-point ...";
  if (o.point_results) text += " (orient)";
  return text;
}

} // namespace eigencrust::fuzz
