// SPDX-License-Identifier: GPL-3.0-or-later
#include "tetrahedra/star_search.h"

#include <gtest/gtest.h>
#include <algorithm>

#include "clouds.h"

namespace eigencrust {
namespace {

using clouds::Prepared;

/// By looking at all other samples.
double searched(const Tetrahedralization& t, SampleIndex sample, std::size_t k) {
  std::vector<double> distances;
  for (SampleIndex s{0}; s.value < t.sample_count; ++s.value)
    distances.push_back(distance(t.positions[s], t.positions[sample]));
  std::sort(distances.begin(), distances.end());
  return distances[std::min(k, distances.size() - 1)];
}

TEST(StarSearch, FindsWhatLookingAtAllFinds) {
  // A lattice has many samples on common spheres.
  for (const clouds::Points& points : {clouds::random_box(300, 1), clouds::lattice(6, 5, 4), clouds::sphere(200)}) {
    const Prepared p = clouds::prepare(points);
    StarSearch search(p.t, p.stars);
    for (SampleIndex s{0}; s.value < p.t.sample_count; ++s.value)
      for (const std::size_t k : {1u, 3u, 8u, 40u})
        ASSERT_DOUBLE_EQ(search.distance_to_nearest(s, k), searched(p.t, s, k)) << s.value << " " << k;
  }
}

TEST(StarSearch, FindsTheFarthestOfTooFew) {
  const Prepared p = clouds::prepare(clouds::lattice(2, 2, 2));
  EXPECT_DOUBLE_EQ(StarSearch(p.t, p.stars).distance_to_nearest(SampleIndex{0}, 100), std::sqrt(3.0));
}

TEST(DistinctNumbers, AreNewOnceInEachList) {
  DistinctNumbers numbers(3);
  EXPECT_TRUE(numbers.add(2));
  EXPECT_TRUE(numbers.add(0));
  EXPECT_FALSE(numbers.add(2));
  EXPECT_EQ(numbers.numbers(), (std::vector<std::uint32_t>{2, 0}));
  numbers.clear();
  EXPECT_TRUE(numbers.numbers().empty());
  EXPECT_TRUE(numbers.add(2));
}

} // namespace
} // namespace eigencrust
