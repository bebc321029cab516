// SPDX-License-Identifier: GPL-3.0-or-later
#include "fit/edge_flips.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "geometry/mesh_topology.h"
#include "geometry/self_intersections.h"
#include "surface/clear_stars.h"
#include "surface/fans.h"
#include "surface/trim.h"

namespace eigencrust {
namespace {

// Later rounds see the normals that earlier ones made better; from the tenth on hardly an edge is flipped.
constexpr int rounds = 10;
// An edge is flipped to be nearer by no less than that share of its length: rounding is no reason, nor are flat places,
// where the triangles of the Delaunay tetrahedralization have the better angles.
constexpr double least_gain = 2e-3;
// Nor where both diagonals are about as far off, to a tenth of the gap between them: beside the corner of a part one
// says so, the other not.
constexpr double least_share_of_gap = 0.1;
// No triangle may lean by more than 73° away from the two that were there, nor be flatter than 7 %.
constexpr double least_cosine = 0.3, least_height = 0.07;
// Cosine between a new triangle and a neighbour: beyond, it may not be folded more than the one that was there.
constexpr double most_folded = -0.5;
// Where triangles cross the edges around stay as they were, and those around these where that made others cross; after
// so many tries all do.
constexpr int tries = 8;

/// Where a segment and one beside it pass each other.
struct Passing {
  Vec3 normal;          ///< of both, unit
  double gap;           ///< along the normal, from the second up to the first
  double first, second; ///< shares of the ways along both
};

/// \return whether the segments pass each other, inside of both
bool pass(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, const Vec3& up, Passing& result) {
  const Vec3 along = b - a, across = d - c, between = a - c;
  const double aa = dot(along, along), ac = dot(along, across), cc = dot(across, across);
  const double determinant = aa * cc - ac * ac;
  if (!(determinant > 0)) return false;
  const double a_way = dot(along, between), c_way = dot(across, between);
  result.first = (ac * c_way - cc * a_way) / determinant;
  result.second = (aa * c_way - ac * a_way) / determinant;
  if (!(result.first > 0 && result.first < 1 && result.second > 0 && result.second < 1)) return false;
  const Vec3 normal = cross(along, across);
  result.normal = (std::copysign(1.0, dot(normal, up)) / norm(normal)) * normal;
  result.gap = dot(result.normal, between);
  return true;
}

/// How high the surface is above the segment from a to b, at that share of its way: the cubic with the slopes that the
/// normals at both ends ask for.
double height_above(const Vec3& a, const Vec3& b, const Vec3& normal_a, const Vec3& normal_b, double share) {
  const Vec3 along = b - a;
  return share * (1 - share) * (share * dot(normal_b, along) - (1 - share) * dot(normal_a, along));
}

/// Sides are numbered as in mesh_topology.h.
class EdgeFlips {
 public:
  /// \param longest of each vertex \param view of each vertex; may be empty \param closed of each triangle: 1 where its
  /// edges stay
  EdgeFlips(std::span<const Vec3> position, std::vector<Triangle> triangles, std::vector<float> support,
            std::vector<float> longest, std::span<const Vec3> view, std::span<const std::uint8_t> closed,
            const Threads& threads)
      : position_(position),
        longest_(std::move(longest)),
        view_(view),
        closed_(closed),
        threads_(threads),
        triangles_(std::move(triangles)),
        support_(std::move(support)),
        twin_(triangles_.size() * std::tuple_size_v<Triangle>, no_index),
        side_at_(position_.size(), no_index),
        normal_(position_.size()) {
    const std::vector<Side> sides = sorted_sides(triangles_, position_.size(), threads);
    for_each_edge(sides, [&](std::span<const Side> edge) {
      if (edge.size() == 2 && edge[0].forward != edge[1].forward) join(edge[0].number, edge[1].number);
    });
    keep_pinched();
  }

  /// The triangles, and the support of each: the least of those in whose place it is.
  std::pair<std::vector<Triangle>, std::vector<float>> run() {
    std::vector<std::uint32_t> vertices(position_.size()), sides(twin_.size());
    std::iota(vertices.begin(), vertices.end(), 0u);
    std::iota(sides.begin(), sides.end(), 0u);
    for (int round = 0; round < rounds; ++round) {
      for_each_index(threads_, vertices.size(), [&](std::size_t i) { find_normal(vertices[i]); });
      vertices = flip(better(sides));
      if (vertices.empty()) break;
      sides = sides_around(vertices);
    }
    return {std::move(triangles_), std::move(support_)};
  }

 private:
  static std::uint32_t next(std::uint32_t side) { return next_side(side); }
  static std::uint32_t last(std::uint32_t side) { return next(next(side)); }
  [[nodiscard]] std::uint32_t start(std::uint32_t side) const {
    return triangles_[triangle_of_side(side)][corner_of_side(side)];
  }

  void join(std::uint32_t side, std::uint32_t other) {
    if (side != no_index) twin_[side] = other;
    if (other != no_index) twin_[other] = side;
  }

  /// visit(side) for the sides that start at v, once around, or from rim to rim.
  template <class Visit>
  void around(std::uint32_t v, Visit&& visit) const {
    const std::uint32_t first = side_at_[v];
    if (first == no_index) return;
    std::uint32_t side = first;
    do {
      visit(side);
      side = twin_[last(side)];
    } while (side != first && side != no_index);
    if (side == first) return;
    for (side = twin_[first]; side != no_index; side = twin_[side]) visit(side = next(side));
  }

  /// Where the triangles of a vertex are more than one fan their edges stay: neighbours are looked for in one.
  void keep_pinched() {
    std::vector<std::uint32_t> count(position_.size(), 0);
    for_each_corner(triangles_, [&](std::uint32_t, std::uint32_t v, std::uint32_t corner) {
      ++count[v];
      side_at_[v] = corner;
    });
    for_each_index(threads_, count.size(), [&](std::size_t v) {
      std::uint32_t found = 0;
      around(static_cast<std::uint32_t>(v), [&](std::uint32_t) { ++found; });
      if (found != count[v]) longest_[v] = 0;
    });
  }

  /// From the triangles around, by the weights that are right on a sphere (Max 1999).
  void find_normal(std::uint32_t v) {
    Vec3 sum;
    around(v, [&](std::uint32_t side) {
      const Vec3 p = position_[start(next(side))] - position_[v], q = position_[start(last(side))] - position_[v];
      const double weight = 1 / (dot(p, p) * dot(q, q));
      if (std::isfinite(weight)) sum = sum + weight * cross(p, q);
    });
    const double length = norm(sum);
    normal_[v] = length > 0 ? (1 / length) * sum : Vec3{};
  }

  [[nodiscard]] std::vector<std::uint32_t> better(const std::vector<std::uint32_t>& sides) const {
    std::vector<std::uint8_t> is_better(sides.size());
    for_each_index(threads_, sides.size(), [&](std::size_t i) { is_better[i] = should_flip(sides[i]); });
    std::vector<std::uint32_t> found;
    for (std::size_t i = 0; i < sides.size(); ++i)
      if (is_better[i]) found.push_back(sides[i]);
    return found;
  }

  /// Those that still are better are flipped, in this order. \return their vertices, increasing
  std::vector<std::uint32_t> flip(const std::vector<std::uint32_t>& sides) {
    std::vector<std::uint32_t> touched;
    for (const std::uint32_t side : sides) {
      if (!should_flip(side)) continue;
      for (const std::uint32_t v : four_at(side)) touched.push_back(v);
      flip(side);
    }
    std::sort(touched.begin(), touched.end());
    touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
    return touched;
  }

  /// The vertices of both triangles at a side that has a twin: its start and end, the one across from it in its
  /// triangle, and the one across in the other.
  [[nodiscard]] std::array<std::uint32_t, 4> four_at(std::uint32_t side) const {
    return {start(side), start(next(side)), start(last(side)), start(last(twin_[side]))};
  }

  /// Is the side the first of an edge that may be flipped and is better off so?
  [[nodiscard]] bool should_flip(std::uint32_t side) const {
    const std::uint32_t twin = twin_[side];
    if (twin == no_index || twin < side) return false;
    if (closed_[triangle_of_side(side)] || closed_[triangle_of_side(twin)]) return false;
    const auto [a, b, c, d] = four_at(side);
    if (c == d || !is_short({a, d, c}) || !is_short({d, b, c})) return false;
    return is_nearer(side) && keeps_shape(side) && !are_neighbours(c, d);
  }

  /// Has the triangle no edge that is too long for one of its vertices?
  [[nodiscard]] bool is_short(const Triangle& t) const {
    const double most = std::min({longest_[t[0]], longest_[t[1]], longest_[t[2]]});
    const auto edge = [&](std::size_t i, std::size_t j) { return distance(position_[t[i]], position_[t[j]]); };
    return edge(0, 1) < most && edge(1, 2) < most && edge(2, 0) < most;
  }

  [[nodiscard]] Vec3 area_of(std::uint32_t i, std::uint32_t j, std::uint32_t k) const {
    return cross(position_[j] - position_[i], position_[k] - position_[i]);
  }
  /// NaN where it has no area.
  [[nodiscard]] Vec3 normal_of(std::uint32_t triangle) const {
    const auto& [i, j, k] = triangles_[triangle];
    const Vec3 area = area_of(i, j, k);
    return (1 / norm(area)) * area;
  }

  /// Is the other diagonal nearer to the surface than the edge? The two pass each other at some distance, and what each
  /// of them says of the surface there counts as much.
  [[nodiscard]] bool is_nearer(std::uint32_t side) const {
    const auto [a, b, c, d] = four_at(side);
    const Vec3 up = normal_of(triangle_of_side(side)) + normal_of(triangle_of_side(twin_[side]));
    Passing at;
    if (!pass(position_[a], position_[b], position_[c], position_[d], up, at)) return false;
    const double both = height_above(position_[a], position_[b], normal_[a], normal_[b], at.first) +
                        height_above(position_[c], position_[d], normal_[c], normal_[d], at.second);
    // With the surface half of that above the middle between the two, |both - gap| and |both + gap| are twice the
    // distances from it to the first and to the second.
    return both * at.gap < 0 && std::fabs(both) > least_share_of_gap * std::fabs(at.gap) &&
           std::min(std::fabs(both), std::fabs(at.gap)) > least_gain * distance(position_[a], position_[b]);
  }

  /// Are the triangles with the other diagonal no slivers, do they lie about as the two with the edge do, were they
  /// seen, and do they not lie back on their neighbours?
  [[nodiscard]] bool keeps_shape(std::uint32_t side) const {
    const auto [a, b, c, d] = four_at(side);
    const std::uint32_t twin = twin_[side];
    const Vec3 first = normal_of(triangle_of_side(side)), second = normal_of(triangle_of_side(twin)),
               both = first + second;
    const double least_area = least_height * squared_norm(position_[d] - position_[c]);
    // Sides by which a new triangle hangs on its neighbours: one that was of the first triangle, one of the second.
    const auto is_good = [&](const Triangle& t, std::uint32_t of_first, std::uint32_t of_second) {
      const Vec3 area = area_of(t[0], t[1], t[2]);
      const double size = norm(area);
      if (!(size > least_area && dot(area, both) > least_cosine * size * norm(both))) return false;
      const auto lies_back = [&](std::uint32_t outer, const Vec3& before) {
        if (twin_[outer] == no_index) return false;
        const Vec3 neighbour = normal_of(triangle_of_side(twin_[outer]));
        return dot(area, neighbour) < size * std::min(most_folded, dot(before, neighbour));
      };
      return is_seen(t, area, size) && !lies_back(of_first, first) && !lies_back(of_second, second);
    };
    return is_good({a, d, c}, last(side), next(twin)) && is_good({d, b, c}, next(side), last(twin));
  }

  /// Does the front of the triangle look to the sensors of its vertices?
  [[nodiscard]] bool is_seen(const Triangle& triangle, const Vec3& area, double size) const {
    return view_.empty() || std::ranges::all_of(triangle, [&](std::uint32_t v) {
             return view_[v] == Vec3{} || dot(area, view_[v]) > flattest_seen * size;
           });
  }

  [[nodiscard]] bool are_neighbours(std::uint32_t v, std::uint32_t other) const {
    bool found = false;
    around(v, [&](std::uint32_t side) { found |= start(next(side)) == other || start(last(side)) == other; });
    return found;
  }

  void flip(std::uint32_t side) {
    const auto [a, b, c, d] = four_at(side);
    const std::uint32_t twin = twin_[side], f = triangle_of_side(side), g = triangle_of_side(twin);
    const std::uint32_t ad = twin_[next(twin)], db = twin_[last(twin)], bc = twin_[next(side)], ca = twin_[last(side)];
    triangles_[f] = {c, a, d};
    triangles_[g] = {d, b, c};
    support_[f] = support_[g] = std::min(support_[f], support_[g]);
    join(side_number(f, 0), ca);
    join(side_number(f, 1), ad);
    join(side_number(f, 2), side_number(g, 2));
    join(side_number(g, 0), db);
    join(side_number(g, 1), bc);
    side_at_[c] = side_number(f, 0);
    side_at_[a] = side_number(f, 1);
    side_at_[d] = side_number(g, 0);
    side_at_[b] = side_number(g, 1);
  }

  /// Of each edge of all triangles at these vertices the first, increasing.
  [[nodiscard]] std::vector<std::uint32_t> sides_around(const std::vector<std::uint32_t>& vertices) const {
    std::vector<std::uint8_t> is_there(twin_.size(), 0);
    for (const std::uint32_t v : vertices)
      around(v, [&](std::uint32_t side) {
        for (const std::uint32_t one : {side, next(side), last(side)}) is_there[std::min(one, twin_[one])] = 1;
      });
    std::vector<std::uint32_t> sides;
    for (std::uint32_t side = 0; side < is_there.size(); ++side)
      if (is_there[side]) sides.push_back(side);
    return sides;
  }

  std::span<const Vec3> position_;
  std::vector<float> longest_;           ///< of each vertex
  std::span<const Vec3> view_;           ///< of each vertex; empty: unknown
  std::span<const std::uint8_t> closed_; ///< of each triangle
  const Threads& threads_;
  std::vector<Triangle> triangles_;
  std::vector<float> support_;         ///< of each triangle
  std::vector<std::uint32_t> twin_;    ///< of each side the other one of its edge
  std::vector<std::uint32_t> side_at_; ///< of each vertex one that starts there
  std::vector<Vec3> normal_;           ///< of each vertex, unit
};

/// Makes `triangles` those. \return which were others, increasing
std::vector<std::uint32_t> replace(std::vector<Triangle>& triangles, std::span<const Triangle> by) {
  std::vector<std::uint32_t> changed;
  for (std::uint32_t t = 0; t < by.size(); ++t) {
    if (triangles[t] == by[t]) continue;
    triangles[t] = by[t];
    changed.push_back(t);
  }
  return changed;
}

} // namespace

EdgeFlipCounts flip_edges(std::vector<float> longest, std::span<const Vec3> view, Surface& surface,
                          const Threads& threads) {
  EdgeFlipCounts counts;
  TriangleMesh& mesh = surface.mesh;
  const auto stays = [&](const Triangle& t) { return std::min({longest[t[0]], longest[t[1]], longest[t[2]]}) <= 0; };
  if (std::ranges::all_of(mesh.triangles, stays)) return counts;
  const std::vector<Triangle> before = mesh.triangles;
  const std::vector<float> support = surface.support;
  const std::vector<std::uint8_t> degenerate = find_degenerate_triangles(mesh.vertices, mesh.triangles, threads);
  std::vector<std::uint8_t> closed = degenerate;
  for (std::size_t t = 0; t < surface.unsupported.size(); ++t) closed[t] |= surface.unsupported[t];
  std::vector<std::uint8_t> clear;
  std::optional<CrossingSearch> search;
  const auto first_search = [&](const std::vector<std::uint32_t>& changed) {
    clear = clear_stars(mesh.vertices, SurfaceFans(mesh), threads);
    search.emplace(mesh.vertices, mesh.triangles, degenerate, threads);
    search->set_clear(clear);
    auto pairs = search->all(threads);
    std::erase_if(pairs, [&](const CrossingSearch::Pair& pair) {
      return std::ranges::none_of(pair, [&](std::uint32_t t) { return std::ranges::binary_search(changed, t); });
    });
    return pairs;
  };
  for (int attempt = 0;; ++attempt) {
    // What is as it was in the last try was tested then.
    auto flipped = EdgeFlips(mesh.vertices, before, support, longest, view, closed, threads).run();
    const std::vector<std::uint32_t> changed = replace(mesh.triangles, flipped.first);
    surface.support = std::move(flipped.second);
    if (changed.empty()) break;
    const auto pairs = search ? search->of_changed(changed, threads) : first_search(changed);
    if (pairs.empty()) break;
    counts.crossings += pairs.size();
    for (const auto& pair : pairs)
      for (const std::uint32_t t : pair)
        for (const std::uint32_t v : mesh.triangles[t]) longest[v] = 0;
    if (attempt == tries) longest.assign(longest.size(), 0);
  }
  for (std::size_t t = 0; t < before.size(); ++t) counts.triangles += mesh.triangles[t] != before[t];
  return counts;
}

} // namespace eigencrust
