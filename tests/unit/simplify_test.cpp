// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/simplify.h"

#include <eigencrust/eigencrust.h>
#include <eigencrust/error.h>
#include <eigencrust/validate.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "shapes.h"
#include "simplify/collapse_again.h"
#include "simplify/edge_queue.h"
#include "simplify/remesh.h"

namespace eigencrust {
namespace {

constexpr double any = std::numeric_limits<double>::infinity();
constexpr double spacing = 1e-6; // no rounding to speak of

OtherTriangles simplified(const TriangleMesh& mesh, std::size_t triangles, double max_error = any,
                          unsigned threads = 2) {
  return simplify(mesh, FullSurface(mesh, Threads(threads)), {triangles, max_error}, spacing, Threads(threads));
}

/// Closed, manifold, without crossings, and the pieces, rims and genus of before.
void expect_the_same_surface(const TriangleMesh& made, const TriangleMesh& before) {
  const MeshSummary now = validate(made), then = validate(before);
  EXPECT_TRUE(now.manifold() && now.oriented());
  EXPECT_EQ(now.closed(), then.closed());
  EXPECT_EQ(now.components, then.components);
  EXPECT_EQ(now.genus, then.genus);
  EXPECT_EQ(now.boundary_loops, then.boundary_loops);
  EXPECT_EQ(now.self_intersections, 0);
  EXPECT_EQ(now.degenerate_triangles, 0);
  EXPECT_EQ(now.unreferenced_vertices, 0u);
  if (then.closed()) {
    EXPECT_EQ(now.volume > 0, then.volume > 0);
  }
}

/// A sheet with a gap to its other side, both of them bent alike: the sides of a wall.
TriangleMesh wall(double gap) {
  constexpr unsigned n = 40;
  const TriangleMesh side = shapes::grid(n, n);
  const auto bent = [&](double z) {
    TriangleMesh mesh = side;
    for (Vec3& p : mesh.vertices) p.z = z + 2 * std::sin(0.4 * p.x) + 0.15 * std::sin(3 * p.y + 2 * p.x);
    return mesh;
  };
  return shapes::joined(shapes::flipped(bent(0)), bent(gap));
}

TEST(Simplify, KeepsWhatTheMeshIs) {
  const TriangleMesh two = shapes::joined(shapes::icosphere(4), shapes::moved(shapes::icosphere(3), {3, 0, 0}));
  for (const TriangleMesh& mesh : {shapes::icosphere(5), shapes::torus(3, 1, 60, 40), two,
                                   shapes::hollow_sphere(4, 1, 0.8), shapes::grid(30, 30), shapes::tetrahedron()})
    for (const std::size_t triangles : {1000u, 100u, 1u}) {
      const OtherTriangles made = simplified(mesh, triangles);
      SCOPED_TRACE(std::to_string(mesh.triangles.size()) + " to " + std::to_string(triangles));
      expect_the_same_surface(made.mesh, mesh);
      EXPECT_EQ(made.crossing, 0u);
      if (mesh.triangles.size() >= 1000 && triangles > 1) {
        EXPECT_LE(made.mesh.triangles.size(), triangles);
        EXPECT_GE(made.mesh.triangles.size() + 2, triangles);
      }
    }
  EXPECT_EQ(simplified(two, 1).mesh.triangles.size(), 8u) << "a piece takes four at least";
}

TEST(Simplify, MoreTrianglesThanThereAreChangeNothing) {
  const TriangleMesh mesh = shapes::icosphere(3);
  const OtherTriangles made = simplified(mesh, 5000);
  EXPECT_EQ(made.mesh.vertices, mesh.vertices);
  EXPECT_EQ(made.mesh.triangles, mesh.triangles);
  EXPECT_LT(made.deviation.max(), 1e-12);
}

TEST(Simplify, FlatPartsAndStraightEdgesCostNothing) {
  // A box of squares: eight corners and twelve triangles are enough.
  const TriangleMesh mesh = remesh(shapes::box({0, 0, 0}, {2, 1, 1}),
                                   FullSurface(shapes::box({0, 0, 0}, {2, 1, 1}), Threads(1)), 0.1, spacing, Threads(1))
                                .mesh;
  ASSERT_GT(mesh.triangles.size(), 1000u);
  const OtherTriangles made = simplified(mesh, 12);
  EXPECT_EQ(made.mesh.triangles.size(), 12u);
  EXPECT_LT(made.deviation.max(), 1e-4);
  EXPECT_NEAR(validate(made.mesh).volume, 2, 1e-4);
}

TEST(Simplify, ThinWallsDoNotCross) {
  const TriangleMesh mesh = wall(0.02);
  ASSERT_EQ(validate(mesh).self_intersections, 0);
  for (const std::size_t triangles : {2000u, 400u, 100u}) {
    const OtherTriangles made = simplified(mesh, triangles);
    expect_the_same_surface(made.mesh, mesh);
    EXPECT_EQ(made.crossing, 0u);
  }
  EXPECT_GT(simplified(mesh, 400).held, 0u) << "nothing would have crossed: this tests nothing";
}

TEST(Simplify, StaysWithinTheLargestError) {
  const TriangleMesh sphere = shapes::icosphere(5);
  for (const TriangleMesh& mesh : {sphere, shapes::torus(3, 1, 60, 40), wall(0.1)}) {
    std::size_t fewer = mesh.triangles.size();
    for (const double most : {0.003, 0.03}) {
      const OtherTriangles made = simplified(mesh, 0, most);
      expect_the_same_surface(made.mesh, mesh);
      EXPECT_LE(made.deviation.max(), most);
      EXPECT_LE(made.mesh.triangles.size(), fewer);
      fewer = made.mesh.triangles.size();
      const DeviationReport measured = FullSurface(mesh, Threads(1)).measure(made.mesh, Threads(1));
      EXPECT_EQ(measured.max(), made.deviation.max());
    }
  }
  // A sphere between its facets, half the error either side: 8 pi r / (sqrt(3) error) triangles were the fewest.
  EXPECT_LT(simplified(sphere, 0, 0.03).mesh.triangles.size(), 500u);
}

TEST(Simplify, RimsStayWhereTheyAre) {
  const TriangleMesh mesh = shapes::grid(40, 40);
  const OtherTriangles made = simplified(mesh, 10);
  const MeshSummary now = validate(made.mesh);
  EXPECT_EQ(now.boundary_loops, 1u);
  EXPECT_NEAR(now.area, validate(mesh).area, 0.1);
}

TEST(Simplify, IsTheSameForAnyNumberOfThreads) {
  const TriangleMesh mesh = shapes::icosphere(6); // of several parts
  const OtherTriangles one = simplified(mesh, 2000, any, 1), three = simplified(mesh, 2000, any, 3);
  EXPECT_EQ(one.mesh.vertices, three.mesh.vertices);
  EXPECT_EQ(one.mesh.triangles, three.mesh.triangles);
  EXPECT_EQ(one.deviation.max(), three.deviation.max());
  EXPECT_EQ(one.deviation.to_full.mean, three.deviation.to_full.mean);
}

TEST(Simplify, IsDoneAgainInSomePlacesOnly) {
  const Threads threads(2);
  for (const TriangleMesh& mesh : {shapes::icosphere(4), shapes::torus(3, 1, 60, 40), shapes::grid(40, 40)}) {
    Collapsed before{mesh, vertex_quadrics(mesh, threads), {}};
    const std::vector<float> limits(mesh.vertices.size(), std::numeric_limits<float>::infinity());
    const std::size_t triangles = mesh.triangles.size() / 10;
    const Collapsed after = collapse_edges(mesh, before.quadrics, limits, {}, {triangles, any});
    ASSERT_TRUE(after.is_manifold);
    std::vector<std::uint8_t> apart(after.mesh.vertices.size(), 0);
    for (const std::uint32_t v : after.mesh.triangles[7]) apart[v] = 1;
    std::vector<float> lower = limits; // of what one of them was made from
    for (std::size_t v = 0; v < lower.size(); ++v)
      if (after.into[v] == after.mesh.triangles[7][0]) lower[v] = -1;
    const auto again = collapse_again(before, after, lower, apart, {triangles, any}, threads);
    ASSERT_TRUE(again);
    expect_the_same_surface(again->mesh, mesh);
    EXPECT_LE(again->mesh.triangles.size(), triangles);
    EXPECT_GE(again->mesh.triangles.size() + 2, triangles);
    std::size_t kept = 0;
    for (std::size_t v = 0; v < lower.size(); ++v) {
      if (lower[v] < 0) {
        EXPECT_EQ(again->mesh.vertices[again->into[v]], mesh.vertices[v]) << "it may not go";
      }
      kept += again->mesh.vertices[again->into[v]] == after.mesh.vertices[after.into[v]] ? 1 : 0;
    }
    EXPECT_GT(kept, lower.size() / 2) << "the rest stays";
  }
}

TEST(Simplify, TheQueueGivesTheCheapestEdgeFirst) {
  EdgeQueue queue;
  std::vector<std::pair<double, std::uint32_t>> expected;
  for (std::uint32_t e = 0; e < 1000; ++e) expected.emplace_back(std::ldexp(e * 7919 % 1000, -900), e);
  for (const auto& [cost, edge] : expected)
    if (edge < 600) queue.append(cost, edge);
  queue.make();
  for (const auto& [cost, edge] : expected)
    if (edge >= 600) queue.push(cost, edge);
  std::sort(expected.begin(), expected.end());
  EXPECT_EQ(queue.top(), expected[0].second);
  queue.change_top(1); // dearer than all
  for (std::size_t i = 1; i < expected.size(); ++i, queue.pop()) ASSERT_EQ(queue.top(), expected[i].second);
  EXPECT_EQ(queue.top(), expected[0].second);
  queue.pop();
  EXPECT_TRUE(queue.empty());
}

TEST(Remesh, MakesEdgesAsLongAsAskedForAndKeepsCreases) {
  const TriangleMesh box = shapes::box({0, 0, 0}, {2, 1, 1});
  const OtherTriangles made = remesh(box, FullSurface(box, Threads(1)), 0.1, spacing, Threads(1));
  expect_the_same_surface(made.mesh, box);
  EXPECT_NEAR(validate(made.mesh).volume, 2, 1e-9);
  EXPECT_LT(made.deviation.max(), 1e-9);
  const ShapeReport shape = shape_of(made.mesh, 0.1, Threads(1));
  EXPECT_GT(shape.least_angle, 15);
  EXPECT_GE(shape.low_angle, shape.least_angle);
  std::uint64_t all = 0, near = 0;
  for (std::size_t i = 0; i < shape.edges.size(); ++i) {
    all += shape.edges[i];
    if (i >= 2 && i < 6) near += shape.edges[i]; // from half to one and a half times as long
  }
  EXPECT_EQ(all, 3 * made.mesh.triangles.size() / 2);
  EXPECT_GT(static_cast<double>(near), 0.95 * static_cast<double>(all));
}

TEST(Remesh, OfFineCoarseAndOpenMeshes) {
  for (const TriangleMesh& mesh : {shapes::icosphere(4), shapes::torus(3, 1, 60, 40), wall(0.2), shapes::tetrahedron()})
    for (const double edge : {0.3, 1.0, 10.0}) {
      const OtherTriangles made = remesh(mesh, FullSurface(mesh, Threads(1)), edge, spacing, Threads(1));
      SCOPED_TRACE(std::to_string(mesh.triangles.size()) + " by " + std::to_string(edge));
      expect_the_same_surface(made.mesh, mesh);
    }
}

TEST(Remesh, OfTrianglesWithHardlyAnArea) {
  // Nine points in a plane but for rounding, and one so far away that all coordinates are small beside it: around some
  // vertices no triangle's area can be told from nothing.
  PointCloud cloud;
  cloud.points = {{0.83212228190244986, 0.44673495293794285, -9.861690277720096e-15},
                  {0.19593186467208801, 0.025316359423554813, -4.4334882756055889e-16},
                  {0.97420414184642934, 0.33924390222479495, 1.6315749725682338e-15},
                  {0.016960901758620306, 0.20866048287213457, -6.5541669856762797e-15},
                  {0.87129889247080206, 0.5641241415855861, -5.1376483231990302e-15},
                  {0.68367530987336389, 0.015965197109763518, -2.0724941015072828e-14},
                  {0.48330849863659875, 0.086224109963981999, -3.6910881269971159e-15},
                  {0.23718262674097268, 0.96764049756029435, -2.2180860875671668e-15},
                  {0.92530773240259434, 0.47741294858479721, 7.3107069602113435e-15},
                  {2.2741094687751626e+28, -5.9044004039336447e+28, -3.4578995759911034e+28}};
  Options options;
  options.edge = {SurfaceLength::Kind::percent, 8.336769};
  const Result result = reconstruct(cloud, options);
  EXPECT_TRUE(result.report.broken_guarantees.empty());
}

TEST(Remesh, RefusesEdgesThatMakeFarTooManyTriangles) {
  const TriangleMesh mesh = shapes::icosphere(2);
  EXPECT_THROW(remesh(mesh, FullSurface(mesh, Threads(1)), 1e-6, spacing, Threads(1)), Error);
}

TEST(Simplify, VerticesTakeWhatIsSaidOfTheNearestOnes) {
  const TriangleMesh sphere = shapes::icosphere(4);
  PointCloud cloud;
  cloud.points = sphere.vertices;
  std::vector<float> height;
  for (const Vec3& p : cloud.points) height.push_back(static_cast<float>(p.z));
  cloud.attributes.push_back(make_attribute("height", height));
  Options options;
  options.triangles = 400;
  const Result result = reconstruct(cloud, options);
  ASSERT_TRUE(result.report.simplified);
  EXPECT_EQ(result.report.simplified->triangles, 400u);
  EXPECT_EQ(result.report.simplified->triangles_before, sphere.triangles.size());
  EXPECT_TRUE(result.report.broken_guarantees.empty());
  const Attribute *values = find_attribute(result.mesh.vertex_attributes, "height"),
                  *source = find_attribute(result.mesh.vertex_attributes, "source_index"),
                  *support = find_attribute(result.mesh.triangle_attributes, "support");
  ASSERT_TRUE(values && source && support);
  ASSERT_EQ(values->rows(), result.mesh.vertices.size());
  EXPECT_EQ(support->rows(), result.mesh.triangles.size());
  for (std::size_t v = 0; v < values->rows(); ++v) {
    EXPECT_NEAR(attribute_value(*values, v), result.mesh.vertices[v].z, 0.1);
    EXPECT_EQ(attribute_value(*values, v), height[static_cast<std::size_t>(attribute_value(*source, v))]);
  }
}

TEST(Simplify, ALengthInNoiseWhereThereIsNoneIsTold) {
  PointCloud cloud;
  cloud.points = shapes::icosphere(3).vertices;
  Options options;
  options.noise.kind = LengthChoice::Kind::off;
  options.max_error = {SurfaceLength::Kind::sigma, 1};
  const Result result = reconstruct(cloud, options);
  EXPECT_FALSE(result.report.simplified);
  ASSERT_EQ(result.report.warnings.size(), 1u);
  EXPECT_NE(result.report.warnings[0].find("no noise was measured"), std::string::npos);
}

} // namespace
} // namespace eigencrust
