// SPDX-License-Identifier: GPL-3.0-or-later
#include "tetrahedra/assemble.h"

#include <algorithm>

#include <eigencrust/error.h>

#include "geometry/predicates.h"
#include "parallel/threads.h"

namespace eigencrust {
namespace {

// "Much wider than the cloud" (§3): no sample may lie near a side.
constexpr double cube_half_side_in_diagonals = 10;

/// The tiles one behind the other, which is the order of all tetrahedra: ranges follow one another, and tetrahedra
/// are sorted by their smallest vertex.
void join(std::vector<Tile>& tiles, Tetrahedralization& t, const Threads& threads) {
  std::vector<std::uint32_t> first;
  std::uint64_t count = 0;
  for (const Tile& tile : tiles) {
    first.push_back(static_cast<std::uint32_t>(count));
    count += tile.tetrahedra.size();
    if (count >= no_index)
      throw Error(ErrorKind::memory, "delaunay", "more than 4 billion tetrahedra", "split the cloud");
  }
  auto& tetrahedra = t.tetrahedra.raw();
  auto& neighbours = t.neighbours.raw();
  if (tiles.size() == 1) {
    tetrahedra = std::move(tiles.front().tetrahedra);
    neighbours = std::move(tiles.front().neighbours);
    return;
  }
  tetrahedra.resize(count);
  threads.run(tiles.size(), [&](std::size_t i) {
    std::copy(tiles[i].tetrahedra.begin(), tiles[i].tetrahedra.end(), tetrahedra.begin() + first[i]);
    tiles[i].tetrahedra = {};
  });
  neighbours.resize(count);
  threads.run(tiles.size(), [&](std::size_t i) {
    std::transform(tiles[i].neighbours.begin(), tiles[i].neighbours.end(), neighbours.begin() + first[i], [&](auto n) {
      for (TetrahedronIndex& k : n)
        if (k.valid()) k.value += first[i];
      return n;
    });
    tiles[i].neighbours = {};
    for (OpenFace& face : tiles[i].open) face.tetrahedron.value += first[i];
  });
}

/// Each open face has two sides, one in each of two tiles.
void close_faces(const std::vector<Tile>& tiles, Tetrahedralization& t, const Threads& threads) {
  std::vector<OpenFace> open;
  for (const Tile& tile : tiles) open.insert(open.end(), tile.open.begin(), tile.open.end());
  sort_blocks(threads, open);
  const auto differ = [&] {
    return Error(ErrorKind::guarantee, "delaunay", "parts of the triangulation do not fit together",
                 "report this as a fault of the program");
  };
  if (open.size() % 2 != 0) throw differ();
  for (std::size_t i = 0; i < open.size(); i += 2) {
    const OpenFace &a = open[i], &b = open[i + 1];
    if (a.vertices != b.vertices) throw differ();
    t.neighbours[a.tetrahedron][a.corner] = b.tetrahedron;
    t.neighbours[b.tetrahedron][b.corner] = a.tetrahedron;
  }
}

} // namespace

Tetrahedralization enclose(Samples samples) {
  const int dimension = affine_dimension(samples.positions.raw());
  if (dimension <= 2)
    throw Error(ErrorKind::input, "delaunay", dimension < 2 ? "all points are collinear" : "all points are coplanar",
                "give points that surround a volume");
  Tetrahedralization result;
  result.origin = samples.origin;
  result.sample_count = samples.positions.size();
  result.positions.raw() = std::move(samples.positions.raw());
  result.source = std::move(samples.source);
  const double h = cube_half_side_in_diagonals * samples.bounds.diagonal();
  const Vec3 middle = samples.bounds.centre() - samples.origin;
  for (const double x : {-h, h})
    for (const double y : {-h, h})
      for (const double z : {-h, h}) result.positions.raw().push_back(middle + Vec3{x, y, z});
  return result;
}

void assemble(std::vector<Tile> tiles, Tetrahedralization& t, const Threads& threads) {
  join(tiles, t, threads);
  close_faces(tiles, t, threads);
}

} // namespace eigencrust
