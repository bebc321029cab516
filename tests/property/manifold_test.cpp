// SPDX-License-Identifier: GPL-3.0-or-later
// §3.5 must make a manifold of any labelling whatever, so it is given random ones.
#include <eigencrust/validate.h>
#include <gmock/gmock.h>

#include "clouds.h"
#include "repair/recover.h"

namespace eigencrust {
namespace {

using clouds::Prepared;

void expect_repaired(const Prepared& p, const TetrahedronLabels& before, ManifoldRule rule) {
  TetrahedronLabels labels = before;
  const ManifoldCounts counts = make_manifold(p.t, p.stars, p.poles, p.known, rule, labels, Threads(2));
  std::uint64_t changed = 0;
  for (std::uint32_t i = 0; i < labels.labels().size(); ++i) {
    const Label label = labels.labels().raw()[i], old = before.labels().raw()[i];
    ASSERT_NE(label, Label::unlabelled);
    changed += label != old;
    if (p.t.touches_cube(TetrahedronIndex{i})) {
      ASSERT_EQ(label, Label::outside);
    }
    if (rule == ManifoldRule::paper && label == Label::inside) {
      ASSERT_EQ(old, Label::inside);
    }
  }
  EXPECT_LE(changed, counts.relabelled);
  if (rule == ManifoldRule::paper) {
    EXPECT_EQ(changed, counts.relabelled);
  }
  const Surface surface = extract_surface(p.t, labels.labels(), Threads(2));
  if (surface.mesh.triangles.empty()) return;
  const MeshSummary m = validate(surface.mesh, {.self_intersections = false, .merge_equal_vertices = false});
  EXPECT_EQ(m.boundary_edges, 0u);
  EXPECT_EQ(m.nonmanifold_edges, 0u);
  EXPECT_EQ(m.nonmanifold_vertices, 0u);
  EXPECT_EQ(m.inconsistent_edges, 0u);
  EXPECT_GT(m.volume, 0);
  // A second repair has nothing left to do.
  const ManifoldCounts again = make_manifold(p.t, p.stars, p.poles, p.known, rule, labels, Threads(2));
  EXPECT_EQ(again.relabelled, 0u);
}

class RandomLabels : public testing::TestWithParam<std::uint64_t> {};

TEST_P(RandomLabels, BecomeAManifold) {
  const std::uint64_t seed = GetParam();
  const Prepared p = clouds::prepare(clouds::random_box(200 + 90 * seed, seed));
  const double share = 0.05 + 0.045 * static_cast<double>(seed); // of inside tetrahedra, up to 0.95
  const TetrahedronLabels labels = clouds::random_labels(p.t, share, seed);
  for (const ManifoldRule rule : {ManifoldRule::paper, ManifoldRule::cheapest}) expect_repaired(p, labels, rule);
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomLabels, testing::Range<std::uint64_t>(1, 21));

TEST(RandomLabels, OnACosphericalLatticeBecomeAManifold) {
  const Prepared p = clouds::prepare(clouds::lattice(8, 8, 8));
  for (const double share : {0.2, 0.5, 0.8})
    for (const ManifoldRule rule : {ManifoldRule::paper, ManifoldRule::cheapest})
      expect_repaired(p, clouds::random_labels(p.t, share, 1), rule);
}

TEST(RandomLabels, WithEqualValuesBecomeAManifold) {
  // Ties everywhere: all labels equally certain, or of no certainty at all.
  const Prepared p = clouds::prepare(clouds::random_box(800, 30));
  for (const float value : {0.0f, 1.0f}) {
    TetrahedronLabels labels = clouds::random_labels(p.t, 0.5, 31);
    labels = {labels.labels(), IndexedArray<TetrahedronIndex, float>(labels.size(), value)};
    for (const ManifoldRule rule : {ManifoldRule::paper, ManifoldRule::cheapest}) expect_repaired(p, labels, rule);
  }
}

TEST(RecoveredSamples, LeaveAManifoldAManifoldAndKnownLabelsAlone) {
  std::uint64_t recovered = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    // Inside: whatever has its middle in the unit ball; the samples are in a box around it.
    const Prepared p = clouds::prepare(clouds::random_box(1500, seed));
    TetrahedronLabels labels = clouds::random_labels(p.t, 0, seed);
    for (std::uint32_t i = 0; i < labels.labels().size(); ++i)
      if (norm(clouds::centroid(p.t, TetrahedronIndex{i})) < 0.7) labels.turn(TetrahedronIndex{i});
    make_manifold(p.t, p.stars, p.poles, p.known, ManifoldRule::cheapest, labels, Threads(2));
    const Surface before = extract_surface(p.t, labels.labels(), Threads(2));
    Labels known = known_labels(p.t, {}, {}, {}, Threads(1));
    for (std::uint32_t i = 0; i < known.size(); i += 3) known.raw()[i] = labels.labels().raw()[i];
    const Labels old = labels.labels();
    EXPECT_EQ(recover_samples(p.t, p.stars, known, {}, 0, labels).samples, 0u);
    EXPECT_EQ(labels.labels().raw(), old.raw());
    const std::uint64_t count = recover_samples(p.t, p.stars, known, {}, 100, labels).samples;
    for (std::uint32_t i = 0; i < known.size(); ++i)
      if (known.raw()[i] != Label::unlabelled) {
        ASSERT_EQ(labels.labels().raw()[i], known.raw()[i]);
      }
    const Surface after = extract_surface(p.t, labels.labels(), Threads(2));
    EXPECT_EQ(after.sample_of.size(), before.sample_of.size() + count);
    const ValidateOptions quick{.self_intersections = false, .merge_equal_vertices = false};
    const MeshSummary a = validate(before.mesh, quick), b = validate(after.mesh, quick);
    EXPECT_TRUE(b.closed() && b.manifold() && b.oriented());
    EXPECT_EQ(b.euler, a.euler); // neither opens nor joins anything
    EXPECT_EQ(b.components, a.components);
    recovered += count;
  }
  EXPECT_GT(recovered, 0u);
}

} // namespace
} // namespace eigencrust
