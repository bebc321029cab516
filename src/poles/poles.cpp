// SPDX-License-Identifier: GPL-3.0-or-later
// §3: the poles of the samples.
#include <algorithm>
#include <optional>

#include <eigencrust/stages.h>

#include "geometry/nearest.h"
#include "parallel/threads.h"
#include "tetrahedra/circumsphere.h"

namespace eigencrust {
namespace {

using Centres = IndexedArray<TetrahedronIndex, Vec3>;

/// \param first another piece of work, begun before all others
template <class Work>
Centres circumcentres(const Tetrahedralization& t, const Threads& threads, const Work& first) {
  Centres centres(t.tetrahedra.size());
  const std::size_t n = centres.size(), blocks = (n + default_block - 1) / default_block;
  threads.run(blocks + 1, [&](std::size_t b) {
    if (b == 0) return first();
    for (std::size_t i = (b - 1) * default_block; i < std::min(n, b * default_block); ++i) {
      const auto& [p, q, r, s] = t.tetrahedra.raw()[i];
      centres.raw()[i] = circumcentre(t.positions[p], t.positions[q], t.positions[r], t.positions[s]);
    }
  });
  return centres;
}

struct TetrahedronPair {
  TetrahedronIndex first, second;
};

/// Where the cell of a sample leaves the cloud: the mean direction of the centres of its tetrahedra at the cube. A cell
/// at a sharp corner leaves it in several directions at right angles (Amenta and Bern 1999).
Vec3 way_out(const Tetrahedralization& t, const Vec3& s, std::span<const TetrahedronIndex> star,
             const Centres& centres) {
  Vec3 sum;
  for (const TetrahedronIndex i : star) {
    if (!t.touches_cube(i)) continue;
    const Vec3 way = centres[i] - s;
    const double length = norm(way);
    if (length > 0) sum = sum + (1 / length) * way;
  }
  return sum;
}

/// The farthest of some centres from s, and the farthest at more than 90 degrees from a direction that it tells. Ties
/// go to the smaller index.
template <class ForEach, class DirectionOf>
TetrahedronPair farthest_pair(const Vec3& s, const Centres& centres, const ForEach& for_each,
                              const DirectionOf& direction_of) {
  TetrahedronPair pair;
  const auto find = [&](TetrahedronIndex& best, const auto& is_allowed) {
    double farthest = -1;
    for_each([&](TetrahedronIndex i) {
      const Vec3 offset = centres[i] - s;
      const double d = squared_norm(offset);
      if (!(d > farthest || (d == farthest && i < best)) || !is_allowed(offset)) return;
      farthest = d;
      best = i;
    });
  };
  find(pair.first, [](const Vec3&) { return true; });
  if (!pair.first.valid()) return pair; // no centre is finite
  const Vec3 direction = direction_of(pair.first);
  find(pair.second, [&](const Vec3& offset) { return dot(offset, direction) < 0; });
  return pair;
}

/// Among the circumcentres around the sample.
TetrahedronPair pole_tetrahedra(const Tetrahedralization& t, const Vec3& s, std::span<const TetrahedronIndex> star,
                                const Centres& centres, Weights weights) {
  return farthest_pair(
      s, centres, [&](auto&& visit) { std::for_each(star.begin(), star.end(), visit); },
      [&](TetrahedronIndex first) {
        const bool leaves = weights == Weights::evidence && t.touches_cube(first);
        return leaves ? way_out(t, s, star, centres) : centres[first] - s;
      });
}

/// Among the poles of the samples `near`.
TetrahedronPair widest_pair(const Vec3& s, std::span<const std::uint32_t> near, std::span<const TetrahedronPair> own,
                            const Centres& centres) {
  return farthest_pair(
      s, centres,
      [&](auto&& visit) {
        for (const std::uint32_t j : near)
          for (const TetrahedronIndex i : {own[j].first, own[j].second})
            if (i.valid()) visit(i);
      },
      [&](TetrahedronIndex first) { return centres[first] - s; });
}

/// Replaces the pairs of samples whose reach exceeds the distance to their neighbours.
void widen_pairs(const Tetrahedralization& t, std::span<const float> reach, const PointTree& tree,
                 const Centres& centres, std::vector<TetrahedronPair>& pairs, const Threads& threads) {
  const std::vector<TetrahedronPair> own = pairs;
  for_each_index(
      threads, t.sample_count,
      [&](std::size_t i) {
        if (!(reach[i] > 0)) return;
        const Vec3& s = t.positions.raw()[i];
        const std::vector<std::uint32_t> near = tree.within(s, static_cast<double>(reach[i]));
        if (near.size() > 1) pairs[i] = widest_pair(s, near, own, centres);
      },
      costly_block);
}

} // namespace

Poles find_poles(const Tetrahedralization& t, const VertexStars& stars, std::span<const float> reach, Weights weights,
                 const Threads& threads) {
  const bool some_reach = std::any_of(reach.begin(), reach.end(), [](float r) { return r > 0; });
  std::optional<PointTree> tree;
  const Centres centres = circumcentres(t, threads, [&] {
    if (some_reach) tree.emplace(std::span(t.positions.raw()).first(t.sample_count));
  });
  std::vector<TetrahedronPair> pairs(t.sample_count);
  for_each_index(threads, t.sample_count, [&](std::size_t i) {
    const SampleIndex s{static_cast<std::uint32_t>(i)};
    pairs[i] = pole_tetrahedra(t, t.positions[s], stars[s], centres, weights);
  });
  if (tree) widen_pairs(t, reach, *tree, centres, pairs, threads);
  Poles poles;
  poles.of_sample = IndexedArray<SampleIndex, PolePair>(t.sample_count);
  IndexedArray<TetrahedronIndex, PoleIndex> pole_of(t.tetrahedra.size());
  const auto number = [&](TetrahedronIndex tetrahedron) {
    if (!tetrahedron.valid()) return PoleIndex{};
    PoleIndex& pole = pole_of[tetrahedron];
    if (!pole.valid()) {
      pole.value = poles.tetrahedron.size();
      poles.tetrahedron.raw().push_back(tetrahedron);
    }
    return pole;
  };
  for (std::uint32_t i = 0; i < t.sample_count; ++i) {
    const PoleIndex first = number(pairs[i].first);
    poles.of_sample.raw()[i] = {first, number(pairs[i].second)};
  }
  poles.sphere = IndexedArray<PoleIndex, Sphere>(poles.tetrahedron.size());
  for_each_index(threads, poles.tetrahedron.size(), [&](std::size_t p) {
    const TetrahedronIndex tetrahedron = poles.tetrahedron.raw()[p];
    const Vec3& centre = centres[tetrahedron];
    poles.sphere.raw()[p] = {centre, distance(centre, t.positions[t.tetrahedra[tetrahedron][0]])};
  });
  return poles;
}

} // namespace eigencrust
