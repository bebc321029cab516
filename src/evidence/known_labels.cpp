// SPDX-License-Identifier: GPL-3.0-or-later
// §3.1: what is known before anything is computed.
#include <algorithm>

#include <eigencrust/error.h>
#include <eigencrust/stages.h>

#include "evidence/named_points.h"
#include "geometry/predicates.h"
#include "parallel/threads.h"

namespace eigencrust {
namespace {

std::string show(const Vec3& p) {
  return "(" + std::to_string(p.x) + ", " + std::to_string(p.y) + ", " + std::to_string(p.z) + ")";
}

/// Closed tetrahedra that hold p, by exact signs: several when p lies on a face, edge or vertex.
std::vector<TetrahedronIndex> tetrahedra_at(const Tetrahedralization& t, const Vec3& p, const Threads& threads) {
  const auto holds = [&](std::size_t i) {
    const auto& [a, b, c, d] = t.tetrahedra.raw()[i];
    const Vec3 &pa = t.positions[a], &pb = t.positions[b], &pc = t.positions[c], &pd = t.positions[d];
    return orientation(pa, pb, pc, p) >= 0 && orientation(pa, pc, pd, p) >= 0 && orientation(pa, pd, pb, p) >= 0 &&
           orientation(pb, pd, pc, p) >= 0;
  };
  constexpr std::size_t block = default_block;
  std::vector<std::vector<TetrahedronIndex>> found((t.tetrahedra.size() + block - 1) / block);
  for_blocks(threads, t.tetrahedra.size(), block, [&](std::size_t begin, std::size_t end, std::size_t b) {
    for (std::size_t i = begin; i < end; ++i)
      if (holds(i)) found[b].push_back(TetrahedronIndex{static_cast<std::uint32_t>(i)});
  });
  std::vector<TetrahedronIndex> result;
  for (const auto& part : found) result.insert(result.end(), part.begin(), part.end());
  return result;
}

double along(Axis axis, const Vec3& p) {
  switch (axis) {
    case Axis::plus_x:
      return p.x;
    case Axis::minus_x:
      return -p.x;
    case Axis::plus_y:
      return p.y;
    case Axis::minus_y:
      return -p.y;
    case Axis::plus_z:
      return p.z;
    case Axis::minus_z:
      return -p.z;
  }
  return 0;
}

/// A tetrahedron at the cube: outside, but with a façade inside when all of its corners are at the back.
Label label_at_cube(const Tetrahedralization& t, TetrahedronIndex tetrahedron, std::optional<Axis> facade) {
  bool corner = false, front = false;
  for (const SampleIndex s : t.tetrahedra[tetrahedron]) {
    if (!t.is_corner(s)) continue;
    corner = true;
    front = front || (facade && along(*facade, t.positions[s]) > 0);
  }
  if (!corner) return Label::unlabelled;
  return !facade || front ? Label::outside : Label::inside;
}

} // namespace

Labels known_labels(const Tetrahedralization& t, std::span<const Vec3> outside_points,
                    std::span<const Vec3> inside_points, std::optional<Axis> facade, const Threads& threads) {
  Labels labels(t.tetrahedra.size());
  for_each_index(threads, t.tetrahedra.size(), [&](std::size_t i) {
    labels.raw()[i] = label_at_cube(t, TetrahedronIndex{static_cast<std::uint32_t>(i)}, facade);
  });
  for (const Vec3& p : outside_points)
    for (const TetrahedronIndex i : tetrahedra_at(t, p - t.origin, threads)) {
      if (facade && labels[i] == Label::inside)
        throw Error(ErrorKind::usage, "evidence", "the outside point " + show(p) + " lies behind the facade",
                    "move the point or turn the facade's axis");
      labels[i] = Label::outside;
    }
  for (const Vec3& p : inside_points) {
    const std::vector<TetrahedronIndex> at = tetrahedra_at(t, p - t.origin, threads);
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
  const auto holds = [&](const Sphere& ball, std::span<const Vec3> points) {
    return std::any_of(points.begin(), points.end(), [&](const Vec3& p) {
      return distance(p - t.origin, ball.centre) < ball.radius / 2; // deep within
    });
  };
  for_each_index(threads, poles.tetrahedron.size(), [&](std::size_t i) {
    Label& label = known[poles.tetrahedron.raw()[i]];
    const Sphere& ball = poles.sphere.raw()[i];
    const bool outside = holds(ball, outside_points), inside = holds(ball, inside_points);
    if (label == Label::unlabelled && outside != inside) label = outside ? Label::outside : Label::inside;
  });
}

} // namespace eigencrust
