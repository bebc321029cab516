// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/mesh_topology.h"

#include <algorithm>
#include <limits>
#include <string>

#include <eigencrust/error.h>

#include "parallel/compressed_rows.h"

namespace eigencrust {

std::vector<Side> sorted_sides(std::span<const Triangle> triangles, std::size_t vertices, const Threads& threads) {
  // Counting sort by the lower vertex, then each short list by itself: no search tree, no hashing.
  auto rows = build_rows<Side>(vertices, [&](auto&& visit) {
    std::uint32_t number = 0;
    for (const Triangle& t : triangles)
      for (int k = 0; k < 3; ++k, ++number) {
        const std::uint32_t from = t[k], to = t[(k + 1) % 3];
        if (from != to) visit(std::min(from, to), Side{std::min(from, to), std::max(from, to), number, from < to});
      }
  });
  sort_rows(rows, threads,
            [](const Side& a, const Side& b) { return a.high < b.high || (a.high == b.high && a.number < b.number); });
  return std::move(rows.item);
}

std::vector<std::uint32_t> first_equal_vertex(std::span<const Vec3> vertices) {
  struct Place {
    Vec3 position;
    std::uint32_t vertex;
  };
  std::vector<Place> sorted;
  sorted.reserve(vertices.size());
  std::vector<std::uint32_t> first(vertices.size());
  std::iota(first.begin(), first.end(), 0u);
  for (const std::uint32_t v : first)
    if (vertices[v] == vertices[v]) sorted.push_back({vertices[v], v}); // NaN would break the order
  std::sort(sorted.begin(), sorted.end(), [](const Place& a, const Place& b) {
    if (a.position.x != b.position.x) return a.position.x < b.position.x;
    if (a.position.y != b.position.y) return a.position.y < b.position.y;
    if (a.position.z != b.position.z) return a.position.z < b.position.z;
    return a.vertex < b.vertex;
  });
  for (std::size_t i = 1; i < sorted.size(); ++i)
    if (sorted[i].position == sorted[i - 1].position) first[sorted[i].vertex] = first[sorted[i - 1].vertex];
  return first;
}

void require_valid_indices(const TriangleMesh& mesh, const char* place) {
  if (mesh.triangles.size() > std::numeric_limits<std::uint32_t>::max() / 3 ||
      mesh.vertices.size() > std::numeric_limits<std::uint32_t>::max())
    throw Error(ErrorKind::input, place, "the mesh has more triangles or vertices than 32-bit numbers can name",
                "split the mesh");
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const std::uint32_t v : mesh.triangles[t])
      if (v >= mesh.vertices.size())
        throw Error(ErrorKind::input, place,
                    "triangle " + std::to_string(t) + " names vertex " + std::to_string(v) + " of " +
                        std::to_string(mesh.vertices.size()),
                    "repair the mesh");
}

} // namespace eigencrust
