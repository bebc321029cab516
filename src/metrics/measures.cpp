// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <numbers>

#include <eigencrust/measures.h>
#include <eigencrust/metrics.h>

#include "geometry/mesh_topology.h"
#include "parallel/threads.h"

namespace eigencrust {
namespace {

constexpr std::size_t block_size = 4096; ///< triangles

/// Extremes over a block of triangles.
struct Shapes {
  double smallest_angle = std::numbers::pi, largest_angle = 0, worst_aspect = 0; // radians
  double shortest = std::numeric_limits<double>::infinity(), longest = 0;
  bool any = false; ///< a triangle with an area

  Shapes operator+(const Shapes& o) const {
    return {std::min(smallest_angle, o.smallest_angle),
            std::max(largest_angle, o.largest_angle),
            std::max(worst_aspect, o.worst_aspect),
            std::min(shortest, o.shortest),
            std::max(longest, o.longest),
            any || o.any};
  }
};

/// \param sides receives the lengths of the sides
void add_triangle(const std::array<Vec3, 3>& corner, Shapes& shapes, double* sides) {
  std::array<double, 3> length;
  for (std::size_t k = 0; k < 3; ++k) {
    length[k] = sides[k] = distance(corner[k], corner[(k + 1) % 3]);
    shapes.shortest = std::min(shapes.shortest, length[k]);
    shapes.longest = std::max(shapes.longest, length[k]);
  }
  const double twice_area = norm(cross(corner[1] - corner[0], corner[2] - corner[0]));
  if (!(twice_area > 0)) return;
  shapes.any = true;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 a = corner[(k + 1) % 3] - corner[k], b = corner[(k + 2) % 3] - corner[k];
    const double angle = std::atan2(norm(cross(a, b)), dot(a, b));
    shapes.smallest_angle = std::min(shapes.smallest_angle, angle);
    shapes.largest_angle = std::max(shapes.largest_angle, angle);
  }
  const double longest = *std::max_element(length.begin(), length.end());
  shapes.worst_aspect = std::max(
      shapes.worst_aspect, longest * (length[0] + length[1] + length[2]) / (2 * std::numbers::sqrt3 * twice_area));
}

void measure_triangles(const TriangleMesh& mesh, const Threads& threads, MeshMeasures& measures) {
  std::vector<double> sides(3 * mesh.triangles.size());
  std::vector<Shapes> partial((mesh.triangles.size() + block_size - 1) / block_size);
  for_blocks(threads, mesh.triangles.size(), block_size, [&](std::size_t begin, std::size_t end, std::size_t block) {
    for (std::size_t t = begin; t < end; ++t) {
      const Triangle& v = mesh.triangles[t];
      add_triangle({mesh.vertices[v[0]], mesh.vertices[v[1]], mesh.vertices[v[2]]}, partial[block], &sides[3 * t]);
    }
  });
  const Shapes all = std::accumulate(partial.begin(), partial.end(), Shapes{});
  if (all.any) {
    constexpr double degrees = 180 / std::numbers::pi;
    measures.smallest_angle = degrees * all.smallest_angle;
    measures.largest_angle = degrees * all.largest_angle;
    measures.worst_aspect = all.worst_aspect;
  }
  if (sides.empty()) return;
  measures.shortest_edge = all.shortest;
  measures.longest_edge = all.longest;
  const auto middle = sides.begin() + static_cast<std::ptrdiff_t>(sides.size() / 2);
  std::nth_element(sides.begin(), middle, sides.end());
  measures.median_edge = *middle;
}

/// Rays from the middle of triangles into the body.
class WallProbe {
 public:
  /// \param mesh closed and oriented \param inward does its volume count negative?
  WallProbe(const TriangleMesh& mesh, const Box3& bounds, bool inward)
      : origin_(bounds.centre()), inside_(inward ? 1 : -1) {
    mesh_.triangles = mesh.triangles;
    mesh_.vertices.reserve(mesh.vertices.size());
    for (const Vec3& v : mesh.vertices) mesh_.vertices.push_back(v - origin_); // far from 0 rays would start beside
    start_ = start_share * distance(bounds.min, bounds.max);
    tree_ = std::make_unique<TriangleTree>(mesh_);
  }

  /// How thick the body is behind triangle t; infinite where no side faces it.
  [[nodiscard]] double thickness(std::uint32_t t) const {
    constexpr double none = std::numeric_limits<double>::infinity();
    const auto normal = normal_of(t);
    if (!normal) return none;
    const Vec3 direction = inside_ * *normal;
    const TriangleTree::Hit hit = tree_->first_hit(middle(t) + start_ * direction, direction);
    if (!hit.valid()) return none;
    const auto opposite = normal_of(hit.triangle);
    if (!opposite || -inside_ * dot(*opposite, direction) < facing) return none;
    return hit.distance + start_;
  }
  [[nodiscard]] Vec3 place(std::uint32_t t) const { return middle(t) + origin_; }

 private:
  /// Sides face one another where they are within 45° of parallel: edges that are less sharp are no thin walls.
  static constexpr double facing = std::numbers::sqrt2 / 2;
  /// Of the diagonal: far more than what rounding moves, far less than any wall. Rays would hit where they start.
  static constexpr double start_share = 1e-9;

  [[nodiscard]] Vec3 middle(std::uint32_t t) const {
    const Triangle& v = mesh_.triangles[t];
    return (1.0 / 3) * (mesh_.vertices[v[0]] + mesh_.vertices[v[1]] + mesh_.vertices[v[2]]);
  }
  [[nodiscard]] std::optional<Vec3> normal_of(std::uint32_t t) const {
    const Triangle& v = mesh_.triangles[t];
    const Vec3& a = mesh_.vertices[v[0]];
    const Vec3 n = cross(mesh_.vertices[v[1]] - a, mesh_.vertices[v[2]] - a);
    const double length = norm(n);
    if (!(length > 0)) return std::nullopt;
    return (1 / length) * n;
  }

  TriangleMesh mesh_;
  Vec3 origin_;
  double inside_, start_ = 0;
  std::unique_ptr<TriangleTree> tree_;
};

struct Probe {
  double thickness;
  std::uint32_t triangle;
  auto operator<=>(const Probe&) const = default;
};

std::vector<double> areas_of(const TriangleMesh& mesh) {
  std::vector<double> areas;
  areas.reserve(mesh.triangles.size());
  for (const Triangle& v : mesh.triangles)
    areas.push_back(norm(cross(mesh.vertices[v[1]] - mesh.vertices[v[0]], mesh.vertices[v[2]] - mesh.vertices[v[0]])) /
                    2);
  return areas;
}

/// How large a patch must be to be a wall: noise folds single triangles, and what is thinner than a fold is none.
double least_patch(const std::vector<double>& areas) {
  constexpr double triangles = 20; // four or five edges across
  constexpr double share = 0.01;   // of the surface, where a mesh has few triangles
  std::vector<double> sorted = areas;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  return std::min(triangles * *middle, share * std::accumulate(areas.begin(), areas.end(), 0.0));
}

/// The first triangle, in the order of thickness, that completes a patch large enough of such that share vertices.
/// \param probes sorted \param step of how many triangles each is one
const Probe* first_patch(const TriangleMesh& mesh, const std::vector<Probe>& probes, std::size_t step) {
  std::vector<double> area = areas_of(mesh); // at the root of a set that of all
  const double least = least_patch(area) / static_cast<double>(step);
  DisjointSets sets(mesh.triangles.size());
  std::vector<std::uint32_t> met(mesh.vertices.size(), no_index);
  for (const Probe& probe : probes) {
    std::uint32_t root = probe.triangle;
    for (const std::uint32_t v : mesh.triangles[probe.triangle]) {
      const std::uint32_t other = met[v] == no_index ? root : sets.find(met[v]);
      met[v] = probe.triangle;
      if (other == root) continue;
      const double both = area[root] + area[other];
      sets.unite(root, other);
      root = sets.find(root);
      area[root] = both;
    }
    if (area[root] >= least) return &probe;
  }
  return nullptr;
}

void measure_walls(const TriangleMesh& mesh, const MeshSummary& summary, const MeasureOptions& options,
                   const Threads& threads, MeshMeasures& measures) {
  if (!summary.closed() || !summary.oriented() || options.most_rays == 0) return;
  const WallProbe walls(mesh, summary.bounds, summary.volume < 0);
  const std::size_t step = (mesh.triangles.size() + options.most_rays - 1) / options.most_rays;
  std::vector<Probe> probes((mesh.triangles.size() + step - 1) / step);
  measures.wall_rays = probes.size();
  for_blocks(threads, probes.size(), block_size, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto t = static_cast<std::uint32_t>(i * step);
      probes[i] = {walls.thickness(t), t};
    }
  });
  std::erase_if(probes, [](const Probe& p) { return !(p.thickness < std::numeric_limits<double>::infinity()); });
  std::sort(probes.begin(), probes.end());
  const Probe* found = first_patch(mesh, probes, step);
  if (found == nullptr) return;
  measures.thinnest_wall = found->thickness;
  measures.thinnest_place = walls.place(found->triangle);
}

} // namespace

MeshMeasures measure(const TriangleMesh& mesh, const MeshSummary& summary, const MeasureOptions& options) {
  require_valid_indices(mesh, "measure");
  const Threads threads(options.threads);
  MeshMeasures measures;
  measure_triangles(mesh, threads, measures);
  measure_walls(mesh, summary, options, threads, measures);
  return measures;
}

} // namespace eigencrust
