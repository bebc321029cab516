// SPDX-License-Identifier: GPL-3.0-or-later
#include "tetrahedra/incremental_delaunay.h"

#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <set>

#include <eigencrust/error.h>

#include "clouds.h"
#include "support.h"
#include "tetrahedra/sphere_side.h"

namespace eigencrust {
namespace {

using clouds::Points;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Four = std::array<std::uint32_t, 4>;

Points with_cube(Points points) {
  Box3 box;
  for (const Vec3& p : points) box.add(p);
  const Vec3 middle = box.centre();
  const double h = 10 * box.diagonal();
  for (const double x : {-h, h})
    for (const double y : {-h, h})
      for (const double z : {-h, h}) points.push_back(middle + Vec3{x, y, z});
  return points;
}

/// Those of CGAL's triangulation, each in order.
std::set<Four> expected(const Points& enclosed) {
  using Base = CGAL::Triangulation_vertex_base_with_info_3<std::uint32_t, Kernel>;
  using Structure = CGAL::Triangulation_data_structure_3<Base, CGAL::Delaunay_triangulation_cell_base_3<Kernel>>;
  CGAL::Delaunay_triangulation_3<Kernel, Structure> delaunay;
  for (std::uint32_t i = 0; i < enclosed.size(); ++i)
    delaunay.insert(Kernel::Point_3(enclosed[i].x, enclosed[i].y, enclosed[i].z))->info() = i;
  std::set<Four> result;
  for (auto c = delaunay.finite_cells_begin(); c != delaunay.finite_cells_end(); ++c) {
    Four v{c->vertex(0)->info(), c->vertex(1)->info(), c->vertex(2)->info(), c->vertex(3)->info()};
    std::sort(v.begin(), v.end());
    result.insert(v);
  }
  return result;
}

std::set<Four> found(const IncrementalDelaunay& delaunay) {
  std::set<Four> result;
  for (std::uint32_t t = 0; t < delaunay.tetrahedra().size(); ++t) {
    if (!delaunay.exists(t)) continue;
    Four v = delaunay.tetrahedra()[t].vertices;
    std::sort(v.begin(), v.end());
    result.insert(v);
  }
  EXPECT_EQ(result.size(), delaunay.count());
  return result;
}

/// Positively oriented; neighbours know each other and share the face.
void expect_sound(const IncrementalDelaunay& delaunay) {
  const auto& all = delaunay.tetrahedra();
  for (std::uint32_t t = 0; t < all.size(); ++t) {
    if (!delaunay.exists(t)) continue;
    const auto& v = all[t].vertices;
    const auto p = [&](std::size_t k) -> const Vec3& { return delaunay.position(v[k]); };
    ASSERT_EQ(orientation(p(0), p(1), p(2), p(3)), 1);
    for (std::uint32_t k = 0; k < 4; ++k) {
      const std::uint32_t across = all[t].across[k];
      if (across == no_index) continue;
      const auto& other = all[IncrementalDelaunay::tetrahedron_of(across)];
      const std::uint32_t back = IncrementalDelaunay::place_of(across);
      ASSERT_NE(other.vertices[0], no_index);
      ASSERT_EQ(other.across[back], IncrementalDelaunay::corner(t, k));
      std::set<std::uint32_t> here(v.begin(), v.end()), there(other.vertices.begin(), other.vertices.end());
      here.erase(v[k]);
      there.erase(other.vertices[back]);
      ASSERT_EQ(here, there);
    }
  }
}

IncrementalDelaunay inserted(const Points& points, std::uint64_t order_seed) {
  IncrementalDelaunay delaunay(with_cube(points));
  std::vector<std::uint32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0u);
  std::shuffle(order.begin(), order.end(), std::mt19937_64(order_seed));
  std::uint32_t near = 0;
  for (const std::uint32_t i : order) near = delaunay.insert(i, near);
  return delaunay;
}

void expect_those_of_cgal(const Points& points) {
  const std::set<Four> right = expected(with_cube(points));
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const IncrementalDelaunay delaunay = inserted(points, seed);
    EXPECT_EQ(found(delaunay), right) << "order " << seed;
    expect_sound(delaunay);
  }
}

TEST(IncrementalDelaunay, OfPointsInABox) { expect_those_of_cgal(clouds::random_box(2000, 7)); }

TEST(IncrementalDelaunay, OfTheCubeAlone) {
  const Points corners = with_cube({{0, 0, 0}, {1, 1, 1}});
  const Points cube(corners.end() - 8, corners.end());
  EXPECT_EQ(found(IncrementalDelaunay(cube)), expected(cube));
}

TEST(IncrementalDelaunay, DecidesAmongCosphericalPointsByTheirCoordinates) {
  expect_those_of_cgal(clouds::lattice(7, 8, 9));
  expect_those_of_cgal(clouds::cube_surface(9));
  expect_those_of_cgal(clouds::lattice(12, 12, 1)); // and in a plane
}

TEST(IncrementalDelaunay, OfPointsNearlyOnOneSphere) {
  // The point in the middle makes a hole with as many vertices as there are points.
  expect_those_of_cgal(clouds::joined(clouds::sphere(700), {{0, 0, 0}}));
}

TEST(IncrementalDelaunay, OfPointsNearlyOnAGrid) {
  Points points = clouds::lattice(6, 6, 6);
  for (std::size_t i = 0; i < points.size(); i += 3) points[i].x = std::nextafter(points[i].x, 10.0);
  for (std::size_t i = 1; i < points.size(); i += 5) points[i].z = std::nextafter(points[i].z, -10.0);
  expect_those_of_cgal(points);
}

TEST(IncrementalDelaunay, OfTheSmallestAndLargestCoordinates) {
  for (const double factor : {0x1p-209, 0x1p-60, 0x1p+60, 0x1p+180})
    expect_those_of_cgal(clouds::moved(clouds::random_box(150, 3), {}, factor));
}

TEST(IncrementalDelaunay, TakesPointsThatAreAddedLater) {
  const Points points = clouds::random_box(300, 11);
  IncrementalDelaunay delaunay(with_cube(points));
  for (std::uint32_t i = 0; i < points.size(); ++i) delaunay.insert(i, delaunay.at(i == 0 ? 300 : i - 1));
  Points all = with_cube(points);
  for (const Vec3& p : clouds::random_box(50, 12)) {
    const std::uint32_t vertex = delaunay.add(p);
    EXPECT_EQ(vertex, all.size());
    delaunay.insert(vertex, delaunay.at(0));
    all.push_back(p);
  }
  EXPECT_EQ(found(delaunay), expected(all));
}

TEST(IncrementalDelaunay, KnowsTheTetrahedraAroundAVertex) {
  IncrementalDelaunay delaunay = inserted(clouds::lattice(4, 4, 4), 5);
  for (const std::uint32_t vertex : {0u, 21u, 64u}) { // a corner of the grid, one within, a corner of the cube
    std::set<std::uint32_t> right;
    for (std::uint32_t t = 0; t < delaunay.tetrahedra().size(); ++t) {
      const auto& v = delaunay.tetrahedra()[t].vertices;
      if (delaunay.exists(t) && std::find(v.begin(), v.end(), vertex) != v.end()) right.insert(t);
    }
    const auto around = delaunay.around(vertex);
    EXPECT_EQ(std::set<std::uint32_t>(around.begin(), around.end()), right);
    EXPECT_EQ(around.size(), right.size());
    EXPECT_TRUE(right.contains(delaunay.at(vertex)));
  }
}

TEST(IncrementalDelaunay, RefusesAPlaceThatIsTaken) {
  IncrementalDelaunay delaunay = inserted(clouds::random_box(20, 1), 1);
  const std::uint32_t again = delaunay.add(delaunay.position(7));
  EXPECT_THAT(error_of([&] { delaunay.insert(again, 0); }), testing::HasSubstr("two samples are at the same place"));
}

TEST(SphereSide, IsExactForPointsNearlyOnASphere) {
  std::mt19937_64 random(17);
  std::normal_distribution<double> normal;
  const auto on_sphere = [&] {
    const Vec3 direction{normal(random), normal(random), normal(random)};
    return Vec3{0.3, -0.7, 1.1} + (2.3 / norm(direction)) * direction;
  };
  int inside = 0, on = 0;
  for (int round = 0; round < 20000; ++round) {
    const double factor = round % 2 == 0 ? 1 : 0x1p-209; // products of five lengths lose digits then
    std::array<Vec3, 4> p{on_sphere(), on_sphere(), on_sphere(), on_sphere()};
    if (orientation(p[0], p[1], p[2], p[3]) < 0) std::swap(p[0], p[1]);
    const Vec3 query = factor * on_sphere();
    for (Vec3& corner : p) corner = factor * corner;
    const int side = side_of_sphere(p[0], p[1], p[2], p[3], query);
    (side > 0 ? inside : on) += side >= 0 ? 1 : 0;
    if (side != 0) {
      ASSERT_EQ(is_inside_sphere({&p[0], &p[1], &p[2], &p[3]}, query), side > 0) << "round " << round;
    }
  }
  EXPECT_GT(inside, 5000);
  EXPECT_LT(on, 5000);
}

TEST(SphereSide, IsNoGuessForPointsNearlyInAPlane) {
  std::mt19937_64 random(18);
  std::uniform_real_distribution<double> coordinate(-1, 1);
  const auto anywhere = [&] { return Vec3{coordinate(random), coordinate(random), coordinate(random)}; };
  int known = 0;
  for (int round = 0; round < 20000; ++round) {
    const std::array<Vec3, 4> p{anywhere(), anywhere(), anywhere(), anywhere()};
    const double away = std::ldexp(1.0, -40 - round % 20); // from the plane of the first three
    const Vec3 eye = p[0] + coordinate(random) * (p[1] - p[0]) + coordinate(random) * (p[2] - p[0]) + away * p[3];
    const SeenFrom<4> seen(eye, {&p[0], &p[1], &p[2], &p[3]});
    const int sign = sign_in_double(seen, 0, 1, 2, seen.largest_product());
    if (sign == 0) continue;
    ++known;
    ASSERT_EQ(sign, orientation(eye, p[0], p[1], p[2])) << "round " << round;
  }
  EXPECT_GT(known, 5000);
  EXPECT_LT(known, 15000);
}

/// Around a sphere, from far away to a last digit.
TEST(SphereSide, IsExact) {
  const std::array<Vec3, 4> tetrahedron{Vec3{3, 4, 0}, {4, 0, 3}, {0, 3, 4}, {-3, -4, 0}};
  ASSERT_EQ(orientation(tetrahedron[0], tetrahedron[1], tetrahedron[2], tetrahedron[3]), 1);
  const std::array<const Vec3*, 4> corners{&tetrahedron[0], &tetrahedron[1], &tetrahedron[2], &tetrahedron[3]};
  for (const Vec3& on : {Vec3{0, 0, 5}, {0, -4, -3}, {-4, 3, 0}, {0, -5, 0}, {-5, 0, 0}})
    for (double by = 1; by > 1e-17; by /= 8) {
      const Vec3 inside = (1 - by / 2) * on, outside = (1 + by) * on;
      EXPECT_EQ(is_inside_sphere(corners, inside), inside != on || is_inside_when_moved(corners, on)) << by;
      EXPECT_EQ(is_inside_sphere(corners, outside), outside == on && is_inside_when_moved(corners, on)) << by;
    }
}

} // namespace
} // namespace eigencrust
