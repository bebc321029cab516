// SPDX-License-Identifier: GPL-3.0-or-later
// §3.1: what is known before anything is computed.
#include <algorithm>
#include <cmath>
#include <optional>

#include <eigencrust/error.h>
#include <eigencrust/stages.h>

#include "evidence/named_points.h"
#include "geometry/nearest.h"
#include "geometry/predicates.h"
#include "parallel/threads.h"
#include "tetrahedra/segment_walk.h"

namespace eigencrust {
namespace {

std::string show(const Vec3& p) {
  return "(" + std::to_string(p.x) + ", " + std::to_string(p.y) + ", " + std::to_string(p.z) + ")";
}

/// Closed tetrahedra that hold p, by exact signs: several when p lies on a face, edge or vertex; none beyond the cube.
std::vector<TetrahedronIndex> tetrahedra_at(const Tetrahedralization& t, const VertexStars& stars, const Vec3& p) {
  const auto holds = [&](TetrahedronIndex i) {
    const auto& [a, b, c, d] = t.tetrahedra[i];
    const Vec3 &pa = t.positions[a], &pb = t.positions[b], &pc = t.positions[c], &pd = t.positions[d];
    return orientation(pa, pb, pc, p) >= 0 && orientation(pa, pc, pd, p) >= 0 && orientation(pa, pd, pb, p) >= 0 &&
           orientation(pb, pd, pc, p) >= 0;
  };
  const VertexIndex start{0};
  TetrahedronIndex last = stars[start].front(); // where p is the sample's own place
  for (SegmentWalk walk(t, stars, start, p); walk.next();) last = walk.tetrahedron();
  std::vector<TetrahedronIndex> found;
  if (holds(last)) found.push_back(last);
  // All others share faces with these.
  for (std::size_t k = 0; k < found.size(); ++k)
    for (const TetrahedronIndex n : t.neighbours[found[k]])
      if (n.valid() && std::find(found.begin(), found.end(), n) == found.end() && holds(n)) found.push_back(n);
  std::sort(found.begin(), found.end());
  return found;
}

/// A tetrahedron at the cube: outside around a body, inside around rooms; with a façade inside when all of its corners
/// are at the back.
Label label_at_cube(const Tetrahedralization& t, TetrahedronIndex tetrahedron, const Surroundings& surroundings) {
  const Vec3 front = direction_of(surroundings.front);
  bool corner = false, at_front = false;
  for (const VertexIndex s : t.tetrahedra[tetrahedron]) {
    if (!t.is_corner(s)) continue;
    corner = true;
    at_front = at_front || dot(front, t.positions[s]) > 0;
  }
  if (!corner) return Label::unlabelled;
  if (surroundings.kind == SceneKind::interior) return Label::inside;
  return surroundings.kind == SceneKind::body || at_front ? Label::outside : Label::inside;
}

/// The user's points of one side.
class NamedPoints {
 public:
  NamedPoints(const Tetrahedralization& t, std::span<const Vec3> points) {
    for (const Vec3& p : points) points_.push_back(p - t.origin);
    tree_.emplace(points_);
  }
  [[nodiscard]] bool is_deep_in(const Sphere& ball) const {
    std::uint32_t index = 0;
    double square = 0;
    return tree_->nearest(ball.centre, 1, &index, &square) > 0 && 2 * std::sqrt(square) < ball.radius;
  }

 private:
  std::vector<Vec3> points_;
  std::optional<PointTree> tree_;
};

} // namespace

Labels known_labels(const Tetrahedralization& t, const VertexStars& stars, std::span<const Vec3> outside_points,
                    std::span<const Vec3> inside_points, const Surroundings& surroundings, const Threads& threads,
                    std::span<const TetrahedronIndex> solid) {
  Labels labels(t.tetrahedra.size());
  for_each_index(threads, t.tetrahedra.size(), [&](std::size_t i) {
    labels.raw()[i] = label_at_cube(t, TetrahedronIndex{static_cast<std::uint32_t>(i)}, surroundings);
  });
  for (const TetrahedronIndex i : solid) labels[i] = Label::inside;
  for (const Vec3& p : outside_points)
    for (const TetrahedronIndex i : tetrahedra_at(t, stars, p - t.origin)) {
      if (surroundings.kind == SceneKind::facade && labels[i] == Label::inside)
        throw Error(ErrorKind::usage, "evidence", "the outside point " + show(p) + " lies behind the facade",
                    "move the point or turn the facade's axis");
      if (surroundings.kind == SceneKind::interior && labels[i] == Label::inside)
        throw Error(ErrorKind::usage, "evidence", "the outside point " + show(p) + " lies beyond the walls",
                    "give a point in the free space of the rooms");
      labels[i] = Label::outside;
    }
  for (const Vec3& p : inside_points) {
    const std::vector<TetrahedronIndex> at = tetrahedra_at(t, stars, p - t.origin);
    if (at.empty() ||
        std::any_of(at.begin(), at.end(), [&](TetrahedronIndex i) { return labels[i] == Label::outside; }))
      throw Error(ErrorKind::usage, "evidence", "the inside point " + show(p) + " is known to be outside",
                  "give a point well inside the object");
    for (const TetrahedronIndex i : at) labels[i] = Label::inside;
  }
  return labels;
}

void name_poles(const Tetrahedralization& t, const Poles& poles, std::span<const Vec3> outside_points,
                std::span<const Vec3> inside_points, const Threads& threads, Labels& known) {
  if (outside_points.empty() && inside_points.empty()) return;
  const NamedPoints outside_tree(t, outside_points), inside_tree(t, inside_points);
  for_each_index(threads, poles.tetrahedron.size(), [&](std::size_t i) {
    Label& label = known[poles.tetrahedron.raw()[i]];
    const Sphere& ball = poles.sphere.raw()[i];
    const bool outside = outside_tree.is_deep_in(ball), inside = inside_tree.is_deep_in(ball);
    if (label == Label::unlabelled && outside != inside) label = outside ? Label::outside : Label::inside;
  });
}

} // namespace eigencrust
