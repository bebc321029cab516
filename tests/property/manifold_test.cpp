// SPDX-License-Identifier: GPL-3.0-or-later
// §3.5 and all moves must make a manifold of any labelling whatever, so they are given random ones.
#include <eigencrust/validate.h>
#include <gmock/gmock.h>

#include "moves.h"

namespace eigencrust {
namespace {

using clouds::Prepared;

void expect_manifold(const Prepared& p, const TetrahedronLabels& labels) {
  for (TetrahedronIndex i{0}; i.value < labels.size(); ++i.value) {
    ASSERT_NE(labels[i], Label::unlabelled);
    if (p.t.touches_cube(i)) {
      ASSERT_EQ(labels[i], Label::outside);
    }
  }
  const MeshSummary m = clouds::summary_of(p.t, labels.labels());
  EXPECT_GT(m.triangles, 0u); // to turn everything would do, too
  EXPECT_EQ(m.boundary_edges, 0u);
  EXPECT_EQ(m.nonmanifold_edges, 0u);
  EXPECT_EQ(m.nonmanifold_vertices, 0u);
  EXPECT_EQ(m.inconsistent_edges, 0u);
  EXPECT_GT(m.volume, 0);
}

void expect_papers_repair(const Prepared& p, const TetrahedronLabels& before) {
  TetrahedronLabels labels = before;
  const ManifoldCounts counts = make_manifold(p.t, p.stars, p.poles, p.known, labels, Threads(2));
  std::uint64_t changed = 0;
  for (TetrahedronIndex i{0}; i.value < labels.size(); ++i.value) {
    changed += labels[i] != before[i];
    if (labels[i] == Label::inside) {
      ASSERT_EQ(before[i], Label::inside);
    }
  }
  EXPECT_EQ(changed, counts.relabelled);
  expect_manifold(p, labels);
  // A second repair has nothing left to do.
  EXPECT_EQ(make_manifold(p.t, p.stars, p.poles, p.known, labels, Threads(2)).relabelled, 0u);
}

/// All moves one after the other, with as much noise as the seed says: a manifold after each of them.
TetrahedronLabels after_all_moves(const Prepared& p, const TetrahedronLabels& before, std::uint64_t seed,
                                  unsigned threads) {
  clouds::MoveStage stage(p, before, 0.2, threads);
  clouds::Random random(seed);
  for (std::uint32_t s = 0; s < p.t.sample_count; ++s) {
    stage.model.noise[SampleIndex{s}] = stage.model.input_noise[SampleIndex{s}] =
        static_cast<float>(0.04 * static_cast<double>(seed % 4));
    stage.model.isolated[SampleIndex{s}] = random.uniform() < 0.02 ? 1.0f : 0.0f;
  }
  Moves moves = stage.moves();
  moves.make_manifold();
  expect_manifold(p, stage.labels);
  const MeshSummary whole = stage.summary();
  close_handles(moves);
  expect_manifold(p, stage.labels);
  EXPECT_LE(stage.summary().genus, whole.genus);
  recover_samples(moves);
  expect_manifold(p, stage.labels);
  moves.settle_values();
  EXPECT_EQ(stage.moves().make_manifold().relabelled, 0u);
  return stage.labels;
}

void expect_repaired(const Prepared& p, const TetrahedronLabels& labels, std::uint64_t seed = 1) {
  expect_papers_repair(p, labels);
  const TetrahedronLabels one = after_all_moves(p, labels, seed, 1), two = after_all_moves(p, labels, seed, 2);
  EXPECT_EQ(one.labels().raw(), two.labels().raw());
  EXPECT_EQ(one.values().raw(), two.values().raw());
}

class RandomLabels : public testing::TestWithParam<std::uint64_t> {};

TEST_P(RandomLabels, BecomeAManifold) {
  const std::uint64_t seed = GetParam();
  const Prepared p = clouds::prepare(clouds::random_box(200 + 90 * seed, seed));
  const double share = 0.05 + 0.045 * static_cast<double>(seed); // of inside tetrahedra, up to 0.95
  const TetrahedronLabels labels = clouds::random_labels(p.t, share, seed);
  expect_repaired(p, labels, seed);
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomLabels, testing::Range<std::uint64_t>(1, 21));

TEST(RandomLabels, OnACosphericalLatticeBecomeAManifold) {
  const Prepared p = clouds::prepare(clouds::lattice(8, 8, 8));
  for (const double share : {0.2, 0.5, 0.8}) expect_repaired(p, clouds::random_labels(p.t, share, 1));
}

TEST(RandomLabels, WithEqualValuesBecomeAManifold) {
  // Ties everywhere: all labels equally certain, or of no certainty at all.
  const Prepared p = clouds::prepare(clouds::random_box(800, 30));
  for (const float value : {0.0f, 1.0f}) {
    TetrahedronLabels labels = clouds::random_labels(p.t, 0.5, 31);
    labels = {labels.labels(), IndexedArray<TetrahedronIndex, float>(labels.size(), value)};
    expect_repaired(p, labels);
  }
}

} // namespace
} // namespace eigencrust
