// SPDX-License-Identifier: GPL-3.0-or-later
// Which pieces of the surface are kept (not in the paper, which keeps all).
#include <algorithm>
#include <limits>
#include <numeric>

#include <eigencrust/stages.h>
#include <eigencrust/validate.h>

namespace eigencrust {
namespace {

// docs/decisions/0004: a speck, or small beside the largest piece and made of long edges.
constexpr std::uint32_t speck_vertices = 20;
constexpr double small_share = 0.01;
constexpr double long_edge = 4;

struct Piece {
  std::vector<std::uint32_t> triangles;
  std::uint32_t vertices = 0;
  double median_edge = 0;
  Vec3 centre;
};

/// Mean distance to the three nearest samples joined to s by a Delaunay edge.
double local_spacing(const Tetrahedralization& t, const VertexStars& stars, SampleIndex s) {
  std::array<double, 3> nearest;
  nearest.fill(std::numeric_limits<double>::infinity());
  std::array<SampleIndex, 3> who{};
  for (const TetrahedronIndex tetrahedron : stars[s])
    for (const SampleIndex v : t.tetrahedra[tetrahedron]) {
      if (v == s || t.is_corner(v) || std::find(who.begin(), who.end(), v) != who.end()) continue;
      const double d = distance(t.positions[s], t.positions[v]);
      if (d >= nearest[2]) continue;
      std::size_t k = 2;
      for (; k > 0 && nearest[k - 1] > d; --k) {
        nearest[k] = nearest[k - 1];
        who[k] = who[k - 1];
      }
      nearest[k] = d;
      who[k] = v;
    }
  return (nearest[0] + nearest[1] + nearest[2]) / 3;
}

std::vector<Piece> measure_pieces(const Surface& surface, const Tetrahedralization& t, const VertexStars& stars) {
  const std::vector<std::uint32_t> component = triangle_components(surface.mesh);
  std::vector<Piece> pieces;
  for (std::uint32_t i = 0; i < component.size(); ++i) {
    if (component[i] >= pieces.size()) pieces.resize(component[i] + 1);
    pieces[component[i]].triangles.push_back(i);
  }
  for (Piece& piece : pieces) {
    std::vector<double> edges;
    std::vector<std::uint32_t> vertices;
    for (const std::uint32_t i : piece.triangles) {
      const auto& v = surface.mesh.triangles[i];
      for (std::size_t k = 0; k < 3; ++k) {
        vertices.push_back(v[k]);
        const std::uint32_t a = v[k], b = v[(k + 1) % 3];
        if (a > b) continue; // each edge once
        const double spacing =
            std::min(local_spacing(t, stars, surface.sample_of[a]), local_spacing(t, stars, surface.sample_of[b]));
        edges.push_back(distance(surface.mesh.vertices[a], surface.mesh.vertices[b]) / spacing);
      }
    }
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    piece.vertices = static_cast<std::uint32_t>(vertices.size());
    for (const std::uint32_t v : vertices)
      piece.centre = piece.centre + (1.0 / piece.vertices) * surface.mesh.vertices[v];
    if (edges.empty()) continue;
    const auto middle = edges.begin() + static_cast<std::ptrdiff_t>(edges.size() / 2);
    std::nth_element(edges.begin(), middle, edges.end());
    piece.median_edge = *middle;
  }
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
        const bool is_small = piece.vertices < small_share * pieces[order[0]].vertices;
        if (piece.vertices < speck_vertices || (is_small && piece.median_edge > long_edge)) kept[order[i]] = 0;
      }
      break;
  }
  return kept;
}

} // namespace

std::vector<DroppedComponent> filter_components(Surface& surface, const KeepComponents& keep,
                                                const Tetrahedralization& t, const VertexStars& stars) {
  const std::vector<Piece> pieces = measure_pieces(surface, t, stars);
  const std::vector<std::uint8_t> kept = choose(pieces, keep);
  std::vector<DroppedComponent> dropped;
  std::vector<std::uint8_t> gone(surface.mesh.triangles.size(), 0);
  for (std::size_t c = 0; c < pieces.size(); ++c) {
    if (kept[c]) continue;
    dropped.push_back({pieces[c].vertices, static_cast<std::uint32_t>(pieces[c].triangles.size()),
                       pieces[c].median_edge, pieces[c].centre + t.origin});
    for (const std::uint32_t i : pieces[c].triangles) gone[i] = 1;
  }
  if (dropped.empty()) return dropped;
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
    }
  surface = std::move(rest);
  std::stable_sort(dropped.begin(), dropped.end(),
                   [](const auto& a, const auto& b) { return a.vertices > b.vertices; });
  return dropped;
}

} // namespace eigencrust
