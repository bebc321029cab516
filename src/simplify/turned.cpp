// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/turned.h"

#include <algorithm>

#include <eigencrust/validate.h>

#include "geometry/mesh_topology.h"
#include "geometry/signed_volume.h"

namespace eigencrust {
namespace {

struct Pieces {
  std::vector<std::uint32_t> of_vertex;
  std::vector<int> side;
};

Pieces pieces_of(const TriangleMesh& mesh, const Threads& threads) {
  const std::vector<std::uint32_t> piece_of = triangle_components(mesh, threads.size());
  const std::size_t count = piece_of.empty() ? 0 : std::size_t{*std::max_element(piece_of.begin(), piece_of.end())} + 1;
  Pieces pieces{std::vector<std::uint32_t>(mesh.vertices.size(), 0), std::vector<int>(count, 0)};
  std::vector<SignedVolume> volume(count);
  std::vector<std::uint32_t> first(count, no_index);
  for (std::uint32_t t = 0; t < piece_of.size(); ++t) {
    const std::uint32_t p = piece_of[t];
    if (first[p] == no_index) first[p] = mesh.triangles[t][0];
    const Vec3& origin = mesh.vertices[first[p]];
    const auto& [a, b, c] = mesh.triangles[t];
    volume[p].add(mesh.vertices[a] - origin, mesh.vertices[b] - origin, mesh.vertices[c] - origin);
    for (const std::uint32_t v : mesh.triangles[t]) pieces.of_vertex[v] = p;
  }
  for (std::size_t p = 0; p < count; ++p) {
    const double known = volume[p].known();
    pieces.side[p] = known > 0 ? 1 : known < 0 ? -1 : 0;
  }
  for_each_edge(sorted_sides(mesh.triangles, mesh.vertices.size(), threads), [&](std::span<const Side> edge) {
    if (edge.size() == 1) pieces.side[piece_of[edge[0].triangle()]] = 0;
  });
  return pieces;
}

} // namespace

PieceSides::PieceSides(const TriangleMesh& mesh, const Threads& threads) {
  Pieces pieces = pieces_of(mesh, threads);
  piece_ = std::move(pieces.of_vertex);
  side_ = std::move(pieces.side);
}

std::vector<std::uint8_t> PieceSides::turned(const TriangleMesh& mesh, std::span<const std::uint32_t> vertex_before,
                                             const Threads& threads) const {
  const Pieces pieces = pieces_of(mesh, threads);
  std::vector<std::uint8_t> marked(mesh.vertices.size());
  for (std::size_t v = 0; v < marked.size(); ++v) {
    const int before = side_[piece_[vertex_before[v]]];
    marked[v] = before != 0 && before != pieces.side[pieces.of_vertex[v]];
  }
  if (std::find(marked.begin(), marked.end(), 1) == marked.end()) marked.clear();
  return marked;
}

} // namespace eigencrust
