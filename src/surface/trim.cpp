// SPDX-License-Identifier: GPL-3.0-or-later
// What the samples do not bear out, and how it is cut away (not in the paper; docs/decisions/0020).
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include <eigencrust/stages.h>

#include "geometry/mesh_topology.h"
#include "geometry/tetrahedron.h"
#include "parallel/threads.h"
#include "samples/scales.h"
#include "surface/components.h"
#include "surface/trim.h"

namespace eigencrust {
namespace {

// Of a triangle that is kept; that of one with a longer edge is at most this.
constexpr float least_support = 0.25f;

std::array<Vec3, 3> corners(const TriangleMesh& mesh, std::size_t i) {
  const auto& [a, b, c] = mesh.triangles[i];
  return {mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]};
}

/// The lines of each sample, which stand together.
std::span<const SightLine> lines_of(std::span<const SightLine> lines, SampleIndex sample) {
  const auto [begin, end] = std::equal_range(lines.begin(), lines.end(), SightLine{sample, 0, {}},
                                             [](const auto& a, const auto& b) { return a.sample < b.sample; });
  return {begin, end};
}

/// Do lines from the vertices meet the front, at no flatter angle: from one vertex, or in a one-sided scan from each
/// that has any? Elsewhere a sharp edge belongs to scans from either side.
bool is_seen(const Tetrahedralization& t, std::span<const SightLine> lines, bool one_sided, const Surface& surface,
             std::size_t i) {
  const Vec3 normal = area_vector(surface.mesh, i);
  const double size = norm(normal);
  const auto meets = [&](const SightLine& line) {
    const Vec3 way = line.target - t.positions[line.sample];
    return dot(way, normal) >= flattest_seen * norm(way) * size;
  };
  int seen = 0, unseen = 0;
  for (const std::uint32_t v : surface.mesh.triangles[i]) {
    const auto own = lines_of(lines, surface.sample_of[v]);
    if (own.empty()) continue;
    ++(std::any_of(own.begin(), own.end(), meets) ? seen : unseen);
  }
  return unseen == 0 || (seen > 0 && !one_sided);
}

/// At a vertex with several fans all but the one with the most triangles (the first of equal ones) go.
/// \return how many triangles
std::size_t mark_smaller_fans(const TriangleMesh& mesh, std::vector<std::uint8_t>& gone) {
  const auto& triangles = mesh.triangles;
  if (triangles.empty()) return 0;
  const std::size_t corners = triangles.size() * triangles.front().size();
  DisjointSets fans(corners);
  for_each_edge(sorted_sides(triangles, mesh.vertices.size(), Threads(1)), [&](std::span<const Side> edge) {
    if (edge.size() == 2) join_fans(fans, edge[0], edge[1]);
  });
  std::vector<std::uint32_t> size(corners, 0), largest(mesh.vertices.size(), no_index);
  for (std::uint32_t corner = 0; corner < corners; ++corner) ++size[fans.find(corner)];
  for_each_corner(triangles, [&](std::uint32_t, std::uint32_t v, std::uint32_t corner) {
    if (size[corner] > 0 && (largest[v] == no_index || size[corner] > size[largest[v]])) largest[v] = corner;
  });
  std::size_t marked = 0;
  for_each_corner(triangles, [&](std::uint32_t t, std::uint32_t v, std::uint32_t corner) {
    if (fans.find(corner) == largest[v] || gone[t]) return;
    gone[t] = 1;
    ++marked;
  });
  return marked;
}

/// The tetrahedron with that face, counter-clockwise seen from outside; invalid: there is none.
TetrahedronIndex tetrahedron_behind(const Tetrahedralization& t, const VertexStars& stars,
                                    const std::array<SampleIndex, 3>& face) {
  for (const TetrahedronIndex i : stars[VertexIndex(face[0])])
    for (std::size_t f = 0; f < face_opposite.size(); ++f)
      for (std::size_t k = 0; k < 3; ++k) {
        const auto is = [&](std::size_t j) {
          return t.tetrahedra[i][face_opposite[f][(k + j) % 3]] == VertexIndex(face[j]);
        };
        if (is(0) && is(1) && is(2)) return i;
      }
  return {};
}

} // namespace

std::vector<std::uint8_t> unsupported_triangles(const Tetrahedralization& t, const SampleModel& model,
                                                std::span<const SightLine> lines, bool one_sided, const RangeGrid& grid,
                                                const Surface& surface, const Threads& threads) {
  std::vector<std::uint8_t> unsupported(surface.mesh.triangles.size(), 0);
  for_each_index(threads, unsupported.size(), [&](std::size_t i) {
    const std::array<Vec3, 3> p = corners(surface.mesh, i);
    std::array<SampleIndex, 3> samples;
    double longest = 0, spacing = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < 3; ++k) {
      const SampleIndex s = samples[k] = surface.sample_of[surface.mesh.triangles[i][k]];
      longest = std::max(longest, distance(p[k], p[(k + 1) % 3]));
      spacing = std::min(spacing, static_cast<double>(model.spacing[s]));
    }
    const Between between = grid.empty() ? Between::unknown : grid.between(samples);
    unsupported[i] = between == Between::jump || longest > longest_kept * spacing ||
                     (between == Between::unknown &&
                      (surface.support[i] < least_support || !is_seen(t, lines, one_sided, surface, i)));
  });
  return unsupported;
}

BridgedReport bridged_places(const Surface& surface, std::span<const std::uint8_t> marked, const SampleModel& model,
                             const Vec3& origin, const Threads& threads) {
  struct Place {
    double area = 0, squares = 0; ///< in the unit of the input, and in that of the local spacing
    Vec3 middle;                  ///< times area
  };
  const TriangleMesh& mesh = surface.mesh;
  std::vector<std::uint32_t> number;
  std::vector<Triangle> triangles;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    if (!marked[t]) continue;
    number.push_back(t);
    triangles.push_back(mesh.triangles[t]);
  }
  DisjointSets joined(triangles.size());
  for_each_edge(sorted_sides(triangles, mesh.vertices.size(), threads), [&](std::span<const Side> edge) {
    if (edge.size() == 2) joined.unite(edge[0].triangle(), edge[1].triangle());
  });
  std::map<std::uint32_t, Place> places; // by the first triangle
  for (std::uint32_t i = 0; i < number.size(); ++i) {
    const std::uint32_t t = number[i];
    const double area = norm(area_vector(mesh, t)) / 2;
    double spacing = std::numeric_limits<double>::infinity();
    for (const std::uint32_t v : mesh.triangles[t])
      spacing = std::min(spacing, static_cast<double>(model.spacing[surface.sample_of[v]]));
    Place& place = places[joined.find(i)];
    place.area += area;
    place.squares += area / (spacing * spacing);
    place.middle = place.middle + area * centroid(corners(mesh, t));
  }
  BridgedReport report;
  const auto diameter = [](double area) { return 2 * std::sqrt(area / std::numbers::pi); };
  for (const auto& [first, place] : places) {
    if (!(diameter(place.squares) >= longest_kept)) continue;
    ++report.places;
    if (diameter(place.area) <= report.widest) continue;
    report.widest = diameter(place.area);
    report.at = origin + (1 / place.area) * place.middle;
  }
  return report;
}

std::vector<std::uint8_t> marked_at_rim(const TriangleMesh& mesh, std::span<const std::uint8_t> marked) {
  DisjointSets joined(mesh.triangles.size());
  std::vector<std::uint32_t> at_rim;
  for_each_edge(sorted_sides(mesh.triangles, mesh.vertices.size(), Threads(1)), [&](std::span<const Side> edge) {
    if (edge.size() == 1 && marked[edge[0].triangle()]) at_rim.push_back(edge[0].triangle());
    if (edge.size() == 2 && marked[edge[0].triangle()] && marked[edge[1].triangle()])
      joined.unite(edge[0].triangle(), edge[1].triangle());
  });
  std::vector<std::uint8_t> is_rim(mesh.triangles.size(), 0), result(mesh.triangles.size(), 0);
  for (const std::uint32_t t : at_rim) is_rim[joined.find(t)] = 1;
  for (std::uint32_t t = 0; t < result.size(); ++t) result[t] = marked[t] && is_rim[joined.find(t)];
  return result;
}

double share_of_area(const Surface& surface, std::span<const std::uint8_t> marked) {
  double part = 0, whole = 0;
  for (std::size_t i = 0; i < marked.size(); ++i) {
    const double a = norm(area_vector(surface.mesh, i)) / 2;
    whole += a;
    if (marked[i]) part += a;
  }
  return whole > 0 ? part / whole : 0;
}

void trim(std::vector<std::uint8_t> unsupported, Surface& surface) {
  do {
    drop_triangles(unsupported, surface);
    unsupported.assign(surface.mesh.triangles.size(), 0);
  } while (mark_smaller_fans(surface.mesh, unsupported) > 0);
}

void close_smallest_rims(const Tetrahedralization& t, const VertexStars& stars, Surface& surface) {
  const std::vector<std::uint32_t> next = along_rims(surface.mesh);
  DisjointSets pieces(next.size());
  for (const auto& [a, b, c] : surface.mesh.triangles) {
    pieces.unite(a, b);
    pieces.unite(b, c);
  }
  std::vector<std::uint32_t> edges(next.size(), 0); // at the rims of each piece
  for (std::uint32_t v = 0; v < next.size(); ++v)
    if (next[v] != no_index) ++edges[pieces.find(v)];
  for (std::uint32_t c = 0; c < next.size(); ++c) {
    if (next[c] == no_index || edges[pieces.find(c)] <= 3) continue; // the rim that the piece ends at stays
    const std::uint32_t b = next[c], a = next[b];
    if (a == no_index || next[a] != c || c > a || c > b) continue; // a rim may end where the mesh is no manifold
    // The new triangle runs the other way round.
    const std::array<SampleIndex, 3> samples{surface.sample_of[a], surface.sample_of[b], surface.sample_of[c]};
    const TetrahedronIndex behind = tetrahedron_behind(t, stars, samples);
    if (!behind.valid()) continue;
    edges[pieces.find(c)] -= 3;
    surface.mesh.triangles.push_back({a, b, c});
    surface.inside.push_back(behind);
    surface.support.push_back(0);
    if (!surface.unsupported.empty()) surface.unsupported.push_back(1);
  }
}

} // namespace eigencrust
