// SPDX-License-Identifier: GPL-3.0-or-later
#include "crusts/robust_cocone.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "geometry/nearest.h"
#include "tetrahedra/circumsphere.h"

namespace eigencrust {
namespace {

// A ball is big when its radius is so many times the mean distance of one of its samples to its nearest ones.
constexpr double big = 4;
constexpr std::size_t nearest_samples = 3;
// Balls intersect deeply when their radii to where they cross make less than this: outer and inner balls nearly touch
// and have theirs nearly opposite.
const double deep_cosine = std::cos(std::numbers::pi / 3);

class OuterBalls {
 public:
  OuterBalls(const Scene& scene, const Threads& threads)
      : t_(scene.tetrahedralization), ball_(t_.tetrahedra.size()), big_(t_.tetrahedra.size()) {
    const SampleLengths reach = mean_distances(threads);
    for_each_index(threads, t_.tetrahedra.size(), [&](std::size_t at) {
      const TetrahedronIndex i{static_cast<std::uint32_t>(at)};
      const auto& v = t_.tetrahedra[i];
      const Vec3& p = t_.positions[v[0]];
      const Vec3 centre = circumcentre(p, t_.positions[v[1]], t_.positions[v[2]], t_.positions[v[3]]);
      ball_[i] = {centre, distance(centre, p)};
      big_[i] = std::any_of(v.begin(), v.end(), [&](VertexIndex s) {
        return t_.is_corner(s) || ball_[i].radius > big * static_cast<double>(reach[t_.sample(s)]);
      });
    });
  }

  IndexedArray<SampleIndex, std::uint8_t> samples() {
    std::vector<std::uint8_t> outer(t_.tetrahedra.size(), 0);
    std::vector<TetrahedronIndex> stack;
    for (TetrahedronIndex i{0}; i.value < t_.tetrahedra.size(); ++i.value)
      if (t_.touches_cube(i)) {
        outer[i.value] = 1;
        stack.push_back(i);
      }
    while (!stack.empty()) {
      const TetrahedronIndex i = stack.back();
      stack.pop_back();
      for (const TetrahedronIndex n : t_.neighbours[i]) {
        if (!n.valid() || outer[n.value] || !big_[n] || !intersect_deeply(ball_[i], ball_[n])) continue;
        outer[n.value] = 1;
        stack.push_back(n);
      }
    }
    IndexedArray<SampleIndex, std::uint8_t> kept(t_.sample_count, 0);
    for (TetrahedronIndex i{0}; i.value < t_.tetrahedra.size(); ++i.value)
      if (outer[i.value])
        for (const VertexIndex s : t_.tetrahedra[i])
          if (!t_.is_corner(s)) kept[t_.sample(s)] = 1;
    return kept;
  }

 private:
  static bool intersect_deeply(const Sphere& a, const Sphere& b) {
    const double d2 = squared_norm(a.centre - b.centre);
    return d2 <= a.radius * a.radius + b.radius * b.radius - 2 * a.radius * b.radius * deep_cosine;
  }

  /// Of each sample to its nearest ones.
  [[nodiscard]] SampleLengths mean_distances(const Threads& threads) const {
    const std::span<const Vec3> samples(t_.positions.raw().data(), t_.sample_count);
    const PointTree tree(samples);
    SampleLengths mean(samples.size());
    for_each_index(threads, samples.size(), [&](std::size_t s) {
      std::array<std::uint32_t, nearest_samples + 1> index{};
      std::array<double, nearest_samples + 1> squared{};
      const std::size_t found = tree.nearest(samples[s], index.size(), index.data(), squared.data());
      double sum = 0;
      for (std::size_t k = 1; k < found; ++k) sum += std::sqrt(squared[k]); // the first is the sample itself
      mean.raw()[s] = static_cast<float>(sum / static_cast<double>(found - 1));
    });
    return mean;
  }

  const Tetrahedralization& t_;
  IndexedArray<TetrahedronIndex, Sphere> ball_;
  IndexedArray<TetrahedronIndex, std::uint8_t> big_;
};

} // namespace

IndexedArray<SampleIndex, std::uint8_t> outer_samples(const Scene& scene, const Threads& threads) {
  return OuterBalls(scene, threads).samples();
}

} // namespace eigencrust
