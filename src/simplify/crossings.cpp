// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/crossings.h"

#include <algorithm>

#include "geometry/self_intersections.h"
#include "surface/clear_stars.h"
#include "surface/fans.h"

namespace eigencrust {

CrossingVertices crossing_vertices(const TriangleMesh& mesh, const Threads& threads) {
  const std::vector<std::uint8_t> clear = clear_stars(mesh.vertices, SurfaceFans(mesh), threads),
                                  degenerate = find_degenerate_triangles(mesh.vertices, mesh.triangles, clear, threads);
  CrossingSearch search(mesh.vertices, mesh.triangles, degenerate, threads);
  search.set_clear(clear);
  const auto pairs = search.all(threads);
  CrossingVertices found{pairs.size(), std::vector<std::uint8_t>(mesh.vertices.size(), 0)};
  const auto mark = [&](std::uint32_t t) {
    for (const std::uint32_t v : mesh.triangles[t]) found.at[v] = 1;
  };
  for (const auto& [f, g] : pairs) {
    mark(f);
    mark(g);
  }
  for (std::uint32_t t = 0; t < degenerate.size(); ++t)
    if (degenerate[t] != 0) {
      mark(t);
      ++found.count;
    }
  return found;
}

void widen(const TriangleMesh& mesh, int rings, std::vector<std::uint8_t>& marked) {
  for (int ring = 0; ring < rings; ++ring) {
    std::vector<std::uint8_t> next = marked;
    for (const auto& [a, b, c] : mesh.triangles)
      if (marked[a] | marked[b] | marked[c]) next[a] = next[b] = next[c] = 1;
    marked.swap(next);
  }
}

} // namespace eigencrust
