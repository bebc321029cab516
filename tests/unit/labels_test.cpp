// SPDX-License-Identifier: GPL-3.0-or-later
// §3.2 to §3.4: from signs to labels, and the labels that are taken back.
#include <gmock/gmock.h>

#include "clouds.h"

namespace eigencrust {
namespace {

using clouds::Points;
using clouds::Prepared;

/// Everything up to the first partition.
struct FirstStage {
  explicit FirstStage(const Points& points) : p(clouds::prepare(points)) {
    const Threads threads(1);
    known = known_labels(p.t, p.stars, {}, {}, {}, threads);
    graph = pole_graph(p.t, p.stars, p.poles, known, {}, {}, false, threads);
    partition = partition_poles(graph, {}, true, threads, &component);
  }
  PoleLabels labels(GlobalSign sign) const {
    return label_poles(p.t, p.poles, graph, partition, component, known, sign, Threads(1));
  }
  /// Of the first pole that the node stands for.
  [[nodiscard]] TetrahedronIndex tetrahedron_of(std::uint32_t node) const {
    PoleIndex pole{0};
    while (graph.node[pole].value != node) ++pole.value;
    return p.poles.tetrahedron[pole];
  }
  void negate_all_but_supernodes() {
    for (float& v : partition.value) v = -v;
  }

  Prepared p;
  Labels known;
  PoleGraph graph;
  Partition partition;
  std::vector<std::uint32_t> component;
};

/// How many poles away from the cube are labelled as their sphere's centre lies to the unit sphere:
/// those that are, and those that are labelled the other way. Centres near the sphere do not count.
std::pair<int, int> right_and_wrong(const FirstStage& stage, const Labels& labels) {
  std::pair<int, int> count;
  for (std::uint32_t i = 0; i < stage.p.poles.tetrahedron.size(); ++i) {
    const TetrahedronIndex t = stage.p.poles.tetrahedron.raw()[i];
    const double r = norm(stage.p.poles.sphere.raw()[i].centre + stage.p.t.origin);
    if (stage.p.t.touches_cube(t) || labels[t] == Label::unlabelled || std::fabs(r - 1) < 0.3) continue;
    ++((labels[t] == Label::outside) == (r > 1) ? count.first : count.second);
  }
  return count;
}

TEST(LabelPoles, OfASphereAreInsideAndOutside) {
  const FirstStage stage(clouds::jittered(clouds::sphere(600), 0.01, 1));
  for (const GlobalSign sign : {GlobalSign::vote, GlobalSign::supernode}) {
    const PoleLabels result = stage.labels(sign);
    const auto [right, wrong] = right_and_wrong(stage, result.labels);
    EXPECT_GT(right, 0);
    EXPECT_EQ(wrong, 0);
    EXPECT_FALSE(result.reversed);
    EXPECT_EQ(result.left_to_stage_two, 0u);
    EXPECT_EQ(result.contradicted, 0u);
  }
  EXPECT_GT(stage.labels(GlobalSign::vote).vote, 0.9);
}

TEST(LabelPoles, KnownLabelsStay) {
  const FirstStage stage(clouds::jittered(clouds::sphere(300), 0.01, 2));
  const PoleLabels result = stage.labels(GlobalSign::vote);
  for (std::uint32_t i = 0; i < stage.known.size(); ++i)
    if (stage.known.raw()[i] != Label::unlabelled) {
      EXPECT_EQ(result.labels.raw()[i], stage.known.raw()[i]);
    }
}

TEST(LabelPoles, OnlyPolesAreLabelled) {
  const FirstStage stage(clouds::jittered(clouds::sphere(300), 0.01, 3));
  const PoleLabels result = stage.labels(GlobalSign::vote);
  std::vector<std::uint8_t> is_pole(stage.known.size(), 0);
  for (const TetrahedronIndex t : stage.p.poles.tetrahedron) is_pole[t.value] = 1;
  for (std::uint32_t i = 0; i < stage.known.size(); ++i)
    if (!is_pole[i]) {
      EXPECT_EQ(result.labels.raw()[i], stage.known.raw()[i]);
    }
}

TEST(LabelPoles, AForgedSupernodeSignIsOverruledByTheVote) {
  // The sign of z alone is turned: the poles' values say as before which are together.
  FirstStage stage(clouds::jittered(clouds::sphere(600), 0.01, 4));
  const Labels truth = stage.labels(GlobalSign::vote).labels;
  stage.partition.supernode_value[0] = -stage.partition.supernode_value[0];
  const PoleLabels voted = stage.labels(GlobalSign::vote);
  EXPECT_TRUE(voted.reversed);
  EXPECT_EQ(voted.labels.raw(), truth.raw());
  const PoleLabels believed = stage.labels(GlobalSign::supernode);
  EXPECT_FALSE(believed.reversed);
  EXPECT_EQ(right_and_wrong(stage, believed.labels).first, 0);
}

TEST(LabelPoles, TheSignOfTheWholeVectorIsArbitrary) {
  FirstStage stage(clouds::jittered(clouds::sphere(300), 0.01, 5));
  for (const GlobalSign sign : {GlobalSign::vote, GlobalSign::supernode}) {
    const Labels before = stage.labels(sign).labels;
    stage.negate_all_but_supernodes();
    stage.partition.supernode_value[0] = -stage.partition.supernode_value[0];
    EXPECT_EQ(stage.labels(sign).labels.raw(), before.raw());
  }
}

TEST(LabelPoles, AShellOfOutliersDoesNotTurnInsideOut) {
  // All hull samples are outliers; each claims that what it sees within is inside.
  clouds::Random random(6);
  Points points = clouds::jittered(clouds::sphere(2000), 0.005, 7);
  for (int i = 0; i < 60;) {
    const Vec3 p = random.in_box(1.6);
    if (norm(p) < 1.3) continue;
    points.push_back(p);
    ++i;
  }
  const FirstStage stage(points);
  const auto [right, wrong] = right_and_wrong(stage, stage.labels(GlobalSign::vote).labels);
  EXPECT_GT(right, 20 * wrong);
}

TEST(LabelPoles, PolesThatTheirNeighboursContradictAreNotTrusted) {
  FirstStage stage(clouds::jittered(clouds::sphere(600), 0.01, 8));
  // One inside node turned against all of its neighbours, with a value too small to move anybody else.
  std::uint32_t node = 0;
  while (stage.partition.value[node] * stage.partition.supernode_value[0] >= 0) ++node;
  stage.partition.value[node] = -1e-6f * stage.partition.value[node];
  const TetrahedronIndex t = stage.tetrahedron_of(node);
  const PoleLabels result = stage.labels(GlobalSign::supernode);
  EXPECT_EQ(result.labels[t], Label::outside);
  EXPECT_EQ(result.trust[t], 0);
  EXPECT_EQ(result.contradicted, 1u);
}

TEST(LabelPoles, TrustIsTheAgreementOfTheNeighbours) {
  const FirstStage stage(clouds::jittered(clouds::sphere(300), 0.05, 10));
  const PoleLabels result = stage.labels(GlobalSign::vote);
  ASSERT_EQ(result.trust.size(), stage.known.size());
  const SignedGraph& graph = stage.graph.graph;
  for (std::uint32_t node = 0; node < graph.node_count(); ++node) {
    double sum = 0, size = 0;
    const auto add = [&](double term) {
      sum += term;
      size += std::fabs(term);
    };
    for (std::uint64_t e = graph.row_begin[node]; e < graph.row_begin[node + 1]; ++e)
      add(static_cast<double>(graph.weight[e]) * static_cast<double>(stage.partition.value[graph.column[e]]));
    add(static_cast<double>(graph.supernodes[0].weight[node]) * stage.partition.supernode_value[0]);
    const double agreement = (stage.partition.value[node] > 0 ? sum : -sum) / size;
    EXPECT_NEAR(result.trust[stage.tetrahedron_of(node)], 255 * std::max(0.0, agreement), 0.51);
  }
}

TEST(LabelPoles, FreeComponentsAreLeftOpen) {
  FirstStage stage(clouds::jittered(clouds::sphere(600), 0.01, 9));
  stage.component[5] = 1;
  const PoleLabels result = stage.labels(GlobalSign::supernode);
  EXPECT_EQ(result.labels[stage.tetrahedron_of(5)], Label::unlabelled);
  EXPECT_EQ(result.left_to_stage_two, 1u);
}

TEST(Questionable, TetrahedraHaveAllEdgesBelowFourGridSpacings) {
  const Prepared p = clouds::prepare(clouds::random_box(200, 10));
  const double spacing = 0.125; // exact as a float
  const auto everywhere = [&](double length) { return SampleLengths(p.t.sample_count, static_cast<float>(length)); };
  const std::vector<std::uint8_t> flags = questionable_tetrahedra(p.t, everywhere(spacing), Threads(2));
  ASSERT_EQ(flags.size(), p.t.tetrahedra.size());
  std::size_t count = 0;
  for (std::uint32_t i = 0; i < flags.size(); ++i) {
    double longest = 0;
    for (const VertexIndex a : p.t.tetrahedra.raw()[i])
      for (const VertexIndex b : p.t.tetrahedra.raw()[i])
        longest = std::max(longest, distance(p.t.positions[a], p.t.positions[b]));
    EXPECT_EQ(flags[i] != 0, longest < 4 * spacing && !p.t.touches_cube(TetrahedronIndex{i}));
    count += flags[i];
  }
  EXPECT_GT(count, 0u);
  EXPECT_LT(count, flags.size() / 2);
  EXPECT_TRUE(questionable_tetrahedra(p.t, {}, Threads(1)).empty());
  // Cube tetrahedra stay however large the spacing.
  const auto all = questionable_tetrahedra(p.t, everywhere(1e9), Threads(1));
  for (std::uint32_t i = 0; i < all.size(); ++i) EXPECT_EQ(all[i] == 0, p.t.touches_cube(TetrahedronIndex{i}));
}

TEST(Questionable, LabelsAreRemovedUnlessKnownBeforehand) {
  using enum Label;
  const Labels known(std::vector<Label>{outside, unlabelled, unlabelled, unlabelled, inside});
  Labels labels(std::vector<Label>{outside, inside, outside, unlabelled, inside});
  const std::vector<std::uint8_t> questionable{1, 1, 0, 1, 1};
  EXPECT_EQ(unlabel_questionable(questionable, known, labels), 1u);
  EXPECT_THAT(labels.raw(), testing::ElementsAre(outside, unlabelled, outside, unlabelled, inside));
  EXPECT_EQ(unlabel_questionable({}, known, labels), 0u); // §3.3 switched off
}

TEST(LabelTetrahedra, TakeTheSideOfTheSupernodeWhoseSignTheyShare) {
  using enum Label;
  // Tetrahedra 1 and 3 were open; both vectors say the same of them.
  TetrahedronGraph graph;
  graph.graph.row_begin = {0, 0, 0};
  graph.tetrahedron.raw() = {TetrahedronIndex{1}, TetrahedronIndex{3}};
  for (const float sign : {1.0f, -1.0f}) {
    Partition partition;
    partition.supernode_value = {0.5 * static_cast<double>(sign), -0.25 * static_cast<double>(sign)};
    partition.value = {0.125f * sign, -0.75f * sign};
    const TetrahedronLabels result =
        label_tetrahedra(graph, partition, Labels(std::vector<Label>{outside, unlabelled, inside, unlabelled}));
    EXPECT_THAT(result.labels().raw(), testing::ElementsAre(outside, outside, inside, inside));
    EXPECT_THAT(result.values().raw(), testing::ElementsAre(0.5f, 0.125f, -0.25f, -0.75f));
    EXPECT_FALSE(supernodes_agree(partition));
  }
  Partition useless;
  useless.supernode_value = {0.5, 0.25};
  useless.value = {0, 0.1f};
  EXPECT_TRUE(supernodes_agree(useless));
}

TEST(TetrahedronLabels, KeepSideAndSignTogetherThereAndBack) {
  constexpr Label outside = Label::outside, inside = Label::inside;
  const TetrahedronIndex a{0}, b{1}, zero{2};
  TetrahedronLabels labels(Labels(std::vector<Label>{outside, inside, outside}),
                           IndexedArray<TetrahedronIndex, float>(std::vector<float>{-0.5f, 0.25f, 0.0f}));
  const auto expect = [&](Label of_a, Label of_b, float value_a, float value_b) {
    EXPECT_THAT(labels.labels().raw(), testing::ElementsAre(of_a, of_b, labels[zero]));
    EXPECT_EQ(labels.value(a), value_a);
    EXPECT_EQ(labels.value(b), value_b);
    EXPECT_EQ(std::signbit(labels.value(zero)), labels[zero] == inside);
  };
  expect(outside, inside, 0.5f, -0.25f); // the size counts
  TetrahedronLabels::Journal journal;
  labels.turn(a, journal);
  labels.turn(zero, journal);
  labels.turn(a, journal);
  labels.turn(b, journal);
  expect(outside, outside, 0.5f, 0.25f);
  EXPECT_THAT(journal, testing::ElementsAre(a, zero, a, b));
  labels.undo(journal);
  expect(outside, inside, 0.5f, -0.25f);
  EXPECT_EQ(labels[zero], outside);
}

} // namespace
} // namespace eigencrust
