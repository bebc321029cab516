// SPDX-License-Identifier: GPL-3.0-or-later
#include <eigencrust/error.h>
#include <eigencrust/io.h>
#include <eigencrust/validate.h>
#include <gmock/gmock.h>

#include <limits>
#include <numbers>

#include "shapes.h"
#include "support.h"

namespace eigencrust {
namespace {

using shapes::joined;
using testing::ElementsAre;

MeshSummary unmerged_summary(const TriangleMesh& mesh) { return validate(mesh, {true, false, 1}); }

TEST(Validate, TetrahedronHasTheFiguresOfTheTextbook) {
  const MeshSummary s = validate(shapes::tetrahedron());
  EXPECT_TRUE(s.closed() && s.manifold() && s.oriented());
  EXPECT_EQ(s.vertices, 4u);
  EXPECT_EQ(s.triangles, 4u);
  EXPECT_EQ(s.unreferenced_vertices + s.boundary_loops + s.degenerate_triangles, 0u);
  EXPECT_EQ(s.self_intersections, 0);
  EXPECT_EQ(s.components, 1u);
  EXPECT_EQ(s.euler, 2);
  EXPECT_EQ(s.genus, 0);
  EXPECT_DOUBLE_EQ(s.volume, 1.0 / 6);
  EXPECT_DOUBLE_EQ(s.area, 1.5 + std::sqrt(3.0) / 2);
  EXPECT_EQ(s.bounds.min, (Vec3{0, 0, 0}));
  EXPECT_EQ(s.bounds.max, (Vec3{1, 1, 1}));
}

TEST(Validate, BoxSphereAndTorusMatchTheirFormulas) {
  const MeshSummary b = validate(shapes::box({1, 2, 3}, {2, 4, 6}));
  EXPECT_DOUBLE_EQ(b.volume, 6);
  EXPECT_DOUBLE_EQ(b.area, 22);
  const MeshSummary s = validate(shapes::icosphere(5, 2, {5, 6, 7}));
  EXPECT_NEAR(s.volume, 4.0 / 3 * std::numbers::pi * 8, 0.05);
  EXPECT_NEAR(s.area, 16 * std::numbers::pi, 0.05);
  EXPECT_EQ(s.genus, 0);
  const MeshSummary t = validate(shapes::torus(2, 0.5, 200, 80));
  EXPECT_NEAR(t.volume, 2 * std::pow(std::numbers::pi, 2) * 2 * 0.25, 0.02);
  EXPECT_EQ(t.euler, 0);
  EXPECT_EQ(t.genus, 1);
  EXPECT_EQ(t.self_intersections, 0);
  EXPECT_TRUE(t.closed() && t.manifold() && t.oriented());
}

TEST(Validate, InsideOutHasNegativeVolume) {
  const MeshSummary s = validate(shapes::flipped(shapes::box({0, 0, 0}, {1, 1, 1})));
  EXPECT_DOUBLE_EQ(s.volume, -1);
  EXPECT_TRUE(s.closed() && s.oriented());
}

// At 1e8 units from zero the naive sum of determinants has terms of 1e24 and no digit left.
TEST(Validate, VolumeKeepsItsDigitsFarFromTheOrigin) {
  const TriangleMesh far = shapes::moved(shapes::box({0, 0, 0}, {1, 1, 1}), {1e8, -1e8, 1e8});
  EXPECT_NEAR(validate(far).volume, 1, 1e-12);
}

TEST(Validate, OpenGridHasOneLoop) {
  const MeshSummary s = validate(shapes::grid(3, 2));
  EXPECT_FALSE(s.closed());
  EXPECT_TRUE(s.manifold() && s.oriented());
  EXPECT_EQ(s.boundary_edges, 10u);
  EXPECT_EQ(s.boundary_loops, 1u);
  EXPECT_EQ(s.euler, 1);
  EXPECT_EQ(s.genus, 0);
  EXPECT_EQ(s.self_intersections, 0) << "neighbours in one plane touch along edges only";
}

TEST(Validate, TorusWithTwoHolesKeepsItsGenus) {
  TriangleMesh mesh = shapes::torus(2, 0.5, 20, 10);
  mesh.triangles.erase(mesh.triangles.begin() + 200);
  mesh.triangles.erase(mesh.triangles.begin());
  const MeshSummary s = validate(mesh);
  EXPECT_EQ(s.boundary_loops, 2u);
  EXPECT_EQ(s.boundary_edges, 6u);
  EXPECT_EQ(s.euler, -2);
  EXPECT_EQ(s.genus, 1);
}

TEST(Validate, MoebiusStripIsNotOrientable) {
  const MeshSummary s = validate(shapes::moebius_strip(12));
  EXPECT_EQ(s.boundary_loops, 1u);
  EXPECT_EQ(s.euler, 0);
  EXPECT_EQ(s.genus, -1);
  EXPECT_THAT(s.component_list, ElementsAre(testing::Field(&ComponentSummary::genus, -1)));
  EXPECT_EQ(s.inconsistent_edges, 1u) << "only where the ends are joined";
  EXPECT_TRUE(s.manifold());
}

// Flipping one triangle of a tetrahedron: its three edges run the same way twice; the surface stays orientable.
TEST(Validate, OneFlippedTriangleShowsOnThreeEdges) {
  TriangleMesh mesh = shapes::tetrahedron();
  std::swap(mesh.triangles[2][0], mesh.triangles[2][1]);
  const MeshSummary s = validate(mesh);
  EXPECT_EQ(s.inconsistent_edges, 3u);
  EXPECT_FALSE(s.oriented());
  EXPECT_TRUE(s.closed() && s.manifold());
  EXPECT_EQ(s.genus, 0);
}

TEST(Validate, TwoTetrahedraSharingAnEdge) {
  const MeshSummary s = validate(shapes::two_tetrahedra_sharing_an_edge());
  EXPECT_EQ(s.nonmanifold_edges, 1u);
  EXPECT_EQ(s.nonmanifold_vertices, 2u) << "both ends of the edge have two fans";
  EXPECT_TRUE(s.closed() && s.oriented());
  EXPECT_EQ(s.components, 1u) << "joined along the edge";
  EXPECT_EQ(s.euler, 6 - 11 + 8);
  EXPECT_EQ(s.genus, 0) << "two spheres once cut apart";
  EXPECT_EQ(s.boundary_loops, 0u) << "the cut is not a boundary";
  EXPECT_EQ(s.self_intersections, 0);
  EXPECT_NEAR(s.volume, 2 * 1.0 / 12, 1e-15);
}

TEST(Validate, TwoTetrahedraSharingAVertex) {
  const MeshSummary s = validate(shapes::two_tetrahedra_sharing_a_vertex());
  EXPECT_EQ(s.nonmanifold_edges, 0u);
  EXPECT_EQ(s.nonmanifold_vertices, 1u);
  EXPECT_FALSE(s.manifold());
  EXPECT_EQ(s.components, 2u) << "a vertex does not join";
  EXPECT_EQ(s.vertices, 7u);
  EXPECT_EQ(s.euler, 7 - 12 + 8);
  EXPECT_EQ(s.component_list[0].vertices, 4u);
  EXPECT_EQ(s.component_list[1].vertices, 4u);
  EXPECT_EQ(s.genus, 0);
  EXPECT_TRUE(s.oriented());
  EXPECT_DOUBLE_EQ(s.volume, 1.0 / 3);
}

// Two open triangles that touch in one vertex only: an open fan each.
TEST(Validate, OpenBowTie) {
  const TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {-1, 0, 0}, {-1, -1, 0}}, {{0, 1, 2}, {0, 3, 4}}, {}, {}};
  const MeshSummary s = validate(mesh);
  EXPECT_EQ(s.nonmanifold_vertices, 1u);
  EXPECT_EQ(s.boundary_loops, 2u);
  EXPECT_EQ(s.components, 2u);
  EXPECT_EQ(s.self_intersections, 0);
}

// Three pages on one spine.
TEST(Validate, BookOfThreePages) {
  const TriangleMesh mesh{
      {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {-1, 1, 0}, {-1, -1, 0}}, {{0, 1, 2}, {0, 1, 3}, {1, 0, 4}}, {}, {}};
  const MeshSummary s = validate(mesh);
  EXPECT_EQ(s.nonmanifold_edges, 1u);
  EXPECT_EQ(s.nonmanifold_vertices, 2u);
  EXPECT_EQ(s.boundary_edges, 6u);
  EXPECT_EQ(s.boundary_loops, 3u);
  EXPECT_EQ(s.inconsistent_edges, 1u) << "an odd number cannot run both ways equally often";
  EXPECT_EQ(s.components, 1u);
  EXPECT_EQ(s.genus, 0);
}

TEST(Validate, DuplicateTriangle) {
  TriangleMesh mesh = shapes::tetrahedron();
  mesh.triangles.push_back(mesh.triangles[1]);
  const MeshSummary s = validate(mesh);
  EXPECT_EQ(s.nonmanifold_edges, 3u);
  EXPECT_EQ(s.self_intersections, 1);
  EXPECT_FALSE(s.manifold());

  const TriangleMesh alone{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {1, 2, 0}}, {}, {}};
  const MeshSummary twice = validate(alone);
  EXPECT_EQ(twice.inconsistent_edges, 3u);
  EXPECT_FALSE(twice.oriented());
}

// Collinear with coordinates that a floating-point cross product does not find to be so, and almost
// collinear ones that are not.
TEST(Validate, DegenerateTrianglesAreFoundExactly) {
  const double third = 1.0 / 3;
  const TriangleMesh collinear{
      {{0, 0, 0}, {third, third, third}, {2 * third, 2 * third, 2 * third}}, {{0, 1, 2}}, {}, {}};
  EXPECT_EQ(validate(collinear).degenerate_triangles, 1u);
  TriangleMesh almost = collinear;
  almost.vertices[2].z = std::nextafter(almost.vertices[2].z, 1);
  EXPECT_EQ(validate(almost).degenerate_triangles, 0u);
  const TriangleMesh repeated{{{0, 0, 0}, {1, 0, 0}, {0, 0, 0}}, {{0, 1, 2}}, {}, {}};
  EXPECT_EQ(validate(repeated).degenerate_triangles, 1u);
  EXPECT_EQ(unmerged_summary(repeated).degenerate_triangles, 1u);
}

// A triangle that names a vertex twice has no place among the edges: the tetrahedron stays closed.
TEST(Validate, CollapsedTrianglesTakeNoPartInTopology) {
  TriangleMesh mesh = shapes::tetrahedron();
  mesh.triangles.push_back({0, 0, 1});
  const MeshSummary s = validate(mesh);
  EXPECT_TRUE(s.closed() && s.manifold() && s.oriented());
  EXPECT_EQ(s.triangles, 5u);
  EXPECT_EQ(s.degenerate_triangles, 1u);
  EXPECT_EQ(s.euler, 2);
  const TriangleMesh nothing_else{{{0, 0, 0}, {1, 0, 0}}, {{0, 0, 1}}, {}, {}};
  EXPECT_FALSE(validate(nothing_else).closed());
  EXPECT_EQ(validate(nothing_else).components, 0u);
}

TEST(Validate, MergedAndUnmerged) {
  const TriangleMesh soup = shapes::unmerged(shapes::icosphere(1));
  const MeshSummary merged = validate(soup);
  EXPECT_TRUE(merged.closed() && merged.manifold() && merged.oriented());
  EXPECT_EQ(merged.vertices, 42u);
  EXPECT_EQ(merged.unreferenced_vertices, 0u);
  const MeshSummary apart = unmerged_summary(soup);
  EXPECT_EQ(apart.vertices, 240u);
  EXPECT_EQ(apart.boundary_edges, 240u);
  EXPECT_EQ(apart.boundary_loops, 80u);
  EXPECT_EQ(apart.components, 80u);
  EXPECT_EQ(apart.self_intersections, 0) << "touching along equal edges is no crossing";
  EXPECT_DOUBLE_EQ(apart.volume, merged.volume);
}

TEST(Validate, MergingTakesMinusZeroForZero) {
  TriangleMesh soup = shapes::unmerged(shapes::tetrahedron());
  for (std::size_t v = 0; v < soup.vertices.size(); v += 2)
    if (soup.vertices[v].x == 0) soup.vertices[v].x = -0.0;
  EXPECT_TRUE(validate(soup).closed());
}

TEST(Validate, UnreferencedVerticesAreCountedApart) {
  TriangleMesh mesh = shapes::tetrahedron();
  mesh.vertices.insert(mesh.vertices.begin(), {{9, 9, 9}, {8, 8, 8}, {9, 9, 9}});
  for (auto& t : mesh.triangles)
    for (auto& v : t) v += 3;
  const MeshSummary s = validate(mesh);
  EXPECT_EQ(s.vertices, 4u);
  EXPECT_EQ(s.unreferenced_vertices, 2u) << "the two at (9, 9, 9) are one after merging";
  EXPECT_EQ(unmerged_summary(mesh).unreferenced_vertices, 3u);
  EXPECT_EQ(s.bounds.max, (Vec3{1, 1, 1}));
  EXPECT_EQ(s.euler, 2);
}

TEST(Validate, ComponentsComeLargestFirst) {
  const TriangleMesh mesh =
      joined(joined(shapes::tetrahedron(), shapes::torus(5, 1, 12, 6)), shapes::icosphere(0, 0.2, {10, 0, 0}));
  const MeshSummary s = validate(mesh);
  ASSERT_EQ(s.components, 3u);
  EXPECT_EQ(s.component_list[0].triangles, 144u);
  EXPECT_EQ(s.component_list[0].genus, 1);
  EXPECT_EQ(s.component_list[0].euler, 0);
  EXPECT_EQ(s.component_list[1].triangles, 20u);
  EXPECT_EQ(s.component_list[1].vertices, 12u);
  EXPECT_EQ(s.component_list[2].triangles, 4u);
  EXPECT_EQ(s.genus, 1);
  EXPECT_EQ(s.euler, 4);
}

TEST(Validate, CavityHasTwoComponentsAndTheDifferenceAsVolume) {
  const MeshSummary s = validate(shapes::hollow_sphere(2, 2, 1));
  const double inner = validate(shapes::icosphere(2)).volume;
  EXPECT_NEAR(s.volume, 8 * inner - inner, 1e-12);
  EXPECT_EQ(s.components, 2u);
  EXPECT_EQ(s.self_intersections, 0);
}

TEST(Validate, EmptyMeshIsNotClosed) {
  const MeshSummary s = validate({});
  EXPECT_FALSE(s.closed());
  EXPECT_EQ(s.volume, 0);
  EXPECT_TRUE(s.bounds.empty());
  EXPECT_EQ(s.self_intersections, 0);
}

TEST(Validate, RefusesWhatIsNoMesh) {
  TriangleMesh index = shapes::tetrahedron();
  index.triangles[3][1] = 4;
  EXPECT_THAT([&] { validate(index); }, testing::Throws<Error>(testing::Property(
                                            &Error::cause, testing::HasSubstr("triangle 3 names vertex 4"))));
  EXPECT_THROW(merge_equal_vertices(index), Error);
  EXPECT_THROW(triangle_components(index), Error);
  TriangleMesh nan = shapes::tetrahedron();
  nan.vertices[2].y = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT([&] { validate(nan); },
              testing::Throws<Error>(testing::Property(&Error::kind, testing::Eq(ErrorKind::input))));
}

TEST(Validate, SameForAnyNumberOfThreads) {
  const TriangleMesh mesh = joined(shapes::icosphere(6), shapes::icosphere(5, 1, {0.5, 0, 0}));
  const MeshSummary one = validate(mesh, {true, true, 1}), three = validate(mesh, {true, true, 3});
  EXPECT_EQ(one.volume, three.volume);
  EXPECT_EQ(one.area, three.area);
  EXPECT_GT(one.self_intersections, 100);
  EXPECT_EQ(one.self_intersections, three.self_intersections);
}

TEST(MergeEqualVertices, KeepsTheFirstWithItsAttributes) {
  TriangleMesh mesh{{{1, 0, 0}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 3}, {2, 3, 1}, {0, 2, 3}}, {}, {}};
  const double values[] = {10, 11, 12, 13};
  mesh.vertex_attributes.push_back(make_attribute("intensity", ScalarType::float32, values));
  const double per_triangle[] = {1, 2, 3};
  mesh.triangle_attributes.push_back(make_attribute("support", ScalarType::float32, per_triangle));
  const TriangleMesh merged = merge_equal_vertices(mesh);
  EXPECT_THAT(merged.vertices, ElementsAre(Vec3{1, 0, 0}, Vec3{0, 0, 0}, Vec3{0, 1, 0}));
  EXPECT_THAT(merged.triangles, ElementsAre(ElementsAre(0, 1, 2), ElementsAre(0, 2, 1), ElementsAre(0, 0, 2)));
  ASSERT_EQ(merged.vertex_attributes.size(), 1u);
  EXPECT_EQ(merged.vertex_attributes[0].rows(), 3u);
  EXPECT_EQ(attribute_value(merged.vertex_attributes[0], 2), 13);
  EXPECT_EQ(merged.triangle_attributes[0].rows(), 3u);
}

TEST(MergeEqualVertices, NanEqualsNothing) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const TriangleMesh mesh{{{nan, 0, 0}, {1, 0, 0}, {nan, 0, 0}, {1, 0, 0}}, {}, {}, {}};
  EXPECT_EQ(merge_equal_vertices(mesh).vertices.size(), 3u);
}

TEST(TriangleComponents, NumberedByFirstTriangle) {
  // Triangles 0 and 2 share the edge 0-2; triangle 1 touches them in vertex 0 only.
  const TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {-1, -1, 0}, {-2, 2, 0}},
                          {{0, 1, 2}, {0, 3, 4}, {0, 2, 5}},
                          {},
                          {}};
  EXPECT_THAT(triangle_components(mesh), ElementsAre(0, 1, 0));
}

TEST(ValidateFiles, ScannedBunnyMeshIsClosedOnceMerged) {
  const auto path = data_path("scan_the_bunny/bunny1.obj");
  EIGENCRUST_NEED_DATA(path);
  const TriangleMesh mesh = read_mesh(path);
  const MeshSummary apart = validate(mesh, {false, false, 0});
  EXPECT_EQ(apart.boundary_edges, 612u);
  const MeshSummary merged = validate(mesh);
  EXPECT_TRUE(merged.closed() && merged.oriented());
  EXPECT_EQ(merged.components, 2u);
  EXPECT_LT(merged.vertices, apart.vertices);
}

TEST(ValidateFiles, KnownGenus) {
  for (const auto& [name, genus] : {std::pair{"meshes/armadillo.obj", 0},
                                    {"meshes/angel.obj", 1},
                                    {"meshes/horse.ply", 0},
                                    {"reconbench/anchor.off", 4},
                                    {"reconbench/lordquas.off", 0}}) {
    const auto path = data_path(name);
    EIGENCRUST_NEED_DATA(path);
    const MeshSummary s = validate(read_mesh(path), {false, true, 0});
    EXPECT_TRUE(s.closed() && s.manifold() && s.oriented()) << name;
    EXPECT_EQ(s.genus, genus) << name;
    EXPECT_EQ(s.volume < 0, std::string(name) == "meshes/horse.ply") << "the horse is stored inside out";
  }
}

TEST(ValidateFiles, ZipperedBunnyHasFiveHoles) {
  const auto path = data_path("bunny/bun_zipper.ply");
  EIGENCRUST_NEED_DATA(path);
  const MeshSummary s = validate(read_mesh(path), {false, true, 0});
  EXPECT_EQ(s.vertices, 35947u - 1113u);
  EXPECT_EQ(s.unreferenced_vertices, 1113u);
  EXPECT_EQ(s.boundary_loops, 5u);
  EXPECT_EQ(s.genus, 0);
}

} // namespace
} // namespace eigencrust
