// SPDX-License-Identifier: GPL-3.0-or-later
#include "repair/surface_fronts.h"

#include <algorithm>

namespace eigencrust {

std::int64_t SurfaceFronts::pieces(const std::vector<std::uint32_t>& samples) {
  for (const std::uint32_t s : samples) {
    if (!labels_.on_surface(VertexIndex{s})) continue;
    owner_[s] = static_cast<std::uint32_t>(root_.size());
    root_.push_back(owner_[s]);
    rim_.push_back({s});
    reached_.push_back(s);
  }
  std::vector<std::uint32_t> growing = root_;
  std::int64_t ended = 0;
  while (growing.size() > 1) {
    for (const std::uint32_t f : growing)
      if (root_[f] == f) grow(f);
    std::erase_if(growing, [&](std::uint32_t f) {
      if (root_[f] != f) return true;
      if (!rim_[f].empty()) return false;
      ++ended;
      return true;
    });
  }
  for (const std::uint32_t s : reached_) owner_[s] = none;
  return ended + static_cast<std::int64_t>(growing.size());
}

std::uint32_t SurfaceFronts::root_of(std::uint32_t front) {
  while (root_[front] != front) front = root_[front] = root_[root_[front]];
  return front;
}

/// By one ring.
void SurfaceFronts::grow(std::uint32_t front) {
  std::vector<std::uint32_t> ring, next;
  std::swap(ring, rim_[front]);
  for (const std::uint32_t s : ring)
    for_each_surface_face(t_, stars_, labels_, VertexIndex{s}, [&](TetrahedronIndex i, std::size_t k) {
      for (std::size_t j = 0; j < 4; ++j) { // the other two of a triangle of the surface
        const std::uint32_t other = t_.tetrahedra[i][j].value;
        if (j == k || other == s) continue;
        if (owner_[other] != none) {
          front = join(front, root_of(owner_[other]));
          continue;
        }
        owner_[other] = front;
        reached_.push_back(other);
        next.push_back(other);
      }
    });
  rim_[front].insert(rim_[front].end(), next.begin(), next.end());
}

std::uint32_t SurfaceFronts::join(std::uint32_t a, std::uint32_t b) {
  if (a == b) return a;
  if (rim_[a].size() < rim_[b].size()) std::swap(a, b);
  root_[b] = a;
  rim_[a].insert(rim_[a].end(), rim_[b].begin(), rim_[b].end());
  rim_[b] = {};
  return a;
}

} // namespace eigencrust
