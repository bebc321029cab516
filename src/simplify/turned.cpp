// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/turned.h"

#include <algorithm>

#include "geometry/signed_volume.h"
#include "surface/fans.h"

namespace eigencrust {
namespace {

struct Pieces {
  std::vector<std::uint32_t> of_vertex;
  std::vector<int> side;
};

Pieces pieces_of(const TriangleMesh& mesh, const Threads& threads) {
  const SurfaceFans fans(mesh);
  Pieces pieces{fans.pieces(), {}};
  const std::size_t count = pieces.of_vertex.empty()
                                ? 0
                                : std::size_t{*std::max_element(pieces.of_vertex.begin(), pieces.of_vertex.end())} + 1;
  pieces.side.assign(count, 0);
  std::vector<SignedVolume> volume(count);
  std::vector<std::uint32_t> first(count, no_index);
  for (const auto& [a, b, c] : mesh.triangles) {
    const std::uint32_t p = pieces.of_vertex[a];
    if (first[p] == no_index) first[p] = a;
    const Vec3& origin = mesh.vertices[first[p]];
    volume[p].add(mesh.vertices[a] - origin, mesh.vertices[b] - origin, mesh.vertices[c] - origin);
  }
  for (std::size_t p = 0; p < count; ++p) {
    const double known = volume[p].known();
    pieces.side[p] = known > 0 ? 1 : known < 0 ? -1 : 0;
  }
  const std::vector<std::uint8_t> at_rim = fans.rim_vertices(threads);
  for (std::size_t v = 0; v < at_rim.size(); ++v)
    if (at_rim[v] != 0) pieces.side[pieces.of_vertex[v]] = 0;
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
