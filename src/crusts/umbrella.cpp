// SPDX-License-Identifier: GPL-3.0-or-later
#include "crusts/umbrella.h"

#include <algorithm>
#include <array>

#include "geometry/tetrahedron.h"

namespace eigencrust {
namespace {

// Faces that follow each other around a sample make an angle of at most 2π/3 (Dey and Goswami 2003).
constexpr double sharpest_cosine = -0.5;

} // namespace

std::uint32_t Umbrellas::place_of(TetrahedronIndex i) const {
  for (std::uint32_t k = 0; k < star_.size(); ++k)
    if (star_[k] == i) return k;
  return no_index;
}

/// Is the face of the sample and the two others but `others(i)[k]` in the cocone?
bool Umbrellas::is_wall(std::uint32_t i, std::size_t k) const {
  const TetrahedronIndex here = star_[i];
  const auto& v = t_.tetrahedra[here];
  const auto corner = static_cast<std::size_t>(std::find(v.begin(), v.end(), star_.others(i)[k]) - v.begin());
  return cocone_.face[here][corner];
}

void Umbrellas::flood(std::uint32_t start) {
  in_part_.assign(star_.size(), 0);
  in_part_[start] = 1;
  stack_.assign(1, start);
  while (!stack_.empty()) {
    const std::uint32_t i = stack_.back();
    stack_.pop_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t n = star_.neighbours(i)[k];
      if (n == no_index || in_part_[n] || is_wall(i, k)) continue;
      in_part_[n] = 1;
      stack_.push_back(n);
    }
  }
}

/// The edges opposite the sample of the faces that bound the part, each turning the same way around it.
std::vector<Umbrellas::Side> Umbrellas::rim() const {
  std::vector<Side> rim;
  for (std::uint32_t i = 0; i < star_.size(); ++i) {
    if (!in_part_[i]) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t n = star_.neighbours(i)[k];
      if (n != no_index && in_part_[n]) continue;
      const auto& v = t_.tetrahedra[star_[i]];
      const auto opposite = static_cast<std::size_t>(std::find(v.begin(), v.end(), star_.others(i)[k]) - v.begin());
      std::array<SampleIndex, 3> face{};
      for (std::size_t c = 0; c < 3; ++c) face[c] = v[face_opposite[opposite][c]];
      std::rotate(face.begin(), std::find(face.begin(), face.end(), sample_), face.end());
      rim.push_back({face[1], face[2], star_[i]});
    }
  }
  return rim;
}

/// One closed chain without a sharp fold?
bool Umbrellas::is_disc(SampleIndex s) const {
  const std::vector<Side> sides = rim();
  if (sides.size() < 3) return false;
  const auto normal = [&](const Side& side) {
    const Vec3 n = cross(t_.positions[side.from] - t_.positions[s], t_.positions[side.to] - t_.positions[s]);
    return (1 / norm(n)) * n;
  };
  std::size_t length = 0;
  Side here = sides.front();
  do {
    Side next{};
    std::size_t count = 0;
    for (const Side& side : sides)
      if (side.from == here.to) {
        next = side;
        ++count;
      }
    if (count != 1 || dot(normal(here), normal(next)) <= sharpest_cosine) return false;
    here = next;
  } while (++length < sides.size() && here.from != sides.front().from);
  return length == sides.size() && here.from == sides.front().from;
}

bool Umbrellas::is_good(SampleIndex s) {
  const auto [first, second] = scene_.poles.of_sample[s];
  if (!cocone_.flat[s.value] || !second.valid()) return false;
  star_.fill(s);
  sample_ = s;
  const std::uint32_t up = place_of(scene_.poles.tetrahedron[first]), down = place_of(scene_.poles.tetrahedron[second]);
  if (up == no_index || down == no_index) return false;
  flood(up);
  if (in_part_[down] || !is_disc(s)) return false;
  flood(down);
  return is_disc(s);
}

Umbrellas::Part Umbrellas::part() const {
  Part part;
  for (std::uint32_t i = 0; i < star_.size(); ++i)
    if (in_part_[i]) part.tetrahedra.push_back(star_[i]);
  for (const auto& [a, b, behind] : rim()) {
    part.rim.emplace_back(a, behind);
    part.rim.emplace_back(b, behind);
  }
  return part;
}

std::pair<Umbrellas::Part, Umbrellas::Part> Umbrellas::sides_of(SampleIndex s, TetrahedronIndex from) {
  star_.fill(s);
  const auto [first, second] = scene_.poles.of_sample[s];
  const std::array poles{place_of(scene_.poles.tetrahedron[first]), place_of(scene_.poles.tetrahedron[second])};
  const std::uint32_t start = place_of(from);
  std::array<Part, 2> side;
  bool here = false;
  for (std::size_t k = 0; k < 2; ++k) {
    flood(poles[k]);
    const bool holds_it = in_part_[start] != 0;
    here = here || holds_it;
    side[holds_it ? 0 : 1] = part();
  }
  if (!here) return {};
  return {std::move(side[0]), std::move(side[1])};
}

} // namespace eigencrust
