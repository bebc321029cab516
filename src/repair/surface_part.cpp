// SPDX-License-Identifier: GPL-3.0-or-later
#include "repair/surface_part.h"

#include <algorithm>

#include "geometry/mesh_topology.h"

namespace eigencrust {
namespace {

template <class T>
void sort_unique(std::vector<T>& items) {
  std::sort(items.begin(), items.end());
  items.erase(std::unique(items.begin(), items.end()), items.end());
}

/// Surface triangles at the samples, vertices increasing.
std::vector<Triangle> triangles_at(const Tetrahedralization& t, const VertexStars& stars, const Labels& labels,
                                   const std::vector<std::uint32_t>& samples) {
  std::vector<Triangle> triangles;
  for (const std::uint32_t s : samples)
    for (const TetrahedronIndex i : stars[SampleIndex{s}]) {
      if (labels[i] != Label::inside) continue;
      const auto& v = t.tetrahedra[i];
      for (std::size_t k = 0; k < 4; ++k) {
        const TetrahedronIndex n = t.neighbours[i][k];
        if (v[k].value == s || !n.valid() || labels[n] == Label::inside) continue;
        Triangle triangle{v[(k + 1) % 4].value, v[(k + 2) % 4].value, v[(k + 3) % 4].value};
        std::sort(triangle.begin(), triangle.end());
        triangles.push_back(triangle);
      }
    }
  sort_unique(triangles);
  return triangles;
}

} // namespace

SurfacePart surface_part(const Tetrahedralization& t, const VertexStars& stars, const Labels& labels,
                         const std::vector<std::uint32_t>& samples) {
  const std::vector<Triangle> triangles = triangles_at(t, stars, labels, samples);
  const auto counts = [&](std::uint32_t v) { return std::binary_search(samples.begin(), samples.end(), v); };
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  std::vector<std::uint32_t> vertices;
  for (const auto& [a, b, c] : triangles) {
    for (const auto& [p, q] : {std::pair(a, b), std::pair(a, c), std::pair(b, c)})
      if (counts(p) || counts(q)) edges.emplace_back(p, q);
    vertices.insert(vertices.end(), {a, b, c});
  }
  sort_unique(edges);
  sort_unique(vertices);

  const auto number = [&](std::uint32_t v) {
    return static_cast<std::uint32_t>(std::lower_bound(vertices.begin(), vertices.end(), v) - vertices.begin());
  };
  DisjointSets pieces(vertices.size());
  for (const auto& [a, b, c] : triangles) {
    pieces.unite(number(a), number(b));
    pieces.unite(number(a), number(c));
  }
  SurfacePart part;
  part.euler = static_cast<std::int64_t>(triangles.size()) - static_cast<std::int64_t>(edges.size());
  std::vector<std::uint8_t> is_open(vertices.size(), 0);
  for (std::uint32_t i = 0; i < vertices.size(); ++i) {
    if (counts(vertices[i]))
      ++part.euler;
    else
      is_open[pieces.find(i)] = 1;
  }
  for (std::uint32_t i = 0; i < vertices.size(); ++i) part.closed_pieces += pieces.find(i) == i && !is_open[i];
  return part;
}

} // namespace eigencrust
