// SPDX-License-Identifier: GPL-3.0-or-later
#include "evidence/walls.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>

#include "evidence/hull.h"
#include "evidence/next_sheet.h"
#include "geometry/mesh_topology.h"
#include "geometry/nearest.h"
#include "samples/local_frame.h"
#include "samples/scales.h"
#include "tetrahedra/assemble.h"

namespace eigencrust {
namespace {

// Walls lean by at most 30°, windows set back and ledges included, and turn by less from one hull triangle to the next
// and to their samples: sine and cosine.
constexpr double most_leaning_wall = 0.5, one_wall = 0.866;
// What is before a wall is looked at so many spacings deep, as far as no other surface is met: past what the wall
// itself hides before its windows.
constexpr double far_before = 40;

/// A hull triangle along the axis, and what the samples at its corners say.
struct UprightTriangle {
  HullTriangle hull;
  double free = 0; ///< of those that are of a wall: before how many there is free space, less the others
};

class Walls {
 public:
  Walls(const Scene& scene, const Vec3& front, const HiddenCounts& hidden, const Labels& named)
      : scene_(scene), front_(front), hidden_(hidden), named_(named), tree_(samples_of(scene.tetrahedralization)) {}

  /// \return nothing for a sample that is not of a wall along the hull; above 0 where the wall looks into free space,
  /// on the side away from `outward`
  [[nodiscard]] std::optional<double> free_before(SampleIndex s, const Vec3& outward) const {
    const Tetrahedralization& t = scene_.tetrahedralization;
    const Vec3& p = t.positions[s];
    std::array<std::uint32_t, enough_around> around{};
    std::array<double, enough_around> square{};
    const std::size_t found = tree_.nearest(p, around.size(), around.data(), square.data());
    const LocalFrame frame = local_frame(samples_of(t), std::span(around).first(found), p);
    if (!frame.is_flat() || std::fabs(dot(frame.axis[0], front_)) > most_leaning_wall) return std::nullopt;
    if (std::fabs(dot(frame.axis[0], outward)) < one_wall * norm(outward)) return std::nullopt; // across the rim
    const auto spacing = static_cast<double>(scene_.measures.model.spacing[s]);
    const double reach = dot(frame.axis[0], outward) > 0 ? -far_before * spacing : far_before * spacing;
    double balance = 0;
    const SightLine line{s, static_cast<float>(spacing), p + reach * frame.axis[0]};
    cross_to_next_sheet(scene_, line, [&](TetrahedronIndex at, double length) {
      if (hidden_[at] < 0 || named_[at] == Label::outside)
        balance += length;
      else if (hidden_[at] > 0)
        balance -= length;
    });
    return balance;
  }

 private:
  const Scene& scene_;
  Vec3 front_;
  const HiddenCounts& hidden_;
  const Labels& named_;
  PointTree tree_;
};

std::vector<UprightTriangle> upright_triangles(const Tetrahedralization& t, const Vec3& front) {
  std::vector<UprightTriangle> upright;
  for_each_hull_triangle(t, [&](const HullTriangle& hull) {
    // A triangle without area has no direction; it would join sides that are not one.
    if (std::fabs(dot(hull.outward, front)) < most_leaning_wall * norm(hull.outward)) upright.push_back({hull});
  });
  return upright;
}

/// Those that go on in nearly the same direction are of one wall.
DisjointSets sides_of_hull(const std::vector<UprightTriangle>& upright, std::size_t samples) {
  std::vector<Triangle> triangles;
  triangles.reserve(upright.size());
  for (const UprightTriangle& u : upright)
    triangles.push_back({u.hull.corner[0].value, u.hull.corner[1].value, u.hull.corner[2].value});
  DisjointSets sets(upright.size());
  const std::vector<Side> sides = sorted_sides(triangles, samples, Threads(1));
  for_each_edge(std::span<const Side>(sides), [&](std::span<const Side> edge) {
    if (edge.size() < 2) return; // its neighbour is not upright
    const Vec3 &a = upright[edge[0].triangle()].hull.outward, &b = upright[edge[1].triangle()].hull.outward;
    if (dot(a, b) >= one_wall * norm(a) * norm(b)) sets.unite(edge[0].triangle(), edge[1].triangle());
  });
  return sets;
}

/// Tetrahedra at edges and vertices of the hull with other such, or beyond its triangles, all around them. Added until
/// there are no more.
void add_between(const Tetrahedralization& t, const Labels& named, std::vector<TetrahedronIndex>& beyond) {
  IndexedArray<TetrahedronIndex, std::uint8_t> solid(t.tetrahedra.size(), 0);
  for (const TetrahedronIndex i : beyond) solid[i] = 1;
  const auto is_surrounded = [&](TetrahedronIndex i) {
    std::size_t corners = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      if (!t.is_corner(t.tetrahedra[i][k])) continue;
      ++corners;
      const TetrahedronIndex n = t.neighbours[i][k];
      if (!n.valid() || !t.touches_cube(n) || !(solid[n] > 0 || named[n] == Label::inside)) return false;
    }
    return corners > 1;
  };
  for (std::size_t k = 0; k < beyond.size(); ++k)
    for (const TetrahedronIndex n : t.neighbours[beyond[k]]) {
      if (!n.valid() || solid[n] > 0 || named[n] != Label::outside || !is_surrounded(n)) continue;
      solid[n] = 1;
      beyond.push_back(n);
    }
}

} // namespace

std::vector<TetrahedronIndex> beyond_walls(const Scene& scene, const Vec3& front, const HiddenCounts& hidden,
                                           const Labels& named) {
  const Tetrahedralization& t = scene.tetrahedralization;
  std::vector<UprightTriangle> upright = upright_triangles(t, front);
  if (upright.empty()) return {};
  const Walls walls(scene, front, hidden, named);
  DisjointSets sides = sides_of_hull(upright, t.sample_count);
  std::vector<double> vote(upright.size(), 0);
  for (std::uint32_t k = 0; k < upright.size(); ++k) {
    for (const SampleIndex s : upright[k].hull.corner)
      if (const auto free = walls.free_before(s, upright[k].hull.outward)) upright[k].free += *free > 0 ? 1 : -1;
    vote[sides.find(k)] += norm(upright[k].hull.outward) * upright[k].free;
  }
  std::vector<TetrahedronIndex> beyond;
  for (std::uint32_t k = 0; k < upright.size(); ++k)
    if (vote[sides.find(k)] > 0) beyond.push_back(upright[k].hull.beyond);
  add_between(t, named, beyond);
  return beyond;
}

} // namespace eigencrust
