// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/mesh_topology.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <string>

#include <eigencrust/error.h>

#include "geometry/place_hash.h"
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

std::vector<std::uint32_t> along_rims(const TriangleMesh& mesh) {
  std::vector<std::uint32_t> next(mesh.vertices.size(), no_index);
  for_each_edge(sorted_sides(mesh.triangles, mesh.vertices.size(), Threads(1)), [&](std::span<const Side> edge) {
    if (edge.size() != 1) return;
    const Side& side = edge[0];
    next[side.forward ? side.low : side.high] = side.forward ? side.high : side.low;
  });
  return next;
}

std::vector<std::uint32_t> first_equal_vertex(std::span<const Vec3> vertices) {
  // A table with open addressing, at most half full.
  std::vector<std::uint32_t> slots(std::bit_ceil(2 * vertices.size() + 2), no_index);
  const std::size_t mask = slots.size() - 1;
  std::vector<std::uint32_t> first(vertices.size());
  for (std::uint32_t v = 0; v < first.size(); ++v) {
    first[v] = v;
    if (!(vertices[v] == vertices[v])) continue; // NaN equals nothing
    std::size_t slot = PlaceHash{}(vertices[v]) & mask;
    while (slots[slot] != no_index && vertices[slots[slot]] != vertices[v]) slot = (slot + 1) & mask;
    if (slots[slot] == no_index)
      slots[slot] = v;
    else
      first[v] = slots[slot];
  }
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
