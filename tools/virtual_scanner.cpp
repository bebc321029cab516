// SPDX-License-Identifier: GPL-3.0-or-later
#include "virtual_scanner.h"

#include <cmath>
#include <numbers>
#include <optional>
#include <string>

#include <eigencrust/error.h>
#include <eigencrust/io.h>
#include <eigencrust/metrics.h>

#include "counter_random.h"
#include "parallel/threads.h"

namespace eigencrust::tools {
namespace {

/// Which random number serves what: an option switched on does not change the numbers of the others.
enum Draw : std::uint64_t {
  draw_dropout = 0,
  draw_outlier = 1,
  draw_outlier_place = 2,  // 3 numbers
  draw_range_noise = 5,    // 2
  draw_isotropic_noise = 7 // 3 × 2
};

/// Rays are traced in pieces of this length; it decides nothing but the load of the threads.
constexpr std::size_t rays_per_block = 2048;

struct Return {
  Vec3 point, origin;
  double range = 0;
  double surface_distance = 0;
  std::uint32_t sensor = 0;
  bool outlier = false;
};

void check(const ScanOptions& o, std::size_t sensors) {
  const auto need = [](bool fine, const char* option, const char* remedy) {
    if (!fine) throw Error(ErrorKind::usage, option, "the value is out of range", remedy);
  };
  const auto length = [](double value) { return value >= 0 && std::isfinite(value); };
  const auto share = [](double value) { return value >= 0 && value <= 1; };
  need(length(o.range_noise), "--noise", "give a length, 0 or more");
  need(length(o.isotropic_noise), "--isotropic-noise", "give a length, 0 or more");
  need(length(o.range_quantum), "--quantize", "give a length, 0 or more");
  need(o.max_incidence > 0 && o.max_incidence <= 90, "--max-incidence", "give more than 0, at most 90 degrees");
  need(share(o.dropout), "--dropout", "give a fraction from 0 to 1");
  need(share(o.outlier_fraction), "--outliers", "give a fraction from 0 to 1");
  need(o.outlier_box > 0 && std::isfinite(o.outlier_box), "--outlier-box", "give a factor above 0");
  if (sensors == 0 || sensors > 65536)
    throw Error(ErrorKind::usage, "sensors", std::to_string(sensors) + " sensors", "give 1 to 65536");
}

Box3 checked_bounds(const TriangleMesh& mesh) {
  Box3 box;
  if (mesh.triangles.empty())
    throw Error(ErrorKind::input, "mesh", "there are no triangles to scan", "give a mesh, not a cloud");
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t v : triangle) {
      if (v >= mesh.vertices.size())
        throw Error(ErrorKind::input, "mesh", "a triangle names vertex " + std::to_string(v) + ", which is not there",
                    "repair the mesh");
      if (!is_finite(mesh.vertices[v]))
        throw Error(ErrorKind::input, "mesh", "vertex " + std::to_string(v) + " is not finite", "repair the mesh");
      box.add(mesh.vertices[v]);
    }
  return box;
}

class Scanner {
 public:
  Scanner(const TriangleMesh& mesh, const ScanOptions& options)
      : mesh_(mesh),
        options_(options),
        box_(checked_bounds(mesh)),
        tree_(mesh),
        least_cosine_(std::cos(std::numbers::pi / 180 * options.max_incidence)) {}

  [[nodiscard]] std::optional<Return> trace(const RayGrid& grid, std::uint32_t sensor, std::uint64_t index) const {
    const Ray ray = grid.ray(index);
    const TriangleTree::Hit hit = tree_.first_hit(ray.origin, ray.direction);
    if (!hit.valid() || !returns(ray, hit)) return std::nullopt;
    const CounterRandom random(options_.seed, sensor, index);
    if (random.uniform(draw_dropout) < options_.dropout) return std::nullopt;

    Return result;
    result.origin = ray.origin;
    result.sensor = sensor;
    result.outlier = random.uniform(draw_outlier) < options_.outlier_fraction;
    if (result.outlier)
      place_outlier(result, ray, hit.distance, random);
    else
      place_on_surface(result, ray, hit.distance, random);
    if (options_.truth) result.surface_distance = tree_.nearest(result.point).distance;
    return result;
  }

 private:
  [[nodiscard]] bool returns(const Ray& ray, const TriangleTree::Hit& hit) const {
    const auto& [a, b, c] = mesh_.triangles[hit.triangle];
    const Vec3 normal = cross(mesh_.vertices[b] - mesh_.vertices[a], mesh_.vertices[c] - mesh_.vertices[a]);
    const double cosine = -dot(normal, ray.direction) / norm(normal);
    if (options_.drop_back_faces && !(cosine > 0)) return false;
    return options_.max_incidence == 90 || std::abs(cosine) >= least_cosine_;
  }

  void place_on_surface(Return& result, const Ray& ray, double range, const CounterRandom& random) const {
    if (options_.range_noise > 0) range += options_.range_noise * random.normal(draw_range_noise);
    if (options_.range_quantum > 0) range = std::round(range / options_.range_quantum) * options_.range_quantum;
    result.range = range;
    result.point = ray.origin + range * ray.direction;
    if (options_.isotropic_noise > 0) {
      const std::uint64_t draw = draw_isotropic_noise;
      result.point = result.point + options_.isotropic_noise *
                                        Vec3{random.normal(draw), random.normal(draw + 2), random.normal(draw + 4)};
    }
  }

  void place_outlier(Return& result, const Ray& ray, double range, const CounterRandom& random) const {
    const std::uint64_t draw = draw_outlier_place;
    if (options_.outliers == OutlierKind::box) {
      const Vec3 half = (0.5 * options_.outlier_box) * (box_.max - box_.min);
      const Vec3 t{2 * random.uniform(draw) - 1, 2 * random.uniform(draw + 1) - 1, 2 * random.uniform(draw + 2) - 1};
      result.point = box_.centre() + Vec3{half.x * t.x, half.y * t.y, half.z * t.z};
    } else {
      result.point = ray.origin + (range * random.uniform(draw)) * ray.direction;
    }
    result.range = distance(result.point, ray.origin);
  }

  const TriangleMesh& mesh_;
  const ScanOptions& options_;
  Box3 box_;
  TriangleTree tree_;
  double least_cosine_;
};

template <class Value>
Attribute column(const char* name, ScalarType type, const std::vector<Return>& returns, Value&& value) {
  std::vector<double> values;
  values.reserve(returns.size());
  for (const Return& r : returns) values.push_back(value(r));
  return make_attribute(name, type, values);
}

PointCloud to_cloud(const std::vector<Return>& returns, std::size_t sensors, bool truth) {
  PointCloud cloud;
  for (const Return& r : returns) {
    cloud.points.push_back(r.point);
    cloud.scan_index.push_back(r.sensor);
  }
  const auto add = [&](const char* name, ScalarType type, auto&& value) {
    cloud.attributes.push_back(column(name, type, returns, value));
  };
  add("sx", ScalarType::float32, [](const Return& r) { return r.origin.x; });
  add("sy", ScalarType::float32, [](const Return& r) { return r.origin.y; });
  add("sz", ScalarType::float32, [](const Return& r) { return r.origin.z; });
  add("scan", sensors <= 256 ? ScalarType::uint8 : ScalarType::uint16, [](const Return& r) { return r.sensor; });
  add("range", ScalarType::float32, [](const Return& r) { return r.range; });
  if (truth) {
    add("surface_distance", ScalarType::float32, [](const Return& r) { return r.surface_distance; });
    add("outlier", ScalarType::uint8, [](const Return& r) { return r.outlier ? 1.0 : 0.0; });
  }
  return cloud;
}

} // namespace

PointCloud scan(const TriangleMesh& mesh, const std::vector<Sensor>& sensors, const ScanOptions& options) {
  check(options, sensors.size());
  const std::vector<RayGrid> grids(sensors.begin(), sensors.end());
  const Scanner scanner(mesh, options);
  const Threads threads(options.threads);
  std::vector<Return> returns;
  for (std::uint32_t s = 0; s < grids.size(); ++s) {
    const std::size_t rays = grids[s].size();
    std::vector<std::vector<Return>> of_block((rays + rays_per_block - 1) / rays_per_block);
    for_blocks(threads, rays, rays_per_block, [&](std::size_t begin, std::size_t end, std::size_t block) {
      for (std::size_t i = begin; i < end; ++i)
        if (const auto found = scanner.trace(grids[s], s, i)) of_block[block].push_back(*found);
    });
    for (const auto& block : of_block) returns.insert(returns.end(), block.begin(), block.end());
  }
  return to_cloud(returns, sensors.size(), options.truth);
}

} // namespace eigencrust::tools
