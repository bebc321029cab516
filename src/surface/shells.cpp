// SPDX-License-Identifier: GPL-3.0-or-later
#include "surface/shells.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "geometry/mesh_topology.h"
#include "geometry/signed_volume.h"
#include "surface/support.h"

namespace eigencrust {
namespace {

/// Bodies and hollows: what hangs together on one side.
class Regions {
 public:
  Regions(const Tetrahedralization& t, const Labels& labels) : sets_(t.tetrahedra.size()) {
    for (TetrahedronIndex i{0}; i.value < t.tetrahedra.size(); ++i.value)
      for (const TetrahedronIndex n : t.neighbours[i])
        if (n.valid() && n < i && labels[n] == labels[i]) sets_.unite(n.value, i.value);
    depth_.assign(t.tetrahedra.size(), beyond);
    for (TetrahedronIndex i{0}; i.value < t.tetrahedra.size(); ++i.value)
      if (t.touches_cube(i)) depth_[sets_.find(i.value)] = 0;
  }

  std::uint32_t at(TetrahedronIndex i) { return sets_.find(i.value); }
  /// How many walls lie between the region and the cube.
  std::uint32_t& depth(std::uint32_t region) { return depth_[region]; }

  static constexpr std::uint32_t beyond = std::numeric_limits<std::uint32_t>::max();

 private:
  DisjointSets sets_;
  std::vector<std::uint32_t> depth_;
};

/// What lies on either side of a piece.
struct Wall {
  std::uint32_t inside = 0, outside = 0, triangles = 0;
};

/// \param rooms take the free space for the body: bodies in it are then its cavities
std::vector<Wall> walls_of(const Surface& surface, std::span<const std::uint32_t> piece, std::size_t pieces,
                           const Tetrahedralization& t, bool rooms, Regions& regions) {
  std::vector<Wall> walls(pieces);
  for (std::size_t i = 0; i < piece.size(); ++i) {
    Wall& wall = walls[piece[i]];
    if (wall.triangles++ == 0) wall = {regions.at(surface.inside[i]), regions.at(outside_of(surface, i, t)), 1};
  }
  if (rooms)
    for (Wall& wall : walls) std::swap(wall.inside, wall.outside);
  return walls;
}

/// Rooms are holes in a solid that goes on for ever.
bool is_solid_far_away(const Tetrahedralization& t, const Labels& labels) {
  for (TetrahedronIndex i{0}; i.value < t.tetrahedra.size(); ++i.value)
    if (t.touches_cube(i) && labels[i] != Label::inside) return false;
  return true;
}

/// Is there a kept piece whose volume is not surely positive, or around rooms: negative? Mostly there is none.
bool may_be_cavity(const Surface& surface, std::span<const std::uint32_t> piece, std::span<const std::uint8_t> kept,
                   bool rooms) {
  std::vector<SignedVolume> volume(kept.size());
  std::vector<std::uint32_t> first(kept.size(), no_index);
  const auto& places = surface.mesh.vertices;
  for (std::size_t i = 0; i < piece.size(); ++i) {
    const auto& [a, b, c] = surface.mesh.triangles[i];
    if (first[piece[i]] == no_index) first[piece[i]] = a;
    const Vec3& origin = places[first[piece[i]]];
    volume[piece[i]].add(places[a] - origin, places[b] - origin, places[c] - origin);
  }
  for (std::size_t c = 0; c < kept.size(); ++c)
    if (kept[c] && (rooms ? -volume[c].known() : volume[c].known()) <= 0) return true;
  return false;
}

/// From the cube inwards.
void measure_depths(std::span<const Wall> walls, Regions& regions) {
  for (bool changed = true; changed;) { // rounds are as many as regions lie within one another
    changed = false;
    for (const Wall& wall : walls)
      for (const auto& [from, to] : {std::pair{wall.inside, wall.outside}, std::pair{wall.outside, wall.inside}}) {
        const std::uint32_t depth = regions.depth(from);
        if (depth == Regions::beyond || regions.depth(to) <= depth + 1) continue;
        regions.depth(to) = depth + 1;
        changed = true;
      }
  }
}

bool is_cavity(const Wall& wall, Regions& regions) { return regions.depth(wall.inside) < regions.depth(wall.outside); }

/// Turns pieces that face inward when only those that are kept divide the space.
void turn_without_shell(Surface& surface, std::span<const std::uint32_t> piece, const Tetrahedralization& t,
                        std::span<const std::uint8_t> kept, Regions& regions, std::vector<Wall>& walls) {
  const auto outer = [&](const Wall& wall) { // the side nearer to the cube
    return is_cavity(wall, regions) ? wall.inside : wall.outside;
  };
  const auto inner = [&](const Wall& wall) { return is_cavity(wall, regions) ? wall.outside : wall.inside; };
  std::vector<std::uint32_t> inward(walls.size()); // those nearer to the cube first
  std::iota(inward.begin(), inward.end(), 0u);
  std::stable_sort(inward.begin(), inward.end(), [&](std::uint32_t a, std::uint32_t b) {
    return regions.depth(outer(walls[a])) < regions.depth(outer(walls[b]));
  });
  // An open surface may be several pieces; one of them is enough.
  std::vector<std::uint8_t> is_walled(t.tetrahedra.size(), 0), changed(t.tetrahedra.size(), 0);
  for (std::size_t c = 0; c < walls.size(); ++c) is_walled[inner(walls[c])] |= kept[c];
  // Is a region on the other side than its label says, with the dropped walls gone?
  for (const std::uint32_t c : inward)
    if (const std::uint32_t from = outer(walls[c]), to = inner(walls[c]); regions.depth(to) > regions.depth(from))
      changed[to] = changed[from] != (is_walled[to] == 0);
  for (std::size_t i = 0; i < piece.size(); ++i) {
    if (!kept[piece[i]] || !changed[walls[piece[i]].inside]) continue;
    const TetrahedronIndex other = outside_of(surface, i, t);
    std::swap(surface.mesh.triangles[i][1], surface.mesh.triangles[i][2]);
    surface.inside[i] = other;
  }
  for (std::size_t c = 0; c < walls.size(); ++c)
    if (kept[c] && changed[walls[c].inside]) std::swap(walls[c].inside, walls[c].outside);
}

void keep_shells(std::span<const Wall> walls, Regions& regions, std::vector<std::uint8_t>& kept) {
  for (std::size_t c = 0; c < walls.size(); ++c) {
    if (!kept[c] || !is_cavity(walls[c], regions)) continue;
    // The one shell; a body that is open at the back of a scan may have several, of which the largest will do.
    std::size_t shell = walls.size();
    for (std::size_t s = 0; s < walls.size(); ++s)
      if (walls[s].inside == walls[c].inside && !is_cavity(walls[s], regions) &&
          (shell == walls.size() || kept[s] > kept[shell] ||
           (kept[s] == kept[shell] && walls[s].triangles > walls[shell].triangles)))
        shell = s;
    if (shell == walls.size())
      kept[c] = 0;
    else
      kept[shell] = 1;
  }
}

} // namespace

void settle_cavities(Surface& surface, std::span<const std::uint32_t> piece, const Tetrahedralization& t,
                     const Labels& labels, bool turn, std::vector<std::uint8_t>& kept) {
  const bool rooms = is_solid_far_away(t, labels);
  if (!may_be_cavity(surface, piece, kept, rooms)) return;
  Regions regions(t, labels);
  std::vector<Wall> walls = walls_of(surface, piece, kept.size(), t, rooms, regions);
  measure_depths(walls, regions);
  if (turn && !rooms) turn_without_shell(surface, piece, t, kept, regions, walls);
  keep_shells(walls, regions, kept);
}

} // namespace eigencrust
