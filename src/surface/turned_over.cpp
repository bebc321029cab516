// SPDX-License-Identifier: GPL-3.0-or-later
#include "surface/turned_over.h"

#include <algorithm>

#include <eigencrust/validate.h>

#include "geometry/mesh_topology.h"
#include "geometry/signed_volume.h"

namespace eigencrust {
namespace {

struct Piece {
  bool met = false, closed = true, touches = false;
  SignedVolume before, after;
  Vec3 origin_before, origin_after;
};

void add_to(SignedVolume& volume, const std::vector<Vec3>& places, const Triangle& t, const Vec3& origin) {
  volume.add(places[t[0]] - origin, places[t[1]] - origin, places[t[2]] - origin);
}

/// A body's volume may be hidden by rounding, then it is not negative; what smoothing leaves must be seen.
bool is_spoilt(const Piece& piece) {
  const double before = piece.before.known(), after = piece.after.known();
  return piece.touches || (piece.closed && (before < 0 ? after >= 0 : after <= 0));
}

std::vector<Piece> measure_pieces(const std::vector<Vec3>& before, const TriangleMesh& mesh,
                                  std::span<const std::uint32_t> piece_of, const SurfaceFans& fans,
                                  std::span<const std::uint8_t> at_rim) {
  std::vector<Piece> pieces;
  for (std::size_t i = 0; i < piece_of.size(); ++i) {
    const Triangle& t = mesh.triangles[i];
    if (piece_of[i] >= pieces.size()) pieces.resize(piece_of[i] + 1);
    Piece& piece = pieces[piece_of[i]];
    if (!piece.met) {
      piece.met = true;
      piece.origin_before = before[t[0]];
      piece.origin_after = mesh.vertices[t[0]];
    }
    add_to(piece.before, before, t, piece.origin_before);
    add_to(piece.after, mesh.vertices, t, piece.origin_after);
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
bool whole_turned(const std::vector<Vec3>& before, const TriangleMesh& mesh, std::span<const std::uint8_t> at_rim) {
  if (std::find(at_rim.begin(), at_rim.end(), 1) != at_rim.end()) return false;
  SignedVolume then, now;
  for (const Triangle& t : mesh.triangles) {
    add_to(then, before, t, before[mesh.triangles[0][0]]);
    add_to(now, mesh.vertices, t, mesh.vertices[mesh.triangles[0][0]]);
  }
  return then.known() >= 0 && now.known() < 0;
}

} // namespace

TurnedOver take_back_turned(const std::vector<Vec3>& before, const SurfaceFans& fans, TriangleMesh& mesh,
                            const Threads& threads) {
  const std::vector<std::uint32_t> piece_of = triangle_components(mesh, threads.size());
  const std::vector<std::uint8_t> at_rim = fans.rim_vertices(threads);
  std::vector<std::uint8_t> taken_back;
  for (bool changed = true; changed;) { // what goes back may come to lie on what does not
    changed = false;
    const std::vector<Piece> pieces = measure_pieces(before, mesh, piece_of, fans, at_rim);
    taken_back.resize(pieces.size(), 0);
    for (std::size_t i = 0; i < piece_of.size(); ++i) {
      const std::uint32_t p = piece_of[i];
      if (!is_spoilt(pieces[p])) continue;
      if (!taken_back[p]) taken_back[p] = changed = true;
      for (const std::uint32_t v : mesh.triangles[i]) mesh.vertices[v] = before[v];
    }
  }
  if (whole_turned(before, mesh, at_rim)) {
    mesh.vertices = before;
    return {taken_back.size()};
  }
  return {static_cast<std::uint64_t>(std::count(taken_back.begin(), taken_back.end(), 1))};
}

} // namespace eigencrust
