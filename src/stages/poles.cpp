// SPDX-License-Identifier: GPL-3.0-or-later
// §3: the poles of the samples.
#include <eigencrust/stages.h>

#include "geometry/circumsphere.h"
#include "parallel/threads.h"

namespace eigencrust {
namespace {

using Centres = IndexedArray<TetrahedronIndex, Vec3>;

Centres circumcentres(const Tetrahedralization& t, const Threads& threads) {
  Centres centres(t.tetrahedra.size());
  for_each_index(threads, t.tetrahedra.size(), [&](std::size_t i) {
    const auto& [a, b, c, d] = t.tetrahedra.raw()[i];
    centres.raw()[i] = circumcentre(t.positions[a], t.positions[b], t.positions[c], t.positions[d]);
  });
  return centres;
}

struct TetrahedronPair {
  TetrahedronIndex first, second;
};

/// The farthest circumcentre, and the farthest at more than 90 degrees from it. Stars are in increasing
/// order, so the strict comparison leaves ties to the smaller index.
TetrahedronPair pole_tetrahedra(const Vec3& s, std::span<const TetrahedronIndex> star, const Centres& centres) {
  TetrahedronPair pair;
  double farthest = -1;
  for (const TetrahedronIndex t : star) {
    const double d = squared_norm(centres[t] - s);
    if (d > farthest) {
      farthest = d;
      pair.first = t;
    }
  }
  const Vec3 direction = centres[pair.first] - s;
  farthest = -1;
  for (const TetrahedronIndex t : star) {
    const Vec3 offset = centres[t] - s;
    const double d = squared_norm(offset);
    if (d > farthest && dot(offset, direction) < 0) {
      farthest = d;
      pair.second = t;
    }
  }
  return pair;
}

} // namespace

Poles find_poles(const Tetrahedralization& t, const VertexStars& stars, const Threads& threads) {
  const Centres centres = circumcentres(t, threads);
  std::vector<TetrahedronPair> pairs(t.sample_count);
  for_each_index(threads, t.sample_count, [&](std::size_t i) {
    const SampleIndex s{static_cast<std::uint32_t>(i)};
    pairs[i] = pole_tetrahedra(t.positions[s], stars[s], centres);
  });
  Poles poles;
  poles.of_sample = IndexedArray<SampleIndex, PolePair>(t.sample_count);
  IndexedArray<TetrahedronIndex, PoleIndex> pole_of(t.tetrahedra.size());
  const auto number = [&](TetrahedronIndex tetrahedron) {
    if (!tetrahedron.valid()) return PoleIndex{};
    PoleIndex& pole = pole_of[tetrahedron];
    if (!pole.valid()) {
      pole.value = poles.tetrahedron.size();
      poles.tetrahedron.raw().push_back(tetrahedron);
      const Vec3& centre = centres[tetrahedron];
      poles.sphere.raw().push_back({centre, distance(centre, t.positions[t.tetrahedra[tetrahedron][0]])});
    }
    return pole;
  };
  for (std::uint32_t i = 0; i < t.sample_count; ++i) {
    const PoleIndex first = number(pairs[i].first);
    poles.of_sample.raw()[i] = {first, number(pairs[i].second)};
  }
  return poles;
}

} // namespace eigencrust
