// SPDX-License-Identifier: GPL-3.0-or-later
// A sphere with a tetrahedron between its surface and one sample far from it, labelled by hand.
#include <eigencrust/validate.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "clouds.h"
#include "models.h"
#include "parallel/threads.h"
#include "repair/spikes.h"

namespace eigencrust {
namespace {

using clouds::Points;
using clouds::Prepared;

/// 2,000 samples stand 0.08 apart on the unit sphere (8,000: 0.04), the lonely one at `place`. All that is open has
/// little value.
struct Spike {
  Threads threads{2};
  Prepared p;
  SampleIndex tip;
  std::vector<TetrahedronIndex> spike; ///< between the tip and the surface
  Labels first;
  TetrahedronLabels labels;
  Neighbourhoods neighbourhoods;

  Spike(const Vec3& place, std::size_t tetrahedra, std::size_t samples = 2000)
      : p(clouds::prepare(clouds::joined(clouds::sphere(samples), {place}))) {
    for (SampleIndex s{0}; s.value < p.t.sample_count; ++s.value)
      if (distance(p.t.positions[s] + p.t.origin, place) < 1e-9) tip = s;
    const std::size_t n = p.t.tetrahedra.size();
    first = Labels(n, Label::unlabelled);
    clouds::HandMade made(n, 0.05f);
    const bool beyond = norm(place) > 1;
    for (TetrahedronIndex i{0}; i.value < n; ++i.value) {
      if (p.t.touches_cube(i) || (beyond && at_tip(i))) continue;
      made.set(i, Label::inside, 0.05f);
    }
    labels = made.done();
    neighbourhoods = sample_neighbourhoods(std::span(p.t.positions.raw()).first(p.t.sample_count), threads);
    // Tetrahedra with a surface triangle opposite the tip, each beside the one before.
    const Label around = beyond ? Label::outside : Label::inside;
    for (const TetrahedronIndex i : p.stars[tip]) {
      if (spike.size() == tetrahedra) break;
      if (p.t.touches_cube(i) || labels[across_from_tip(i)] == around) continue;
      if (spike.empty() || is_beside(i, spike.back())) spike.push_back(i);
    }
    for (const TetrahedronIndex i : spike) clouds::put(labels, i, beyond ? Label::inside : Label::outside);
  }
  [[nodiscard]] bool at_tip(TetrahedronIndex i) const {
    const auto& v = p.t.tetrahedra[i];
    return std::find(v.begin(), v.end(), tip) != v.end();
  }
  [[nodiscard]] TetrahedronIndex across_from_tip(TetrahedronIndex i) const {
    const auto& v = p.t.tetrahedra[i];
    return p.t.neighbours[i][static_cast<std::size_t>(std::find(v.begin(), v.end(), tip) - v.begin())];
  }
  [[nodiscard]] bool is_beside(TetrahedronIndex i, TetrahedronIndex j) const {
    const auto& n = p.t.neighbours[i];
    return std::find(n.begin(), n.end(), j) != n.end();
  }
  [[nodiscard]] Surface surface() const { return extract_surface(p.t, labels.labels(), Threads(2)); }
  [[nodiscard]] bool tip_on_surface() const {
    const Surface s = surface();
    return std::find(s.sample_of.begin(), s.sample_of.end(), tip) != s.sample_of.end();
  }
  std::uint64_t cut() {
    return cut_spikes(p.t, p.stars, p.poles, first, p.known, neighbourhoods, {}, ManifoldRule::cheapest, labels).cut;
  }
  void expect_uncut() {
    const TetrahedronLabels before = labels;
    EXPECT_EQ(cut(), 0u);
    EXPECT_EQ(labels.labels().raw(), before.labels().raw());
    EXPECT_EQ(labels.values().raw(), before.values().raw());
  }
};

TEST(Spikes, AreCutWhereNoPoleVouchesForThem) {
  for (const std::size_t tetrahedra : {1u, 2u}) {
    Spike spike({0.3, 0.2, 3}, tetrahedra);
    ASSERT_EQ(spike.spike.size(), tetrahedra);
    ASSERT_GT(spike.neighbourhoods.isolated[spike.tip.value], 0);
    ASSERT_TRUE(spike.tip_on_surface());
    EXPECT_EQ(spike.cut(), 1u);
    for (const TetrahedronIndex i : spike.spike) {
      EXPECT_EQ(spike.labels[i], Label::outside);
      EXPECT_GT(spike.labels.value(i), 0);
    }
    // What is left is the sphere, with all its samples.
    EXPECT_EQ(spike.surface().mesh.vertices.size(), 2000u);
    EXPECT_FALSE(spike.tip_on_surface());
    const MeshSummary summary = validate(spike.surface().mesh);
    EXPECT_TRUE(summary.closed() && summary.manifold());
  }
}

TEST(Spikes, PitsAreFilled) {
  Spike pit({0.02, 0.01, 0.03}, 1, 8000);
  ASSERT_EQ(pit.spike.size(), 1u);
  pit.neighbourhoods.isolated[pit.tip.value] = 1; // 25 spacings from everything: a support of 0.05
  ASSERT_TRUE(pit.tip_on_surface());
  EXPECT_EQ(pit.cut(), 1u);
  EXPECT_EQ(pit.labels[pit.spike.front()], Label::inside);
  EXPECT_EQ(pit.surface().mesh.vertices.size(), 8000u);
}

TEST(Spikes, StayWhereTheFirstStageSettledThem) {
  Spike spike({0.3, 0.2, 3}, 2);
  spike.first[spike.spike.front()] = Label::inside;
  // The other way, turning the tip's surroundings, would drown the sphere: they touch the cube.
  spike.expect_uncut();
}

TEST(Spikes, StayWhereTheTipIsNotAlone) {
  Spike spike({0.3, 0.2, 3}, 1);
  spike.neighbourhoods.isolated[spike.tip.value] = 0;
  spike.expect_uncut();
}

TEST(Spikes, ShortOnesAndSureOnesStay) {
  Spike near({0.1, 0.05, 1.4}, 1); // at most 13 spacings: a support of 0.11
  near.neighbourhoods.isolated[near.tip.value] = 1;
  near.expect_uncut();

  Spike sure({0.3, 0.2, 2.2}, 1); // 15 spacings and full contrast: 0.17
  ASSERT_GT(sure.neighbourhoods.isolated[sure.tip.value], 0);
  sure.labels = {sure.labels.labels(), IndexedArray<TetrahedronIndex, float>(sure.labels.size(), 1.0f)};
  sure.expect_uncut();
}

// An unscanned side is closed with triangles as long as any spike's; its corners are no isolated samples.
TEST(Spikes, LidsStay) {
  Points bowl = clouds::sphere(4000);
  std::erase_if(bowl, [](const Vec3& p) { return p.z > 0; });
  Prepared p = clouds::prepare(bowl);
  Labels first(p.t.tetrahedra.size(), Label::unlabelled);
  clouds::HandMade made(p.t.tetrahedra.size(), 0);
  for (TetrahedronIndex i{0}; i.value < p.t.tetrahedra.size(); ++i.value)
    if (!p.t.touches_cube(i)) made.set(i, Label::inside, 0);
  TetrahedronLabels labels = made.done();
  const Threads threads(2);
  const Neighbourhoods around = sample_neighbourhoods(std::span(p.t.positions.raw()).first(p.t.sample_count), threads);
  const Labels before = labels.labels();
  EXPECT_EQ(cut_spikes(p.t, p.stars, p.poles, first, p.known, around, {}, ManifoldRule::cheapest, labels).cut, 0u);
  EXPECT_EQ(labels.labels().raw(), before.raw());
}

/// The sphere, a cluster of samples far from it, and a tetrahedron from the sphere's surface to one of them.
struct Fin {
  Prepared p;
  std::vector<TetrahedronIndex> fin;
  Labels first;
  TetrahedronLabels labels;

  explicit Fin(std::size_t cluster)
      : p(clouds::prepare(clouds::joined(clouds::sphere(2000), clouds::sphere(cluster, 0.1, {0.3, 0.2, 3})))),
        first(p.t.tetrahedra.size(), Label::unlabelled) {
    clouds::HandMade made(p.t.tetrahedra.size(), 0.05f);
    std::vector<TetrahedronIndex> to_cluster;
    for (TetrahedronIndex i{0}; i.value < p.t.tetrahedra.size(); ++i.value) {
      if (p.t.touches_cube(i)) continue;
      const auto& v = p.t.tetrahedra[i];
      const auto far = std::count_if(v.begin(), v.end(), [&](SampleIndex s) { return in_cluster(s); });
      if (far == 1) to_cluster.push_back(i);
      if (far > 0) continue;
      made.set(i, Label::inside, 0.05f);
    }
    labels = made.done();
    fin.push_back(to_cluster.at(to_cluster.size() / 2));
    clouds::put(labels, fin[0], first[fin[0]] = Label::inside); // its one pole says so
  }
  [[nodiscard]] bool in_cluster(SampleIndex s) const { return (p.t.positions[s] + p.t.origin).z > 2; }
  std::uint64_t cut() {
    const Threads threads(2);
    const Neighbourhoods around =
        sample_neighbourhoods(std::span(p.t.positions.raw()).first(p.t.sample_count), threads);
    EXPECT_THAT(around.isolated, testing::Each(0.0f)); // none of them alone
    return cut_spikes(p.t, p.stars, p.poles, first, p.known, around, {}, ManifoldRule::cheapest, labels).cut;
  }
};

TEST(Spikes, FinsToLonelyGroupsAreCut) {
  Fin fin(40);
  ASSERT_EQ(extract_surface(fin.p.t, fin.labels.labels(), Threads(1)).mesh.vertices.size(), 2001u);
  EXPECT_EQ(fin.cut(), 1u);
  EXPECT_EQ(fin.labels[fin.fin[0]], Label::outside);
  const Surface rest = extract_surface(fin.p.t, fin.labels.labels(), Threads(1));
  EXPECT_EQ(rest.mesh.vertices.size(), 2000u);
  const MeshSummary summary = validate(rest.mesh);
  EXPECT_TRUE(summary.closed() && summary.manifold());
}

TEST(Spikes, FinsToManySamplesStay) {
  Fin fin(100);
  const Labels before = fin.labels.labels();
  EXPECT_EQ(fin.cut(), 0u);
  EXPECT_EQ(fin.labels.labels().raw(), before.raw());
}

} // namespace
} // namespace eigencrust
