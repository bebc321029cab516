// SPDX-License-Identifier: GPL-3.0-or-later
// Nearest-point and ray queries. A tree of our own, not a library's: degenerate triangles are welcome,
// ties go by triangle number, and rays cannot slip through between two triangles.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include <eigencrust/error.h>
#include <eigencrust/metrics.h>

#include "geometry/box_tree.h"
#include "geometry/nearest_on_triangle.h"

namespace eigencrust {
namespace {

double squared_distance(const Box3& box, const Vec3& p) {
  const Vec3 d{std::max({0.0, box.min.x - p.x, p.x - box.max.x}), std::max({0.0, box.min.y - p.y, p.y - box.max.y}),
               std::max({0.0, box.min.z - p.z, p.z - box.max.z})};
  return squared_norm(d);
}

/// A ray prepared for the test of Woop, Benthin, Wald, "Watertight Ray/Triangle Intersection" (2013):
/// axes permuted so that the direction is largest along the last, then sheared onto it. Both triangles
/// of an edge compute the same number with opposite sign for it, so that no ray passes between them.
struct Ray {
  Vec3 origin, direction, inverse;
  double Vec3::*ax, Vec3::*ay, Vec3::*az;
  double sx, sy, sz;

  Ray(const Vec3& o, const Vec3& d)
      : origin(o), direction(d), inverse{1 / d.x, 1 / d.y, 1 / d.z}, ax(&Vec3::y), ay(&Vec3::z), az(&Vec3::x) {
    if (std::fabs(d.y) > std::fabs(d.*az)) ax = &Vec3::z, ay = &Vec3::x, az = &Vec3::y;
    if (std::fabs(d.z) > std::fabs(d.*az)) ax = &Vec3::x, ay = &Vec3::y, az = &Vec3::z;
    sx = d.*ax / d.*az;
    sy = d.*ay / d.*az;
    sz = 1 / d.*az;
  }

  /// Parameter of the hit, or a negative number.
  [[nodiscard]] double hit(const Corners& corners) const {
    double x[3], y[3], z[3];
    for (int k = 0; k < 3; ++k) {
      const Vec3 v = corners[k] - origin;
      x[k] = v.*ax - sx * v.*az;
      y[k] = v.*ay - sy * v.*az;
      z[k] = sz * v.*az;
    }
    const double u = x[2] * y[1] - y[2] * x[1];
    const double v = x[0] * y[2] - y[0] * x[2];
    const double w = x[1] * y[0] - y[1] * x[0];
    if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) return -1;
    const double sum = u + v + w;
    if (sum == 0) return -1; // seen edge-on
    const double t = (u * z[0] + v * z[1] + w * z[2]) / sum;
    return t > 0 ? t : -1;
  }

  /// Does the ray meet the box at a parameter in [0, limit]? Never no by rounding; `entry` receives where.
  [[nodiscard]] bool meets(const Box3& box, double limit, double& entry) const {
    double from = 0, to = limit;
    for (double Vec3::*axis : {&Vec3::x, &Vec3::y, &Vec3::z}) {
      double a = (box.min.*axis - origin.*axis) * inverse.*axis;
      double b = (box.max.*axis - origin.*axis) * inverse.*axis;
      if (std::isnan(a) || std::isnan(b)) continue; // in the plane of a face: 0 times infinity
      if (a > b) std::swap(a, b);
      // Three roundings on the way: widen by more than their sum (a product, as these may be infinite).
      from = std::fmax(from, a * (a > 0 ? 1 - 1e-15 : 1 + 1e-15));
      to = std::fmin(to, b * (b > 0 ? 1 + 1e-15 : 1 - 1e-15));
    }
    entry = from;
    return from <= to;
  }
};

} // namespace

struct TriangleTree::Impl {
  BoxTree tree;
  std::vector<Corners> corners; ///< in the order of the leaves, so that a leaf is read in one go
};

TriangleTree::TriangleTree(const TriangleMesh& mesh, unsigned threads) : impl_(std::make_unique<Impl>()) {
  if (mesh.triangles.empty())
    throw Error(ErrorKind::input, "distance tree", "the mesh has no triangles", "give a mesh");
  const Threads team(threads);
  std::vector<Box3> boxes(mesh.triangles.size());
  for_each_index(team, boxes.size(), [&](std::size_t t) {
    for (const std::uint32_t v : mesh.triangles[t])
      if (v >= mesh.vertices.size() || !is_finite(mesh.vertices[v]))
        throw Error(ErrorKind::input, "distance tree",
                    "triangle " + std::to_string(t) + " names a vertex that is missing or not finite",
                    "repair the mesh");
    const auto& [a, b, c] = mesh.triangles[t];
    boxes[t] = box_around(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]);
  });
  impl_->tree = BoxTree(boxes, team);
  impl_->corners.resize(boxes.size());
  for_each_index(team, boxes.size(), [&](std::size_t place) {
    const auto& v = mesh.triangles[impl_->tree.order()[place]];
    impl_->corners[place] = {mesh.vertices[v[0]], mesh.vertices[v[1]], mesh.vertices[v[2]]};
  });
}

TriangleTree::~TriangleTree() = default;
TriangleTree::TriangleTree(TriangleTree&&) noexcept = default;
TriangleTree& TriangleTree::operator=(TriangleTree&&) noexcept = default;

TriangleTree::Nearest TriangleTree::nearest(const Vec3& query) const {
  if (!is_finite(query)) return {std::numeric_limits<double>::quiet_NaN(), query, 0};
  const auto& nodes = impl_->tree.nodes();
  struct Entry {
    std::uint32_t node;
    double distance2;
  };
  std::array<Entry, BoxTree::max_depth> stack;
  std::size_t top = 0;
  stack[top++] = {0, squared_distance(nodes[0].box, query)};
  double best = std::numeric_limits<double>::infinity();
  Nearest result{best, query, std::numeric_limits<std::uint32_t>::max()};
  while (top > 0) {
    const Entry entry = stack[--top];
    if (entry.distance2 > best) continue;
    const BoxTree::Node& node = nodes[entry.node];
    if (node.count == 0) {
      Entry near{entry.node + 1, squared_distance(nodes[entry.node + 1].box, query)};
      Entry far{node.first, squared_distance(nodes[node.first].box, query)};
      if (far.distance2 < near.distance2) std::swap(near, far);
      if (far.distance2 <= best) stack[top++] = far;
      if (near.distance2 <= best) stack[top++] = near;
      continue;
    }
    for (std::uint32_t k = node.first; k < node.first + node.count; ++k) {
      const Vec3 point = nearest_on_triangle(impl_->corners[k], query);
      const double distance2 = squared_norm(point - query);
      const std::uint32_t triangle = impl_->tree.order()[k];
      if (distance2 < best || (distance2 == best && triangle < result.triangle)) {
        best = distance2;
        result.point = point;
        result.triangle = triangle;
      }
    }
  }
  result.distance = std::sqrt(best);
  return result;
}

TriangleTree::Hit TriangleTree::first_hit(const Vec3& origin, const Vec3& direction) const {
  Hit result;
  if (!is_finite(origin) || !is_finite(direction) || squared_norm(direction) == 0) return result;
  const Ray ray(origin, direction);
  const auto& nodes = impl_->tree.nodes();
  std::array<std::uint32_t, BoxTree::max_depth> stack;
  std::size_t top = 0;
  stack[top++] = 0;
  double limit = std::numeric_limits<double>::infinity(), entry = 0;
  while (top > 0) {
    const std::uint32_t i = stack[--top];
    const BoxTree::Node& node = nodes[i];
    if (!ray.meets(node.box, limit, entry)) continue;
    if (node.count == 0) {
      double left = 0, right = 0;
      const bool meets_left = ray.meets(nodes[i + 1].box, limit, left);
      const bool meets_right = ray.meets(nodes[node.first].box, limit, right);
      const bool left_first = left <= right;
      if (left_first && meets_right) stack[top++] = node.first;
      if (meets_left) stack[top++] = i + 1;
      if (!left_first && meets_right) stack[top++] = node.first;
      continue;
    }
    for (std::uint32_t k = node.first; k < node.first + node.count; ++k) {
      const double t = ray.hit(impl_->corners[k]);
      const std::uint32_t triangle = impl_->tree.order()[k];
      if (t > 0 && (t < limit || (t == limit && triangle < result.triangle))) {
        limit = t;
        result = {t, triangle};
      }
    }
  }
  return result;
}

} // namespace eigencrust
