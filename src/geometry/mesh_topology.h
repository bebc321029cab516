// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Edges of a triangle soup in sorted order, and sets that merge. Any mesh will do, manifold or not.
#pragma once

#include <array>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include <eigencrust/types.h>

#include "parallel/threads.h"

namespace eigencrust {

using Triangle = std::array<std::uint32_t, 3>;

/// Disjoint sets over 0 .. n-1. The representative of a set is its smallest member, so that numbering
/// does not depend on the order of the unions.
class DisjointSets {
 public:
  DisjointSets() = default;
  explicit DisjointSets(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0u); }

  std::uint32_t find(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void unite(std::uint32_t a, std::uint32_t b) {
    a = find(a);
    b = find(b);
    if (a < b)
      parent_[b] = a;
    else
      parent_[a] = b;
  }

 private:
  std::vector<std::uint32_t> parent_;
};

/// Numbers of sides, and of corners, of triangles; see Side.
constexpr std::uint32_t side_number(std::uint32_t triangle, std::uint32_t k) { return 3 * triangle + k; }
constexpr std::uint32_t triangle_of_side(std::uint32_t side) { return side / 3; }
constexpr std::uint32_t corner_of_side(std::uint32_t side) { return side % 3; }
constexpr std::uint32_t next_side(std::uint32_t side) { return corner_of_side(side) == 2 ? side - 2 : side + 1; }

/// One side of a triangle. Side 3t+k runs from corner k to corner k+1 of triangle t; the corner at its
/// start is also numbered 3t+k.
struct Side {
  std::uint32_t low, high; ///< the edge's vertices, low < high
  std::uint32_t number;    ///< 3 t + k
  bool forward;            ///< runs from low to high

  [[nodiscard]] std::uint32_t triangle() const { return triangle_of_side(number); }
  [[nodiscard]] std::uint32_t start() const { return number; }
  [[nodiscard]] std::uint32_t end() const { return next_side(number); }
  [[nodiscard]] std::uint32_t corner_at_low() const { return forward ? start() : end(); }
  [[nodiscard]] std::uint32_t corner_at_high() const { return forward ? end() : start(); }
};

/// Sides of all triangles by (low, high, number), so that the sides of an edge stand together. Sides
/// whose two vertices are the same are left out.
/// \param vertices one more than the largest vertex number
std::vector<Side> sorted_sides(std::span<const Triangle> triangles, std::size_t vertices, const Threads& threads);

/// visit(sides of one edge) for each edge in order.
template <class Visit>
void for_each_edge(std::span<const Side> sides, Visit&& visit) {
  for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
    while (end < sides.size() && sides[end].low == sides[begin].low && sides[end].high == sides[begin].high) ++end;
    visit(sides.subspan(begin, end - begin));
  }
}

/// visit(triangle, vertex, corner) for each corner in order; corners are numbered as sides are.
template <class Visit>
void for_each_corner(std::span<const Triangle> triangles, Visit&& visit) {
  std::uint32_t corner = 0;
  for (std::uint32_t t = 0; t < triangles.size(); ++t)
    for (const std::uint32_t v : triangles[t]) visit(t, v, corner++);
}

/// Joins the corners of two triangles at both ends of their edge.
inline void join_fans(DisjointSets& fans, const Side& a, const Side& b) {
  fans.unite(a.corner_at_low(), b.corner_at_low());
  fans.unite(a.corner_at_high(), b.corner_at_high());
}

/// Twice its area, along its normal.
inline Vec3 area_vector(const TriangleMesh& mesh, std::size_t triangle) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  return cross(mesh.vertices[b] - mesh.vertices[a], mesh.vertices[c] - mesh.vertices[a]);
}

/// For each vertex at a rim the next one, along the triangle there; no_index for all others.
/// \param mesh oriented, every vertex with one fan
std::vector<std::uint32_t> along_rims(const TriangleMesh& mesh);

/// For each vertex the first one with equal coordinates (itself when there is none before it). NaN
/// equals nothing; -0 equals 0.
std::vector<std::uint32_t> first_equal_vertex(std::span<const Vec3> vertices);

/// \throws Error{input} naming the first triangle with a vertex that does not exist.
void require_valid_indices(const TriangleMesh& mesh, const char* place);

} // namespace eigencrust
