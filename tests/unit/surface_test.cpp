// SPDX-License-Identifier: GPL-3.0-or-later
#include <eigencrust/validate.h>
#include <gmock/gmock.h>

#include "clouds.h"

namespace eigencrust {
namespace {

using clouds::Prepared;

MeshSummary summary_of(const TriangleMesh& mesh) {
  return validate(mesh, {.self_intersections = false, .merge_equal_vertices = false});
}

TEST(Surface, OfOneTetrahedronIsItsFourFaces) {
  const Prepared p = clouds::prepare(clouds::random_box(30, 1));
  TetrahedronIndex one{0};
  while (p.t.touches_cube(one)) ++one.value;
  Labels labels(p.t.tetrahedra.size(), Label::outside);
  labels[one] = Label::inside;
  const Surface surface = extract_surface(p.t, labels, Threads(2));
  EXPECT_EQ(surface.mesh.triangles.size(), 4u);
  std::vector<VertexIndex> vertices(p.t.tetrahedra[one].begin(), p.t.tetrahedra[one].end());
  std::sort(vertices.begin(), vertices.end());
  EXPECT_THAT(surface.sample_of, testing::ElementsAreArray(vertices));
  for (std::size_t v = 0; v < 4; ++v) EXPECT_EQ(surface.mesh.vertices[v], p.t.positions[surface.sample_of[v]]);
  const MeshSummary summary = summary_of(surface.mesh);
  EXPECT_TRUE(summary.closed() && summary.manifold() && summary.oriented());
  EXPECT_NEAR(summary.volume, clouds::volume(p.t, one), 1e-12); // positive: outward
}

TEST(Surface, IsClosedAndOutwardForAnyLabels) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Prepared p = clouds::prepare(clouds::random_box(150, seed));
    const TetrahedronLabels labels = clouds::random_labels(p.t, 0.2 * static_cast<double>(seed) - 0.1, seed);
    const MeshSummary summary = summary_of(extract_surface(p.t, labels.labels(), Threads(2)).mesh);
    EXPECT_TRUE(summary.closed());
    EXPECT_EQ(summary.inconsistent_edges, 0u); // as many triangles one way as the other, at every edge
    double volume = 0;
    for (std::uint32_t i = 0; i < p.t.tetrahedra.size(); ++i)
      if (labels.labels().raw()[i] == Label::inside) volume += clouds::volume(p.t, TetrahedronIndex{i});
    EXPECT_NEAR(summary.volume, volume, 1e-9 * volume);
    EXPECT_EQ(summary.unreferenced_vertices, 0u);
  }
}

TEST(Surface, OfAllOutsideIsEmpty) {
  const Prepared p = clouds::prepare(clouds::random_box(30, 6));
  const Surface surface = extract_surface(p.t, Labels(p.t.tetrahedra.size(), Label::outside), Threads(2));
  EXPECT_TRUE(surface.mesh.triangles.empty());
  EXPECT_TRUE(surface.mesh.vertices.empty());
}

TEST(Surface, TrianglesAtTheCubeAreTrimmed) {
  // As with a facade: everything inside but what touches the four corners in front.
  const Prepared p = clouds::prepare(clouds::random_box(60, 7));
  Labels labels(p.t.tetrahedra.size(), Label::inside);
  for (std::uint32_t i = 0; i < labels.size(); ++i)
    for (const VertexIndex s : p.t.tetrahedra.raw()[i])
      if (p.t.is_corner(s) && p.t.positions[s].z > 0) labels.raw()[i] = Label::outside;
  const Surface surface = extract_surface(p.t, labels, Threads(2));
  EXPECT_FALSE(surface.mesh.triangles.empty());
  for (const SampleIndex s : surface.sample_of) EXPECT_FALSE(p.t.is_corner(s));
}

} // namespace
} // namespace eigencrust
