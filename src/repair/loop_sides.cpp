// SPDX-License-Identifier: GPL-3.0-or-later
#include "repair/loop_sides.h"

#include <algorithm>

#include "geometry/tetrahedron.h"
#include "repair/surface_fronts.h"

namespace eigencrust {

bool LoopSides::fall_apart(std::span<const std::uint32_t> loop, std::uint64_t most) {
  looked_through_ = {};
  for (const std::uint32_t s : loop) side_[s] = on_loop;
  bool met = sides_meet(loop), ended = false;
  while (!met && !ended && reached_[left].size() + reached_[right].size() <= most) {
    // In turn the one that is smaller so far.
    const Side side = reached_[left].size() <= reached_[right].size() ? left : right;
    ended = looked_through_[side] == reached_[side].size();
    met = !ended && grow(side);
  }
  for (const std::uint32_t s : loop) side_[s] = neither;
  for (auto& reached : reached_) {
    for (const std::uint32_t s : reached) side_[s] = neither;
    reached.clear();
  }
  return ended && !met;
}

/// Starts both. \return whether they meet at the loop, or it is none
bool LoopSides::sides_meet(std::span<const std::uint32_t> loop) {
  std::vector<Face> faces;
  for (std::size_t k = 0; k < loop.size(); ++k)
    if (!faces_at(loop, k, faces)) return true;
  bool met = false;
  for (const Face& face : faces)
    for (const std::uint32_t s : face.others) met = met || reach(s, face.side);
  // A triangle between three samples of the loop may be on one side of one and on the other of another.
  std::sort(faces.begin(), faces.end(), [](const Face& a, const Face& b) { return a.name < b.name; });
  return met || std::adjacent_find(faces.begin(), faces.end(), [](const Face& a, const Face& b) {
                  return a.name == b.name && a.side != b.side;
                }) != faces.end();
}

/// Appends the faces at a sample of the loop: from the next sample counterclockwise to the one before they are on the
/// left. \return false where no faces lead there
bool LoopSides::faces_at(std::span<const std::uint32_t> loop, std::size_t at, std::vector<Face>& faces) const {
  const std::uint32_t here = loop[at], next = loop[(at + 1) % loop.size()],
                      before = loop[(at + loop.size() - 1) % loop.size()];
  const auto first = static_cast<std::ptrdiff_t>(faces.size());
  for_each_surface_face(t_, stars_, labels_, VertexIndex{here}, [&](TetrahedronIndex i, std::size_t k) {
    std::array<std::uint32_t, 3> v{};
    for (std::size_t j = 0; j < v.size(); ++j) v[j] = t_.tetrahedra[i][face_opposite[k][j]].value;
    std::rotate(v.begin(), std::find(v.begin(), v.end(), here), v.end());
    faces.push_back({std::uint64_t{4} * i.value + k, {v[1], v[2]}, right});
  });
  for (std::uint32_t edge = next; edge != before;) {
    const auto face = std::find_if(faces.begin() + first, faces.end(),
                                   [&](const Face& f) { return f.others[0] == edge && f.side == right; });
    if (face == faces.end()) return false;
    face->side = left;
    edge = face->others[1];
  }
  return true;
}

/// \return whether the other side was there before
bool LoopSides::reach(std::uint32_t sample, Side side) {
  if (side_[sample] == neither) {
    side_[sample] = side;
    reached_[side].push_back(sample);
  }
  return side_[sample] != side && side_[sample] != on_loop;
}

/// By the neighbours of one sample. \return whether it meets the other side
bool LoopSides::grow(Side side) {
  bool met = false;
  const std::uint32_t from = reached_[side][looked_through_[side]++];
  for_each_surface_face(t_, stars_, labels_, VertexIndex{from}, [&](TetrahedronIndex i, std::size_t k) {
    for (const std::size_t j : face_opposite[k]) met = reach(t_.tetrahedra[i][j].value, side) || met;
  });
  return met;
}

} // namespace eigencrust
