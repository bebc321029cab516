// SPDX-License-Identifier: GPL-3.0-or-later
#include "tetrahedra/segment_walk.h"

#include <CGAL/Exact_rational.h>
#include <gmock/gmock.h>

#include "clouds.h"
#include "geometry/predicates.h"

namespace eigencrust {
namespace {

using clouds::Points;
using clouds::Prepared;
using Rational = CGAL::Exact_rational;
using Point = std::array<Rational, 3>;

Point exact(const Vec3& p) { return {Rational(p.x), Rational(p.y), Rational(p.z)}; }

Rational volume(const Point& a, const Point& b, const Point& c, const Point& d) {
  std::array<Point, 3> e;
  for (std::size_t i = 0; i < 3; ++i) e[i] = {b[i] - a[i], c[i] - a[i], d[i] - a[i]};
  return e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1]) - e[0][1] * (e[1][0] * e[2][2] - e[1][2] * e[2][0]) +
         e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0]);
}

/// Does the open segment meet the open tetrahedron? It is clipped by the four sides in rational numbers.
/// \param entry receives where, as a fraction of the segment
bool meets(const Prepared& p, TetrahedronIndex i, const Point& from, const Point& to, Rational& entry) {
  const auto& [a, b, c, d] = p.t.tetrahedra[i];
  const Point pa = exact(p.t.positions[a]), pb = exact(p.t.positions[b]), pc = exact(p.t.positions[c]),
              pd = exact(p.t.positions[d]);
  entry = 0;
  Rational exit = 1;
  const std::array<std::array<const Point*, 3>, 4> sides{
      {{&pa, &pb, &pc}, {&pa, &pc, &pd}, {&pa, &pd, &pb}, {&pb, &pd, &pc}}}; // positive within
  for (const auto& side : sides) {
    const Rational begin = volume(*side[0], *side[1], *side[2], from), end = volume(*side[0], *side[1], *side[2], to);
    if (begin <= 0 && end <= 0) return false;
    if (begin == end) continue;
    const Rational at = begin / (begin - end); // zero of a linear function
    if (end > begin)
      entry = std::max(entry, at);
    else
      exit = std::min(exit, at);
  }
  return entry < exit;
}

/// All tetrahedra met, in the order of the segment, by looking at each of them.
std::vector<TetrahedronIndex> met_by_brute_force(const Prepared& p, SampleIndex from, const Vec3& to) {
  std::vector<std::pair<Rational, TetrahedronIndex>> found;
  const Point begin = exact(p.t.positions[from]), end = exact(to);
  for (std::uint32_t i = 0; i < p.t.tetrahedra.size(); ++i) {
    Rational entry;
    if (meets(p, TetrahedronIndex{i}, begin, end, entry)) found.emplace_back(entry, TetrahedronIndex{i});
  }
  std::sort(found.begin(), found.end());
  std::vector<TetrahedronIndex> met;
  for (const auto& [entry, i] : found) met.push_back(i);
  return met;
}

std::vector<TetrahedronIndex> walked(const Prepared& p, SampleIndex from, const Vec3& to) {
  std::vector<TetrahedronIndex> met;
  SegmentWalk walk(p.t, p.stars, from, to);
  while (walk.next()) met.push_back(walk.tetrahedron());
  return met;
}

SampleIndex sample_at(const Prepared& p, const Vec3& place) {
  for (std::uint32_t i = 0; i < p.t.sample_count; ++i)
    if (p.t.positions.raw()[i] == place) return SampleIndex{i};
  return {};
}

TEST(SegmentWalk, MeetsWhatEveryTetrahedronSaysOfItself) {
  const Prepared p = clouds::prepare(clouds::random_box(60, 1));
  clouds::Random random(2);
  std::size_t longest = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const SampleIndex from{random.below(p.t.sample_count)};
    const Vec3 to = random.in_box(trial % 2 == 0 ? 1.5 : 60); // near, and beyond the cube
    const auto met = walked(p, from, to);
    EXPECT_THAT(met, testing::ElementsAreArray(met_by_brute_force(p, from, to)));
    longest = std::max(longest, met.size());
  }
  EXPECT_GT(longest, 10u);
}

TEST(SegmentWalk, EndsAtSamplesOfACloudWithoutDegeneracy) {
  const Prepared p = clouds::prepare(clouds::random_box(40, 3));
  for (std::uint32_t i = 0; i < 40; i += 3)
    for (std::uint32_t j = 0; j < 40; j += 2) {
      const Vec3 to = p.t.positions.raw()[j]; // a vertex: the segment ends in its star
      EXPECT_THAT(walked(p, SampleIndex{i}, to), testing::ElementsAreArray(met_by_brute_force(p, SampleIndex{i}, to)));
    }
}

// On a lattice segments between integer points run through vertices and edges and within faces. Tetrahedra that
// begin at the same place are all but one only touched, so the order is one, too.
TEST(SegmentWalk, MeetsTheSameOnALattice) {
  const Prepared p = clouds::prepare(clouds::lattice(4, 4, 3));
  clouds::Random random(4);
  std::size_t touching = 0;
  for (int trial = 0; trial < 250; ++trial) {
    const SampleIndex from{random.below(p.t.sample_count)};
    const auto whole = [&] { return static_cast<double>(random.below(13)) / 2 - 3; };
    Vec3 to{whole(), whole(), whole()};
    if (trial % 5 == 0) to = 1000.0 * to;                                                   // beyond the cube
    if (trial % 7 == 0) to = p.t.positions[SampleIndex{random.below(p.t.sample_count)}];    // at a sample
    if (trial % 11 == 0) to = p.t.positions[from] + Vec3{0, 0, trial % 2 == 0 ? 100. : -1}; // along the lattice
    const auto met = walked(p, from, to);
    EXPECT_THAT(met, testing::ElementsAreArray(met_by_brute_force(p, from, to))) << trial;
    touching += met.empty();
  }
  EXPECT_GT(touching, 5u); // whole segments within faces and edges did occur
}

TEST(SegmentWalk, MeetsNothingAlongEdgesAndFaces) {
  const Prepared p = clouds::prepare(clouds::lattice(5, 5, 5));
  const SampleIndex middle = sample_at(p, {0, 0, 0});
  ASSERT_TRUE(middle.valid());
  EXPECT_THAT(walked(p, middle, {2, 0, 0}), testing::IsEmpty()); // every lattice edge is an edge of the Delaunay
  EXPECT_THAT(walked(p, middle, {0, 0, 0}), testing::IsEmpty()); // no way to go
  // On to the cube: beyond the lattice it may run within a tetrahedron or not, but it gets out.
  SegmentWalk walk(p.t, p.stars, middle, {1e3, 0, 0});
  while (walk.next()) EXPECT_GE(walk.depth(), 1.999);
}

TEST(SegmentWalk, ReachesTheCubeFromEverySampleInEveryDirection) {
  const Prepared p = clouds::prepare(clouds::joined(clouds::lattice(6, 6, 2), clouds::random_box(300, 5, 2)));
  clouds::Random random(6);
  for (std::uint32_t i = 0; i < p.t.sample_count; ++i) {
    // Also along the axes and diagonals, where the lattice is met at edges and vertices throughout.
    Vec3 way = random.in_box(1);
    if (i % 2 == 0) way = {static_cast<double>(random.below(3)) - 1, static_cast<double>(random.below(3)) - 1, 1};
    SegmentWalk walk(p.t, p.stars, SampleIndex{i}, p.t.positions[SampleIndex{i}] + 1e4 * way);
    bool at_cube = false;
    double depth = -1e-9;
    while (walk.next()) {
      at_cube = p.t.touches_cube(walk.tetrahedron());
      EXPECT_GE(walk.depth(), depth - 1e-9 * std::fabs(depth));
      depth = walk.depth();
    }
    EXPECT_TRUE(at_cube);
  }
}

TEST(SegmentWalk, DepthIsTheDistanceToTheEntry) {
  const Prepared p = clouds::prepare(clouds::random_box(50, 7));
  const SampleIndex from{11};
  const Vec3 to{3, 4, 5};
  SegmentWalk walk(p.t, p.stars, from, to);
  std::size_t count = 0;
  while (walk.next()) {
    Rational entry;
    ASSERT_TRUE(meets(p, walk.tetrahedron(), exact(p.t.positions[from]), exact(to), entry));
    EXPECT_NEAR(walk.depth(), CGAL::to_double(entry) * distance(p.t.positions[from], to), 1e-9);
    ++count;
  }
  EXPECT_GT(count, 3u);
}

TEST(NormalSign, TakesTheFirstComponentThatIsNotZero) {
  EXPECT_EQ(normal_sign({0, 0, 0}, {1, 1, 0}, {0, 1, 1}), 1);    // normal (1, -1, 1)
  EXPECT_EQ(normal_sign({0, 0, 0}, {0, 1, 1}, {1, 1, 0}), -1);   // turned round
  EXPECT_EQ(normal_sign({5, 5, 5}, {5, 5, 6}, {6, 5, 5}), 1);    // (0, 1, 0)
  EXPECT_EQ(normal_sign({5, 5, 5}, {5, 6, 5}, {6, 5, 5}), -1);   // (0, 0, -1)
  EXPECT_EQ(normal_sign({1, 2, 3}, {2, 4, 6}, {-1, -2, -3}), 0); // collinear
}

} // namespace
} // namespace eigencrust
