// SPDX-License-Identifier: GPL-3.0-or-later
#include "fit_scenes.h"

#include <array>
#include <cmath>
#include <numbers>

#include <eigencrust/io.h>
#include <eigencrust/metrics.h>
#include <eigencrust/validate.h>

#include "degradations.h"
#include "geometry/mesh_topology.h"
#include "parallel/threads.h"

namespace eigencrust::bench {
namespace {

constexpr double sharp = 40 * std::numbers::pi / 180;

/// Quads between the rings i and i + 1 of each of the four outlines of an extruded ring.
TriangleMesh extruded_ring(const std::vector<Vec3>& inner, const std::vector<Vec3>& outer, double height) {
  TriangleMesh mesh;
  const auto n = static_cast<std::uint32_t>(inner.size());
  for (const double z : {0.0, height})
    for (const std::vector<Vec3>* outline : {&inner, &outer})
      for (const Vec3& p : *outline) mesh.vertices.push_back({p.x, p.y, z});
  const std::array<std::array<std::uint32_t, 2>, 4> walls{{{0, 1}, {1, 3}, {3, 2}, {2, 0}}}; // of outlines, turning
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t j = (i + 1) % n;
    for (const auto& [a, b] : walls) {
      mesh.triangles.push_back({a * n + i, b * n + j, b * n + i});
      mesh.triangles.push_back({a * n + i, a * n + j, b * n + j});
    }
  }
  return mesh;
}

} // namespace

std::vector<Vec3> points_on_sharp_edges(const TriangleMesh& mesh, double step) {
  std::vector<Vec3> points;
  const std::vector<Side> sides = sorted_sides(mesh.triangles, mesh.vertices.size(), Threads(1));
  for_each_edge(sides, [&](std::span<const Side> edge) {
    if (edge.size() != 2) return;
    const Vec3 a = area_vector(mesh, edge[0].triangle()), b = area_vector(mesh, edge[1].triangle());
    if (std::atan2(norm(cross(a, b)), dot(a, b)) < sharp) return;
    const Vec3 &from = mesh.vertices[edge[0].low], &to = mesh.vertices[edge[0].high];
    const int count = 1 + static_cast<int>(distance(from, to) / step);
    for (int i = 0; i < count; ++i) points.push_back(from + ((i + 0.5) / count) * (to - from));
  });
  return points;
}

Truth gear() {
  constexpr int teeth = 18, steps = 4; // each straight piece of the outline in so many
  constexpr double bore = 3, root = 8, tip = 10, height = 4;
  constexpr std::array<std::array<double, 2>, 4> tooth{{{0.25, root}, {0.375, tip}, {0.625, tip}, {0.75, root}}};
  std::vector<Vec3> corners, inner, outer;
  for (int t = 0; t < teeth; ++t)
    for (const auto& [turn, radius] : tooth) {
      const double angle = 2 * std::numbers::pi * (t + turn) / teeth;
      corners.push_back({radius * std::cos(angle), radius * std::sin(angle), 0});
    }
  for (std::size_t i = 0; i < corners.size(); ++i)
    for (int s = 0; s < steps; ++s) {
      const Vec3 p = corners[i] + (static_cast<double>(s) / steps) * (corners[(i + 1) % corners.size()] - corners[i]);
      outer.push_back(p);
      inner.push_back((bore / norm(p)) * p);
    }
  return truth_of(extruded_ring(inner, outer, height));
}

Truth cube() {
  constexpr double size = 10;
  TriangleMesh mesh;
  for (unsigned i = 0; i < 8; ++i) mesh.vertices.push_back({i & 1 ? size : 0, i & 2 ? size : 0, i & 4 ? size : 0});
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return truth_of(mesh);
}

const std::vector<FitShape>& fit_shapes() {
  static const std::vector<FitShape> shapes{
      {"horse", "meshes/horse.ply"}, {"armadillo", "meshes/armadillo.obj"}, {"gear", ""},
      {"angel", "meshes/angel.obj"}, {"fandisk", "meshes/fandisk.18k.obj"}, {"cube", ""}};
  return shapes;
}

Truth truth_of(const FitShape& shape, const std::filesystem::path& data) {
  if (shape.file.empty()) return shape.name == "gear" ? gear() : cube();
  return truth_of(read_mesh(data / shape.file));
}

FitScene fit_scene(const Truth& truth, std::size_t samples, double sigma, std::uint64_t seed) {
  const TriangleMesh& mesh = *truth.mesh;
  std::vector<std::uint32_t> triangle_of;
  FitScene scene;
  scene.cloud.points = sample_surface(mesh, samples, seed, &triangle_of);
  scene.spacing = std::sqrt(validate(mesh, {.self_intersections = false}).area / static_cast<double>(samples));
  std::array<std::vector<double>, 3> normal;
  for (const std::uint32_t t : triangle_of) {
    const Vec3 area = area_vector(mesh, t), n = (1 / norm(area)) * area;
    normal[0].push_back(n.x);
    normal[1].push_back(n.y);
    normal[2].push_back(n.z);
  }
  for (std::size_t k = 0; k < 3; ++k)
    scene.cloud.attributes.push_back(make_attribute(std::string("n") + "xyz"[k], ScalarType::float64, normal[k]));
  if (sigma > 0) add_noise(scene.cloud.points, sigma * scene.spacing, seed + 1);
  scene.on_edge = points_on_sharp_edges(mesh, 0.2 * scene.spacing);
  return scene;
}

} // namespace eigencrust::bench
