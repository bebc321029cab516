// SPDX-License-Identifier: GPL-3.0-or-later
// Which pieces of the surface are kept (not in the paper, which keeps all).
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include <eigencrust/stages.h>
#include <eigencrust/validate.h>

#include "geometry/mesh_topology.h"
#include "parallel/threads.h"
#include "surface/components.h"
#include "surface/shells.h"

namespace eigencrust {
namespace {

// docs/decisions/0004: specks, by the largest piece's vertices, and pieces that the samples do not bear out.
constexpr double speck_share = 5e-4, least_support = 0.4;
// Of its vertices: isolated samples are on no surface, and on the largest piece of scans full of outliers 0.01 at most.
constexpr double most_isolated = 0.05;
// Mean bend of a piece's edges, in radians (45°). Clumps have 48° to 65°, surfaces as noisy as the spacing 36° to 42°.
// Pieces with isolated samples have to be smoother, 36°: those that a shell of outliers makes have 38° to 45°, coarse
// bodies beside fine ones 14° to 35°.
constexpr double most_bent = std::numbers::pi / 4, most_bent_if_lonely = std::numbers::pi / 5;

struct Piece {
  std::vector<std::uint32_t> triangles;
  std::vector<std::uint32_t> vertices;
  double support = 0;  ///< mean over the area
  double isolated = 0; ///< share of the vertices
  Vec3 centre;
};

/// \param met vertices that this function has met; marks those of the piece
void measure(const Surface& surface, const SampleModel& model, std::uint32_t number, Piece& piece,
             std::vector<std::uint32_t>& met) {
  double supported = 0, whole = 0;
  for (const std::uint32_t i : piece.triangles) {
    for (const std::uint32_t corner : surface.mesh.triangles[i])
      if (std::exchange(met[corner], number) != number) piece.vertices.push_back(corner);
    const double a = norm(area_vector(surface.mesh, i)) / 2;
    supported += a * static_cast<double>(surface.support[i]);
    whole += a;
  }
  piece.support = whole > 0 ? supported / whole : 0;
  const auto count = static_cast<double>(piece.vertices.size());
  for (const std::uint32_t v : piece.vertices) {
    piece.centre = piece.centre + (1 / count) * surface.mesh.vertices[v];
    const SampleIndex s = surface.sample_of[v];
    if (!model.isolated.empty() && model.isolated[s] > 0) piece.isolated += 1 / count;
  }
}

/// \param component of each triangle
std::vector<Piece> measure_pieces(const Surface& surface, std::span<const std::uint32_t> component,
                                  const SampleModel& model) {
  std::vector<Piece> pieces;
  for (std::uint32_t i = 0; i < component.size(); ++i) {
    if (component[i] >= pieces.size()) pieces.resize(component[i] + 1);
    pieces[component[i]].triangles.push_back(i);
  }
  std::vector<std::uint32_t> met(surface.mesh.vertices.size(), SampleIndex::none);
  for (std::uint32_t c = 0; c < pieces.size(); ++c) measure(surface, model, c, pieces[c], met);
  return pieces;
}

/// Do the edges of the piece bend so sharply that it is no surface but the hull of a clump that samples fill?
/// \param number one for each vertex of the surface, to work with
bool is_crumpled(const Surface& surface, const Piece& piece, std::vector<std::uint32_t>& number) {
  for (std::uint32_t k = 0; k < piece.vertices.size(); ++k) number[piece.vertices[k]] = k;
  std::vector<Triangle> triangles;
  std::vector<Vec3> normal;
  for (const std::uint32_t i : piece.triangles) {
    const auto& [a, b, c] = surface.mesh.triangles[i];
    const Vec3 n = area_vector(surface.mesh, i);
    triangles.push_back({number[a], number[b], number[c]});
    normal.push_back((1 / norm(n)) * n);
  }
  double edges = 0, bend = 0;
  for_each_edge(sorted_sides(triangles, piece.vertices.size(), Threads(1)), [&](std::span<const Side> edge) {
    if (edge.size() != 2) return;
    ++edges;
    bend += std::acos(std::clamp(dot(normal[edge[0].triangle()], normal[edge[1].triangle()]), -1.0, 1.0));
  });
  return bend > (piece.isolated > most_isolated ? most_bent_if_lonely : most_bent) * edges;
}

/// The largest piece always stays: a cloud of ten points still has a surface.
/// \param order pieces, the largest first
std::vector<std::uint8_t> supported(const Surface& surface, const std::vector<Piece>& pieces,
                                    std::span<const std::uint32_t> order) {
  std::vector<std::uint8_t> kept(pieces.size(), 1);
  std::vector<std::uint32_t> number(surface.mesh.vertices.size());
  for (std::size_t k = 1; k < order.size(); ++k) {
    const Piece& piece = pieces[order[k]];
    const double least = speck_share * static_cast<double>(pieces[order[0]].vertices.size());
    kept[order[k]] = static_cast<double>(piece.vertices.size()) >= least && piece.support >= least_support &&
                     !is_crumpled(surface, piece, number);
  }
  return kept;
}

std::vector<std::uint8_t> choose(const Surface& surface, const std::vector<Piece>& pieces, const KeepComponents& keep) {
  using Kind = KeepComponents::Kind;
  std::vector<std::uint8_t> kept(pieces.size(), 1);
  if (keep.kind == Kind::all) return kept;
  std::vector<std::uint32_t> order(pieces.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return pieces[a].vertices.size() > pieces[b].vertices.size();
  });
  if (keep.kind == Kind::supported) return supported(surface, pieces, order);
  for (std::size_t i = keep.kind == Kind::largest ? 1 : keep.count; i < order.size(); ++i) kept[order[i]] = 0;
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
      if (!surface.unsupported.empty()) rest.unsupported.push_back(surface.unsupported[i]);
    }
  surface = std::move(rest);
}

std::vector<DroppedComponent> filter_components(Surface& surface, const KeepComponents& keep,
                                                const Tetrahedralization& t, const SampleModel& model,
                                                const Labels& labels, const Threads& threads) {
  const std::vector<std::uint32_t> component = triangle_components(surface.mesh, threads.size());
  const std::vector<Piece> pieces = measure_pieces(surface, component, model);
  std::vector<std::uint8_t> kept = choose(surface, pieces, keep);
  settle_cavities(surface, component, t, labels, keep.kind == KeepComponents::Kind::supported, kept);
  std::vector<DroppedComponent> dropped;
  std::vector<std::uint8_t> gone(surface.mesh.triangles.size(), 0);
  for (std::size_t c = 0; c < pieces.size(); ++c) {
    if (kept[c]) continue;
    dropped.push_back({static_cast<std::uint32_t>(pieces[c].vertices.size()),
                       static_cast<std::uint32_t>(pieces[c].triangles.size()), pieces[c].support,
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
