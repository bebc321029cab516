// SPDX-License-Identifier: GPL-3.0-or-later
// A sound scene has no fault; each thing spoilt is seen.
#include "invariants.h"

#include <gmock/gmock.h>

#include "graphs.h"
#include "moves.h"

namespace eigencrust {
namespace {

using testing::HasSubstr;

struct Stage {
  PointCloud cloud = clouds::cloud_of(clouds::jittered(clouds::sphere(300), 0.01, 1));
  Scene scene;
  Evidence evidence;
  Options options;

  Stage() {
    clouds::Prepared p = clouds::prepare(cloud.points);
    scene.measures.model = sample_model(p.t.positions.raw(), 0.0, Threads(1));
    scene.measures.model.spacing.raw().resize(p.t.sample_count);
    scene.measures.model.noise.raw().resize(p.t.sample_count);
    scene.measures.model.input_noise.raw().resize(p.t.sample_count);
    scene.measures.model.isolated.raw().resize(p.t.sample_count);
    evidence.named = evidence.labels = p.known;
    scene.tetrahedralization = std::move(p.t);
    scene.sample_of_row = std::move(p.sample_of_row);
    scene.stars = std::move(p.stars);
    scene.poles = std::move(p.poles);
  }
  [[nodiscard]] std::string fault() const { return fault_in(scene, cloud); }
};

template <class Spoil>
std::string fault_after(const Spoil& spoil) {
  Stage stage;
  spoil(stage.scene);
  return stage.fault();
}

TEST(Invariants, OfASoundSceneHold) {
  const Stage stage;
  EXPECT_EQ(stage.fault(), "");
  EXPECT_EQ(fault_in(stage.evidence, stage.scene), "");
}

TEST(Invariants, OfTheScene) {
  EXPECT_THAT(fault_after([](Scene& s) { std::swap(s.sample_of_row[3], s.sample_of_row[4]); }), HasSubstr("row 3"));
  EXPECT_THAT(fault_after([](Scene& s) { s.sample_of_row[5] = {}; }), HasSubstr("row 5"));
  EXPECT_NE(
      fault_after([](Scene& s) { s.tetrahedralization.positions.raw()[1] = s.tetrahedralization.positions.raw()[0]; }),
      "");
  EXPECT_THAT(fault_after([](Scene& s) {
                std::swap(s.tetrahedralization.tetrahedra.raw()[7][2], s.tetrahedralization.tetrahedra.raw()[7][3]);
              }),
              HasSubstr("tetrahedron 7"));
  EXPECT_THAT(fault_after([](Scene& s) {
                std::swap(s.tetrahedralization.neighbours.raw()[9][0], s.tetrahedralization.neighbours.raw()[9][1]);
              }),
              HasSubstr("no neighbour of its own"));
  EXPECT_THAT(fault_after([](Scene& s) { ++s.stars.begin[4]; }), HasSubstr("the star of vertex 3"));
  EXPECT_THAT(fault_after([](Scene& s) { std::swap(s.stars.tetrahedra[0], s.stars.tetrahedra[1]); }),
              HasSubstr("out of order"));
  EXPECT_THAT(fault_after([](Scene& s) { s.poles.of_sample.raw()[0].first.value = 1u << 30; }), HasSubstr("pole"));
  EXPECT_THAT(fault_after([](Scene& s) { s.measures.model.spacing[SampleIndex{8}] = 0; }), HasSubstr("sample 8"));
}

TEST(Invariants, OfTheEvidence) {
  Stage stage;
  TetrahedronIndex at_cube{0};
  while (!stage.scene.tetrahedralization.touches_cube(at_cube)) ++at_cube.value;
  stage.evidence.labels[at_cube] = Label::inside;
  EXPECT_THAT(fault_in(stage.evidence, stage.scene), HasSubstr("overrules"));
  stage.evidence.named[at_cube] = Label::unlabelled;
  EXPECT_THAT(fault_in(stage.evidence, stage.scene), HasSubstr("unknown at the cube"));
  PoleLabels poles;
  poles.labels = Labels(stage.evidence.labels.size());
  poles.trust = IndexedArray<TetrahedronIndex, std::uint8_t>(poles.labels.size());
  EXPECT_THAT(fault_in(poles, stage.scene, stage.evidence), HasSubstr("not what is known"));
}

TEST(Invariants, OfGraphs) {
  const SignedGraph sound = graphs::planted(50, 6, 0.1, true, 2).graph;
  EXPECT_EQ(fault_in(sound), "");
  SignedGraph graph = sound;
  graph.weight[3] *= 2;
  EXPECT_THAT(fault_in(graph), HasSubstr("not symmetric"));
  graph = sound;
  std::swap(graph.column[0], graph.column[1]);
  EXPECT_THAT(fault_in(graph), HasSubstr("of node 0"));
  graph = sound;
  std::swap(graph.row_begin[1], graph.row_begin[2]);
  EXPECT_THAT(fault_in(graph), HasSubstr("rows go back"));
}

TEST(Invariants, OfLabelsAndSurfaces) {
  Stage stage;
  const Tetrahedralization& t = stage.scene.tetrahedralization;
  const TetrahedronLabels random = clouds::random_labels(t, 0.5, 3);
  EXPECT_THAT(fault_in(random, stage.scene, stage.options), HasSubstr("no disc"));
  Settled settled{random, {FaceWeights(t, {}, Threads(1)), random.values(), stage.evidence.named, 0}};
  EXPECT_THAT(fault_in(settled, stage.scene, stage.options), HasSubstr("no minimum"));
  TetrahedronLabels labels = random;
  make_manifold(t, stage.scene.stars, stage.scene.poles, stage.evidence.named, labels, Threads(1));
  EXPECT_EQ(fault_in(labels, stage.scene, stage.options), "");
  Surface surface = extract_surface(t, labels.labels(), Threads(1));
  surface.support.assign(surface.mesh.triangles.size(), 1.0f);
  EXPECT_EQ(fault_in(surface, stage.scene, labels, stage.options), "");
  surface.mesh.triangles.pop_back();
  surface.inside.pop_back();
  surface.support.pop_back();
  EXPECT_THAT(fault_in(surface, stage.scene, labels, stage.options), HasSubstr("not two triangles"));
  surface.mesh.triangles[2][1] = static_cast<std::uint32_t>(surface.mesh.vertices.size());
  EXPECT_THAT(fault_in(surface, stage.scene, labels, stage.options), HasSubstr("triangle 2"));
}

} // namespace
} // namespace eigencrust
