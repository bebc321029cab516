// SPDX-License-Identifier: GPL-3.0-or-later
#include "surface/turned_over.h"

#include <algorithm>
#include <array>

#include "geometry/mesh_topology.h"
#include "geometry/signed_volume.h"

namespace eigencrust {
namespace {

struct Piece {
  bool closed = true, touches = false;
  SignedVolume before, after;
};

/// Of each piece, about its first vertex.
std::vector<SignedVolume> volumes(const std::vector<Vec3>& places, std::span<const Triangle> triangles,
                                  std::span<const std::uint32_t> piece_of, std::size_t pieces) {
  std::vector<SignedVolume> volume(pieces);
  std::vector<std::uint32_t> first(pieces, no_index);
  for (std::size_t i = 0; i < piece_of.size(); ++i) {
    const std::uint32_t p = piece_of[i];
    const auto& [a, b, c] = triangles[i];
    if (first[p] == no_index) first[p] = a;
    const Vec3& origin = places[first[p]];
    volume[p].add(places[a] - origin, places[b] - origin, places[c] - origin);
  }
  return volume;
}

/// A body's volume may be hidden by rounding, then it is not negative; what smoothing leaves must be seen.
bool is_spoilt(const Piece& piece) {
  const double before = piece.before.known(), after = piece.after.known();
  return piece.touches || (piece.closed && (before < 0 ? after >= 0 : after <= 0));
}

std::vector<Piece> measure_pieces(const std::vector<Vec3>& before, const TriangleMesh& mesh,
                                  std::span<const std::uint32_t> piece_of, const SurfaceFans& fans,
                                  std::span<const std::uint8_t> at_rim, const Threads& threads) {
  std::vector<Piece> pieces(piece_of.empty() ? 0 : 1 + *std::max_element(piece_of.begin(), piece_of.end()));
  std::array<std::vector<SignedVolume>, 2> volume;
  threads.run(volume.size(), [&](std::size_t k) {
    volume[k] = volumes(k == 0 ? before : mesh.vertices, mesh.triangles, piece_of, pieces.size());
  });
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    pieces[p].before = volume[0][p];
    pieces[p].after = volume[1][p];
  }
  const std::vector<std::uint32_t> first = first_equal_vertex(mesh.vertices);
  std::vector<std::uint8_t> doubled(first.size(), 0);
  for (std::uint32_t v = 0; v < first.size(); ++v)
    if (first[v] != v) doubled[v] = doubled[first[v]] = 1;
  for (std::size_t i = 0; i < piece_of.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = mesh.triangles[i][k];
      if (doubled[v] && mesh.vertices[v] != before[v]) pieces[piece_of[i]].touches = true;
      if (at_rim[v] && fans.is_open(v, mesh.triangles[i][(k + 1) % 3])) pieces[piece_of[i]].closed = false;
    }
  return pieces;
}

/// Has a coarse shell shrunk so far that less is within it than within its cavities? Of open meshes nothing is said.
bool whole_turned(const std::vector<Piece>& pieces) {
  SignedVolume then, now;
  for (const Piece& piece : pieces) {
    if (!piece.closed) return false;
    then = then + piece.before;
    now = now + piece.after;
  }
  return then.known() >= 0 && now.known() < 0;
}

} // namespace

TurnedOver take_back_turned(const std::vector<Vec3>& before, const SurfaceFans& fans, TriangleMesh& mesh,
                            const Threads& threads) {
  const std::vector<std::uint32_t> piece_at = fans.pieces();
  std::vector<std::uint32_t> piece_of; // of each triangle
  piece_of.reserve(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) piece_of.push_back(piece_at[t[0]]);
  const std::vector<std::uint8_t> at_rim = fans.rim_vertices(threads);
  std::vector<std::uint8_t> taken_back;
  std::vector<Piece> pieces;
  for (bool changed = true; changed;) { // what goes back may come to lie on what does not
    changed = false;
    pieces = measure_pieces(before, mesh, piece_of, fans, at_rim, threads);
    taken_back.resize(pieces.size(), 0);
    for (std::size_t i = 0; i < piece_of.size(); ++i) {
      const std::uint32_t p = piece_of[i];
      if (!is_spoilt(pieces[p])) continue;
      if (!taken_back[p]) taken_back[p] = changed = true;
      for (const std::uint32_t v : mesh.triangles[i]) mesh.vertices[v] = before[v];
    }
  }
  if (whole_turned(pieces)) {
    mesh.vertices = before;
    return {taken_back.size()};
  }
  return {static_cast<std::uint64_t>(std::count(taken_back.begin(), taken_back.end(), 1))};
}

} // namespace eigencrust
