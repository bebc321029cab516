// SPDX-License-Identifier: GPL-3.0-or-later
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <eigencrust/error.h>
#include <gmock/gmock.h>

#include <set>

#include "clouds.h"
#include "support.h"

namespace eigencrust {
namespace {

using clouds::Points;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

Tetrahedralization delaunay_of(const Points& points, unsigned threads = 1) {
  const Threads team(threads);
  return tetrahedralize(prepare_samples(points, team), team);
}

std::set<VertexIndex> face(const Tetrahedralization& t, TetrahedronIndex i, std::size_t k) {
  std::set<VertexIndex> vertices(t.tetrahedra[i].begin(), t.tetrahedra[i].end());
  vertices.erase(t.tetrahedra[i][k]);
  return vertices;
}

/// Order within and among tetrahedra, orientation by exact signs, volumes that fill the cube.
void expect_canonical(const Tetrahedralization& t) {
  double sum = 0;
  for (std::uint32_t i = 0; i < t.tetrahedra.size(); ++i) {
    const auto& v = t.tetrahedra.raw()[i];
    ASSERT_LT(v[0], v[1]);
    ASSERT_LT(v[1], v[2]);
    ASSERT_LT(v[1], v[3]);
    if (i > 0) {
      ASSERT_LT(t.tetrahedra.raw()[i - 1], v);
    }
    const auto p = [&](std::size_t k) {
      const Vec3& q = t.positions[v[k]];
      return Kernel::Point_3(q.x, q.y, q.z);
    };
    ASSERT_EQ(CGAL::orientation(p(0), p(1), p(2), p(3)), CGAL::POSITIVE);
    sum += clouds::volume(t, TetrahedronIndex{i});
  }
  const double side = t.positions.raw().back().x - t.positions.raw()[t.sample_count].x;
  EXPECT_NEAR(sum / (side * side * side), 1, 1e-12);
}

/// Neighbours share exactly the face opposite the vertex, and know each other; none beyond the cube.
void expect_neighbours_agree(const Tetrahedralization& t) {
  for (std::uint32_t i = 0; i < t.tetrahedra.size(); ++i)
    for (std::size_t k = 0; k < 4; ++k) {
      const TetrahedronIndex self{i}, n = t.neighbours[self][k];
      const auto shared = face(t, self, k);
      if (!n.valid()) {
        for (const VertexIndex s : shared) ASSERT_TRUE(t.is_corner(s));
        continue;
      }
      const auto& back = t.neighbours[n];
      const auto at = std::find(back.begin(), back.end(), self);
      ASSERT_NE(at, back.end());
      ASSERT_EQ(face(t, n, static_cast<std::size_t>(at - back.begin())), shared);
    }
}

/// No vertex strictly inside any circumsphere, by exact arithmetic.
void expect_empty_spheres(const Tetrahedralization& t) {
  std::vector<Kernel::Point_3> p;
  for (const Vec3& v : t.positions) p.emplace_back(v.x, v.y, v.z);
  for (const auto& [a, b, c, d] : t.tetrahedra)
    for (const auto& q : p)
      ASSERT_NE(CGAL::side_of_bounded_sphere(p[a.value], p[b.value], p[c.value], p[d.value], q), CGAL::ON_BOUNDED_SIDE);
}

void expect_delaunay(const Points& points) {
  const Tetrahedralization t = delaunay_of(points);
  EXPECT_EQ(t.positions.size(), t.sample_count + 8);
  EXPECT_EQ(t.neighbours.size(), t.tetrahedra.size());
  expect_canonical(t);
  expect_neighbours_agree(t);
  expect_empty_spheres(t);
}

TEST(Delaunay, OfRandomPoints) {
  for (const std::uint64_t seed : {1u, 2u, 3u}) expect_delaunay(clouds::random_box(120, seed));
}

TEST(Delaunay, OfAnExactlyCosphericalLattice) { expect_delaunay(clouds::lattice(4, 5, 6)); }

TEST(Delaunay, OfACubesSurface) { expect_delaunay(clouds::cube_surface(5)); }

TEST(Delaunay, OfPointsNearlyOnOneSphere) { expect_delaunay(clouds::sphere(150)); }

TEST(Delaunay, OfTheFewestPoints) {
  expect_delaunay({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}});
  // All but one in a plane.
  expect_delaunay({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0.5, 0.5, 1}});
}

TEST(Delaunay, FarFromTheOriginNothingIsLost) {
  // Steps of 2^-10, about a thousandth, at a million metres: exact in double, as all differences are.
  const Points near = clouds::lattice(4, 4, 4, 0x1p-10);
  const Tetrahedralization far = delaunay_of(clouds::moved(near, {1e6, -1e6, 1e6}));
  const Tetrahedralization reference = delaunay_of(near);
  EXPECT_EQ(far.sample_count, 64u);
  EXPECT_EQ(far.tetrahedra.raw(), reference.tetrahedra.raw());
  EXPECT_EQ(far.positions.raw(), reference.positions.raw());
  // And steps of 1e-3, which are rounded there.
  expect_delaunay(clouds::moved(clouds::lattice(4, 4, 4, 1e-3), {1e6, 1e6, 1e6}));
}

TEST(Delaunay, CubeIsTenDiagonalsWide) {
  const Tetrahedralization t = delaunay_of(clouds::lattice(3, 3, 3));
  for (std::uint32_t i = t.sample_count; i < t.positions.size(); ++i) {
    const Vec3& p = t.positions.raw()[i];
    EXPECT_TRUE(t.is_corner(VertexIndex{i}));
    for (const double c : {p.x, p.y, p.z}) EXPECT_DOUBLE_EQ(std::fabs(c), 10 * std::sqrt(12.0));
  }
}

TEST(Delaunay, DependsNeitherOnRowsNorOnThreads) {
  for (const Points& points : {clouds::random_box(500, 4), clouds::lattice(7, 7, 7), clouds::cube_surface(8)}) {
    const Tetrahedralization reference = delaunay_of(points, 1);
    for (const unsigned threads : {2u, 3u}) {
      const Tetrahedralization t = delaunay_of(clouds::shuffled(points, threads), threads);
      EXPECT_EQ(t.positions.raw(), reference.positions.raw());
      EXPECT_EQ(t.tetrahedra.raw(), reference.tetrahedra.raw());
      EXPECT_EQ(t.neighbours.raw(), reference.neighbours.raw());
    }
  }
}

TEST(Delaunay, FlatInputIsRefused) {
  const auto error = [](const Points& points) { return error_of([&] { delaunay_of(points); }); };
  Points line;
  for (int i = 0; i < 10; ++i) line.push_back({double(i), 2.0 * i, -double(i)});
  EXPECT_THAT(error(line), testing::HasSubstr("collinear"));
  EXPECT_THAT(error(clouds::lattice(5, 5, 1)), testing::HasSubstr("coplanar"));
  // A plane oblique to the axes: x + y + z = 0 with small integers, so that signs are exact.
  Points plane;
  for (int i = 0; i < 5; ++i)
    for (int j = 0; j < 5; ++j) plane.push_back({double(i), double(j), double(-i - j)});
  EXPECT_THAT(error(plane), testing::HasSubstr("coplanar"));
  plane.push_back({0, 0, 0.001});
  EXPECT_EQ(error(plane), "");
}

TEST(VertexStars, HoldEveryTetrahedronOfTheVertexInOrder) {
  const Tetrahedralization t = delaunay_of(clouds::random_box(80, 5));
  const VertexStars stars = vertex_stars(t, Threads(1));
  EXPECT_EQ(stars.tetrahedra.size(), 4u * t.tetrahedra.size());
  for (std::uint32_t s = 0; s < t.positions.size(); ++s) {
    std::vector<TetrahedronIndex> expected;
    for (std::uint32_t i = 0; i < t.tetrahedra.size(); ++i) {
      const auto& v = t.tetrahedra.raw()[i];
      if (std::find(v.begin(), v.end(), VertexIndex{s}) != v.end()) expected.push_back(TetrahedronIndex{i});
    }
    EXPECT_THAT(stars[VertexIndex{s}], testing::ElementsAreArray(expected));
    EXPECT_FALSE(expected.empty());
  }
}

} // namespace
} // namespace eigencrust
