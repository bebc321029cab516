// SPDX-License-Identifier: GPL-3.0-or-later
// Which samples may be outliers, and how far their neighbourhood reaches (not in the paper;
// docs/decisions/0013).
#include <algorithm>
#include <limits>

#include <eigencrust/stages.h>

#include "geometry/nearest.h"
#include "parallel/threads.h"

namespace eigencrust {
namespace {

// A sample is isolated when its third nearest neighbour is farther than so many times the typical one.
constexpr double isolation = 5;
constexpr std::size_t neighbourhood = 20;

/// Third shortest Delaunay edge at s: the third nearest neighbour, or a little more.
double third_shortest_edge(const Tetrahedralization& t, const VertexStars& stars, SampleIndex s) {
  std::array<std::pair<double, SampleIndex>, 3> shortest;
  shortest.fill({std::numeric_limits<double>::infinity(), SampleIndex{}});
  for (const TetrahedronIndex tetrahedron : stars[s])
    for (const SampleIndex v : t.tetrahedra[tetrahedron]) {
      if (v == s || t.is_corner(v)) continue;
      const std::pair<double, SampleIndex> edge{distance(t.positions[s], t.positions[v]), v};
      if (!(edge < shortest[2]) || edge == shortest[0] || edge == shortest[1]) continue;
      shortest[2] = edge;
      std::sort(shortest.begin(), shortest.end());
    }
  return shortest[2].first;
}

} // namespace

std::vector<float> isolated_neighbourhoods(const Tetrahedralization& t, const VertexStars& stars,
                                           const Threads& threads) {
  std::vector<double> third(t.sample_count);
  for_each_index(threads, t.sample_count, [&](std::size_t i) {
    third[i] = third_shortest_edge(t, stars, SampleIndex{static_cast<std::uint32_t>(i)});
  });
  std::vector<double> sorted = third;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  const double limit = isolation * *middle;
  std::vector<float> radius(t.sample_count, 0.0f);
  if (std::none_of(third.begin(), third.end(), [&](double d) { return d > limit; })) return radius;
  const PointTree tree(std::span(t.positions.raw()).first(t.sample_count));
  for_each_index(
      threads, t.sample_count,
      [&](std::size_t i) {
        if (!(third[i] > limit)) return;
        std::array<std::uint32_t, neighbourhood + 1> index{};
        std::array<double, neighbourhood + 1> square{};
        const std::size_t found = tree.nearest(t.positions.raw()[i], neighbourhood + 1, index.data(), square.data());
        // The third nearest sample may be joined by no Delaunay edge.
        if (found > 3 && std::sqrt(square[3]) <= limit) return;
        radius[i] = static_cast<float>(std::sqrt(square[found - 1]));
      },
      512);
  return radius;
}

} // namespace eigencrust
