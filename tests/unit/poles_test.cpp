// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>

#include <limits>
#include <set>

#include "clouds.h"
#include "tetrahedra/circumsphere.h"

namespace eigencrust {
namespace {

using clouds::Points;
using clouds::Prepared;

/// Circumcentre as the solution of |x - a|² = |x - b|² = ... by Cramer's rule in long double.
Vec3 centre_of(const Tetrahedralization& t, TetrahedronIndex i) {
  using Real = long double;
  const auto& v = t.tetrahedra[i];
  const Vec3& a = t.positions[v[0]];
  std::array<std::array<Real, 4>, 3> m{};
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3& p = t.positions[v[k + 1]];
    const Real x = Real(p.x) - a.x, y = Real(p.y) - a.y, z = Real(p.z) - a.z;
    m[k] = {x, y, z, (x * x + y * y + z * z) / 2};
  }
  const auto det = [&](std::size_t c0, std::size_t c1, std::size_t c2) {
    return m[0][c0] * (m[1][c1] * m[2][c2] - m[1][c2] * m[2][c1]) -
           m[0][c1] * (m[1][c0] * m[2][c2] - m[1][c2] * m[2][c0]) +
           m[0][c2] * (m[1][c0] * m[2][c1] - m[1][c1] * m[2][c0]);
  };
  const Real d = det(0, 1, 2);
  return {static_cast<double>(a.x + det(3, 1, 2) / d), static_cast<double>(a.y + det(0, 3, 2) / d),
          static_cast<double>(a.z + det(0, 1, 3) / d)};
}

/// Every sample against all circumcentres of its star.
void expect_poles_are_farthest(const Points& points) {
  const Prepared p = clouds::prepare(points);
  ASSERT_EQ(p.poles.of_sample.size(), p.t.sample_count); // none for the corners
  for (std::uint32_t i = 0; i < p.t.sample_count; ++i) {
    const SampleIndex s{i};
    const PolePair pair = p.poles.of_sample[s];
    ASSERT_TRUE(pair.first.valid());
    const Vec3 at = p.t.positions[s];
    const Vec3 first = centre_of(p.t, p.poles.tetrahedron[pair.first]) - at;
    // A cell that leaves the cloud does so in the mean direction of its centres at the cube.
    Vec3 direction = first;
    if (p.t.touches_cube(p.poles.tetrahedron[pair.first])) {
      direction = {};
      for (const TetrahedronIndex t : p.stars[s])
        if (p.t.touches_cube(t)) {
          const Vec3 offset = centre_of(p.t, t) - at;
          direction = direction + (1 / norm(offset)) * offset;
        }
    }
    double farthest = 0, second_farthest = 0;
    for (const TetrahedronIndex t : p.stars[s]) {
      const Vec3 offset = centre_of(p.t, t) - at;
      farthest = std::max(farthest, norm(offset));
      if (dot(offset, direction) < -1e-9 * norm(offset) * norm(direction)) // clearly obtuse
        second_farthest = std::max(second_farthest, norm(offset));
    }
    EXPECT_GE(norm(first), farthest * (1 - 1e-9));
    ASSERT_TRUE(pair.second.valid() || second_farthest == 0);
    if (!pair.second.valid()) continue;
    const Vec3 second = centre_of(p.t, p.poles.tetrahedron[pair.second]) - at;
    EXPECT_GE(norm(second), second_farthest * (1 - 1e-9));
    EXPECT_LT(dot(direction, second), 1e-9 * norm(direction) * norm(second)); // more than 90 degrees
  }
}

TEST(Poles, AreTheFarthestCircumcentresOnEitherSide) {
  for (const std::uint64_t seed : {1u, 2u}) expect_poles_are_farthest(clouds::random_box(100, seed));
  expect_poles_are_farthest(clouds::jittered(clouds::sphere(200), 0.01, 3));
  expect_poles_are_farthest(clouds::lattice(4, 4, 4));
}

TEST(Poles, OfAnOctahedronsCentreAreAcrossFromEachOther) {
  // The centre of a cube's eight corners: its cell is bounded by the eight bisectors, an octahedron with
  // its vertices on the axes; opposite vertices are the poles.
  Points points{{0, 0, 0}};
  for (const double x : {-1.0, 1.0})
    for (const double y : {-1.0, 1.0})
      for (const double z : {-1.0, 1.0}) points.push_back({x, y, z});
  const Prepared p = clouds::prepare(points);
  for (std::uint32_t i = 0; i < p.t.sample_count; ++i) {
    if (p.t.positions.raw()[i] != Vec3{0, 0, 0}) continue;
    const PolePair pair = p.poles.of_sample.raw()[i];
    const Sphere &a = p.poles.sphere[pair.first], &b = p.poles.sphere[pair.second];
    EXPECT_DOUBLE_EQ(a.radius, 1.5);
    EXPECT_NEAR(norm(a.centre + b.centre), 0, 1e-15);
  }
}

TEST(Poles, SpheresPassThroughTheirVertices) {
  const Prepared p = clouds::prepare(clouds::random_box(100, 4));
  std::set<TetrahedronIndex> seen;
  std::uint32_t next = 0;
  for (const PolePair& pair : p.poles.of_sample)
    for (const PoleIndex pole : {pair.first, pair.second}) {
      if (!pole.valid()) continue;
      EXPECT_LE(pole.value, next); // numbered in order of first appearance
      next = std::max(next, pole.value + 1);
    }
  EXPECT_EQ(next, p.poles.tetrahedron.size());
  for (std::uint32_t i = 0; i < p.poles.tetrahedron.size(); ++i) {
    const TetrahedronIndex t = p.poles.tetrahedron.raw()[i];
    EXPECT_TRUE(seen.insert(t).second); // a tetrahedron is one pole however many samples choose it
    for (const VertexIndex s : p.t.tetrahedra[t])
      EXPECT_NEAR(distance(p.t.positions[s], p.poles.sphere.raw()[i].centre) / p.poles.sphere.raw()[i].radius, 1, 1e-6);
  }
}

TEST(Poles, DoNotDependOnThreads) {
  const Points points = clouds::random_box(400, 5);
  const Prepared one = clouds::prepare(points, 1), three = clouds::prepare(points, 3);
  EXPECT_EQ(one.poles.tetrahedron.raw(), three.poles.tetrahedron.raw());
  for (std::uint32_t i = 0; i < one.poles.sphere.size(); ++i) {
    EXPECT_EQ(one.poles.sphere.raw()[i].centre, three.poles.sphere.raw()[i].centre);
    EXPECT_EQ(one.poles.sphere.raw()[i].radius, three.poles.sphere.raw()[i].radius);
  }
}

TEST(Circumcentre, OfTheCornerTetrahedron) {
  EXPECT_EQ(circumcentre({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}), (Vec3{0.5, 0.5, 0.5}));
}

TEST(Circumcentre, OfASliverIsExact) {
  // Four points near a unit circle in z = 0, the last lifted by 2^-40. All numbers are multiples of 2^-40;
  // the centre is on the circle's axis, at z = h/2 for a point lifted straight up off the circle.
  const double h = 0x1p-40;
  const Vec3 centre = circumcentre({1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, h});
  EXPECT_NEAR(centre.x, 0, 1e-12);
  EXPECT_NEAR(centre.y, 0, 1e-12);
  EXPECT_NEAR(centre.z / (h / 2), 1, 1e-12);
  // Also where products of lengths are more or less than double holds.
  for (const double factor : {0x1p-320, 0x1p-250, 0x1p-230, 0x1p+230, 0x1p+320}) {
    const Vec3 scaled = circumcentre({factor, 0, 0}, {0, factor, 0}, {-factor, 0, 0}, {0, -factor, factor * h});
    EXPECT_NEAR(scaled.x / factor, 0, 1e-12) << factor;
    EXPECT_NEAR(scaled.y / factor, 0, 1e-12) << factor;
    EXPECT_NEAR(scaled.z / factor, h / 2, 1e-24) << factor;
  }
}

TEST(Circumsphere, KnowsHowFarItMayBeOff) {
  // Round ones, slivers, and such that are a plane near three of the points.
  clouds::Random random(3);
  double largest = 0;
  for (int k = 0; k < 4000; ++k) {
    std::array<Vec3, 4> p;
    for (Vec3& q : p) q = random.in_box(1);
    if (k % 4 == 1)
      p[3] = p[0] + 0.3 * (p[1] - p[0]) + 0.4 * (p[2] - p[0]) + std::pow(10.0, -k / 400.0) * random.in_box(1);
    if (k % 4 == 2) p[3] = 1e9 * p[3];
    if (k % 4 == 3) p[0] = 1e7 * p[0];
    const Circumsphere sphere = circumsphere(p[0], p[1], p[2], p[3]);
    for (const Vec3& q : p) EXPECT_LE(std::fabs(sphere.power(q).value), sphere.power(q).doubt) << k;
    if (k % 4 != 2) continue;
    // The fourth point is far away: one beside the face is inside or outside by far more than what is not known.
    const Vec3 beside = (1 / 3.0) * (p[0] + p[1] + p[2]) + 1e-12 * p[3];
    const Power power = sphere.power(beside);
    largest = std::max(largest, power.doubt / std::fabs(power.value));
  }
  EXPECT_LT(largest, 1e-3);
}

} // namespace
} // namespace eigencrust
