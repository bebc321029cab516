// SPDX-License-Identifier: GPL-3.0-or-later
#include "surface/rim_strays.h"

#include <algorithm>
#include <cmath>

#include "geometry/mesh_topology.h"
#include "samples/scales.h"

namespace eigencrust {
namespace {

// So many strays stand side by side at most; the first samples of a coarse part stand in a long row.
constexpr std::uint32_t strays_together = 4;

/// Vertices that stand apart from others, alone or a few side by side.
class Loners {
 public:
  Loners(const SampleModel& model, const Surface& surface)
      : model_(model), surface_(surface), lonely_(surface.mesh.vertices.size(), 0), few_(lonely_.size(), 0) {
    for (const auto& triangle : surface.mesh.triangles)
      for (const std::uint32_t v : triangle)
        for (const std::uint32_t other : triangle) lonely_[v] |= stands_apart(v, other);
    find_few();
  }

  /// From a neighbour; from another one of the same few it need not.
  [[nodiscard]] bool is_apart(std::uint32_t v, std::uint32_t other) const {
    return stands_apart(v, other) || (few_[v] && lonely_[other]);
  }

 private:
  [[nodiscard]] bool stands_apart(std::uint32_t v, std::uint32_t other) const {
    const SampleIndex a = surface_.sample_of[v], b = surface_.sample_of[other];
    if (model_.isolated[a] > 0) return !(model_.isolated[b] > 0); // its spacing is that of the surface
    return static_cast<double>(model_.spacing[a]) > isolation * static_cast<double>(model_.spacing[b]);
  }

  void find_few() {
    DisjointSets groups(lonely_.size());
    for (const auto& [a, b, c] : surface_.mesh.triangles)
      for (const auto& [v, next] : {std::pair{a, b}, std::pair{b, c}, std::pair{c, a}})
        if (lonely_[v] && lonely_[next]) groups.unite(v, next);
    std::vector<std::uint32_t> members(lonely_.size(), 0);
    for (std::uint32_t v = 0; v < lonely_.size(); ++v) members[groups.find(v)] += lonely_[v];
    for (std::uint32_t v = 0; v < lonely_.size(); ++v)
      few_[v] = lonely_[v] && members[groups.find(v)] <= strays_together;
  }

  const SampleModel& model_;
  const Surface& surface_;
  std::vector<std::uint8_t> lonely_, few_;
};

} // namespace

std::vector<std::uint8_t> triangles_at_strays(const SampleModel& model, const Surface& surface) {
  const TriangleMesh& mesh = surface.mesh;
  const Loners loners(model, surface);
  std::vector<double> around(mesh.vertices.size(), 0), apart(mesh.vertices.size(), 0); // angles
  for (const auto& triangle : mesh.triangles)
    for (std::size_t k = 0; k < triangle.size(); ++k) {
      const std::uint32_t v = triangle[k], a = triangle[(k + 1) % 3], b = triangle[(k + 2) % 3];
      const Vec3 to_a = mesh.vertices[a] - mesh.vertices[v], to_b = mesh.vertices[b] - mesh.vertices[v];
      const double angle = std::atan2(norm(cross(to_a, to_b)), dot(to_a, to_b));
      around[v] += angle;
      if (loners.is_apart(v, a) && loners.is_apart(v, b)) apart[v] += angle;
    }
  // Where samples become coarse all at once, half of what lies around the first coarse ones is as coarse as they are.
  const auto is_stray = [&](std::uint32_t v) { return 2 * apart[v] > around[v]; };
  std::vector<std::uint8_t> marked(mesh.triangles.size());
  std::transform(mesh.triangles.begin(), mesh.triangles.end(), marked.begin(),
                 [&](const auto& triangle) { return std::any_of(triangle.begin(), triangle.end(), is_stray); });
  return marked;
}

} // namespace eigencrust
