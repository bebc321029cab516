// SPDX-License-Identifier: GPL-3.0-or-later
// Which pieces of the surface are kept (not in the paper, which keeps all).
#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include <eigencrust/stages.h>
#include <eigencrust/validate.h>

#include "geometry/mesh_topology.h"
#include "parallel/threads.h"
#include "surface/components.h"
#include "surface/drop_triangles.h"

namespace eigencrust {
namespace {

// docs/decisions/0004: specks, and pieces that the samples do not bear out.
constexpr double speck_vertices = 20, speck_share = 5e-4;
constexpr double least_support = 0.4;

struct Piece {
  std::vector<std::uint32_t> triangles;
  std::uint32_t vertices = 0;
  double support = 0; ///< mean over the area
  Vec3 centre;
};

/// \param met vertices that this function has met; marks those of the piece
void measure(const Surface& surface, std::uint32_t number, Piece& piece, std::vector<std::uint32_t>& met) {
  std::vector<std::uint32_t> vertices;
  double supported = 0, whole = 0;
  for (const std::uint32_t i : piece.triangles) {
    for (const std::uint32_t corner : surface.mesh.triangles[i])
      if (std::exchange(met[corner], number) != number) vertices.push_back(corner);
    const double a = norm(area_vector(surface.mesh, i)) / 2;
    supported += a * static_cast<double>(surface.support[i]);
    whole += a;
  }
  piece.support = whole > 0 ? supported / whole : 0;
  piece.vertices = static_cast<std::uint32_t>(vertices.size());
  for (const std::uint32_t v : vertices)
    piece.centre = piece.centre + (1.0 / piece.vertices) * surface.mesh.vertices[v];
}

std::vector<Piece> measure_pieces(const Surface& surface, const Threads& threads) {
  const std::vector<std::uint32_t> component = triangle_components(surface.mesh, threads.size());
  std::vector<Piece> pieces;
  for (std::uint32_t i = 0; i < component.size(); ++i) {
    if (component[i] >= pieces.size()) pieces.resize(component[i] + 1);
    pieces[component[i]].triangles.push_back(i);
  }
  std::vector<std::uint32_t> met(surface.mesh.vertices.size(), SampleIndex::none);
  for (std::uint32_t c = 0; c < pieces.size(); ++c) measure(surface, c, pieces[c], met);
  return pieces;
}

std::vector<std::uint8_t> choose(const std::vector<Piece>& pieces, const KeepComponents& keep) {
  std::vector<std::uint8_t> kept(pieces.size(), 1);
  std::vector<std::uint32_t> order(pieces.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return pieces[a].vertices > pieces[b].vertices; });
  switch (keep.kind) {
    case KeepComponents::Kind::all:
      break;
    case KeepComponents::Kind::largest:
    case KeepComponents::Kind::count: {
      const std::size_t count = keep.kind == KeepComponents::Kind::largest ? 1 : keep.count;
      for (std::size_t i = count; i < order.size(); ++i) kept[order[i]] = 0;
      break;
    }
    case KeepComponents::Kind::supported:
      // The largest piece always stays: a cloud of ten points still has a surface.
      for (std::size_t i = 1; i < order.size(); ++i) {
        const Piece& piece = pieces[order[i]];
        if (piece.vertices < speck_vertices + speck_share * pieces[order[0]].vertices || piece.support < least_support)
          kept[order[i]] = 0;
      }
      break;
  }
  return kept;
}

} // namespace

void drop_triangles(std::span<const std::uint8_t> gone, Surface& surface) {
  Surface rest;
  std::vector<std::uint32_t> vertex_of(surface.mesh.vertices.size(), SampleIndex::none);
  for (std::size_t i = 0; i < gone.size(); ++i)
    if (!gone[i])
      for (const std::uint32_t v : surface.mesh.triangles[i]) vertex_of[v] = 0;
  for (std::uint32_t v = 0; v < vertex_of.size(); ++v) {
    if (vertex_of[v] == SampleIndex::none) continue;
    vertex_of[v] = static_cast<std::uint32_t>(rest.sample_of.size());
    rest.sample_of.push_back(surface.sample_of[v]);
    rest.mesh.vertices.push_back(surface.mesh.vertices[v]);
  }
  for (std::size_t i = 0; i < gone.size(); ++i)
    if (!gone[i]) {
      const auto& [a, b, c] = surface.mesh.triangles[i];
      rest.mesh.triangles.push_back({vertex_of[a], vertex_of[b], vertex_of[c]});
      rest.inside.push_back(surface.inside[i]);
      rest.support.push_back(surface.support[i]);
    }
  surface = std::move(rest);
}

std::vector<DroppedComponent> filter_components(Surface& surface, const KeepComponents& keep,
                                                const Tetrahedralization& t, const Threads& threads) {
  const std::vector<Piece> pieces = measure_pieces(surface, threads);
  const std::vector<std::uint8_t> kept = choose(pieces, keep);
  std::vector<DroppedComponent> dropped;
  std::vector<std::uint8_t> gone(surface.mesh.triangles.size(), 0);
  for (std::size_t c = 0; c < pieces.size(); ++c) {
    if (kept[c]) continue;
    dropped.push_back({pieces[c].vertices, static_cast<std::uint32_t>(pieces[c].triangles.size()), pieces[c].support,
                       pieces[c].centre + t.origin});
    for (const std::uint32_t i : pieces[c].triangles) gone[i] = 1;
  }
  if (dropped.empty()) return dropped;
  drop_triangles(gone, surface);
  std::stable_sort(dropped.begin(), dropped.end(),
                   [](const auto& a, const auto& b) { return a.vertices > b.vertices; });
  return dropped;
}

} // namespace eigencrust
