// SPDX-License-Identifier: GPL-3.0-or-later
// A sphere with a tetrahedron between its surface and one sample, or a few, far from it, labelled by hand.
#include <gmock/gmock.h>

#include "moves.h"

namespace eigencrust {
namespace {

using clouds::MoveStage;
using clouds::Points;
using clouds::Prepared;

/// 2,000 samples stand 0.08 apart on the unit sphere, others around `place`. All within the sphere is inside, and one
/// tetrahedron of each that leads from there to a single sample at `place` and back.
struct Spike : MoveStage {
  std::vector<TetrahedronIndex> spike;

  Spike(const Points& others, const Vec3& place, double certainty, std::size_t samples = 2000)
      : Spike(clouds::prepare(clouds::joined(clouds::sphere(samples), others)),
              3.5 / std::sqrt(static_cast<double>(samples)), place) {
    const bool beyond = norm(place) > 1;
    clouds::HandMade made(p.t.tetrahedra.size(), 5);
    std::vector<TetrahedronIndex> leading;
    for (TetrahedronIndex i{0}; i.value < p.t.tetrahedra.size(); ++i.value) {
      const auto& v = p.t.tetrahedra[i];
      const auto far = std::count_if(v.begin(), v.end(), [&](SampleIndex s) { return is_other(s); });
      if (p.t.touches_cube(i)) continue;
      if (far == 1 && leads_across(i, beyond)) leading.push_back(i);
      if (far == 0 || !beyond) made.set(i, Label::inside, 5);
    }
    spike.push_back(leading.at(leading.size() / 2));
    made.set(spike[0], beyond ? Label::inside : Label::outside, static_cast<float>(certainty));
    labels = made.done();
    energy.data = labels.values();
  }
  [[nodiscard]] bool is_other(SampleIndex s) const {
    return !p.t.is_corner(s) && distance(p.t.positions[s] + p.t.origin, place_) < 0.2;
  }
  /// Is across from the sample at the place what lies within the sphere (beyond) or around it?
  [[nodiscard]] bool leads_across(TetrahedronIndex i, bool beyond) const {
    const auto& v = p.t.tetrahedra[i];
    std::size_t k = 0;
    while (!is_other(v[k])) ++k;
    const TetrahedronIndex n = p.t.neighbours[i][k];
    const auto& w = p.t.tetrahedra[n];
    const bool other = std::any_of(w.begin(), w.end(), [&](SampleIndex s) { return is_other(s); });
    return !other && (beyond != p.t.touches_cube(n));
  }
  [[nodiscard]] std::size_t others_on_surface() const {
    const auto samples = surface().sample_of;
    return static_cast<std::size_t>(
        std::count_if(samples.begin(), samples.end(), [&](SampleIndex s) { return is_other(s); }));
  }
  void isolate() {
    for (SampleIndex s{0}; s.value < p.t.sample_count; ++s.value)
      if (is_other(s)) model.isolated[s.value] = 1;
  }
  std::uint64_t cut() {
    Moves engine = moves();
    const std::uint64_t count = cut_spikes(engine).cut;
    if (count > 0) engine.settle_values();
    return count;
  }
  void expect_uncut() {
    ASSERT_GT(others_on_surface(), 0u);
    const TetrahedronLabels before = labels;
    EXPECT_EQ(cut(), 0u);
    EXPECT_EQ(labels.labels().raw(), before.labels().raw());
    EXPECT_EQ(labels.values().raw(), before.values().raw());
  }

 private:
  Spike(Prepared prepared, double spacing, const Vec3& place)
      : MoveStage(std::move(prepared), {}, spacing), place_(place) {}
  Vec3 place_;
};

const Vec3 far_away{0.3, 0.2, 3}, nearer{0.1, 0.05, 1.5}, deep{0.02, 0.01, 0.03};

TEST(Spikes, AreCutThoughTheirOwnPoleVouchesForThem) {
  Spike spike({far_away}, far_away, 10);
  spike.isolate();
  ASSERT_EQ(spike.others_on_surface(), 1u);
  EXPECT_EQ(spike.cut(), 1u);
  EXPECT_EQ(spike.labels[spike.spike[0]], Label::outside);
  EXPECT_FALSE(std::signbit(spike.labels.value(spike.spike[0])));
  // What is left is the sphere, with all its samples.
  EXPECT_EQ(spike.surface().mesh.vertices.size(), 2000u);
  EXPECT_EQ(spike.others_on_surface(), 0u);
  EXPECT_TRUE(clouds::is_closed_manifold(spike.summary()));
}

TEST(Spikes, PitsAreFilled) {
  Spike pit({deep}, deep, 5, 8000); // 25 spacings from everything
  pit.isolate();
  ASSERT_EQ(pit.others_on_surface(), 1u);
  EXPECT_EQ(pit.cut(), 1u);
  EXPECT_EQ(pit.labels[pit.spike[0]], Label::inside);
  EXPECT_EQ(pit.surface().mesh.vertices.size(), 8000u);
}

TEST(Spikes, SureOnesStay) {
  Spike spike({far_away}, far_away, 100); // more than its length can cost
  spike.isolate();
  spike.expect_uncut();
}

TEST(Spikes, WhatIsKnownStays) {
  Spike spike({far_away}, far_away, 5);
  spike.isolate();
  spike.energy.known[spike.spike[0]] = Label::inside;
  spike.expect_uncut();
}

TEST(Spikes, ShortOnesAndThoseOfSamplesInCompanyStay) {
  Spike near({nearer}, nearer, 5); // 6 spacings
  near.isolate();
  near.expect_uncut();
  Spike no_outlier({far_away}, far_away, 5); // the model says so
  no_outlier.expect_uncut();
}

TEST(Spikes, FinsToSmallLonelyGroupsAreCut) {
  Spike fin(clouds::sphere(12, 0.1, far_away), far_away, 5);
  ASSERT_EQ(fin.others_on_surface(), 1u);
  EXPECT_EQ(fin.cut(), 1u);
  EXPECT_EQ(fin.labels[fin.spike[0]], Label::outside);
  EXPECT_EQ(fin.surface().mesh.vertices.size(), 2000u);
  EXPECT_TRUE(clouds::is_closed_manifold(fin.summary()));
  Spike(clouds::sphere(100, 0.1, far_away), far_away, 5).expect_uncut();
}

// An unscanned side is closed with triangles as long as any spike's; its corners are no isolated samples.
TEST(Spikes, LidsStay) {
  Points bowl = clouds::sphere(4000);
  std::erase_if(bowl, [](const Vec3& p) { return p.z > 0; });
  Prepared p = clouds::prepare(bowl);
  clouds::HandMade made(p.t.tetrahedra.size(), 0);
  for (TetrahedronIndex i{0}; i.value < p.t.tetrahedra.size(); ++i.value)
    if (!p.t.touches_cube(i)) made.set(i, Label::inside, 0);
  MoveStage stage(std::move(p), made.done(), 0.05);
  const Labels before = stage.labels.labels();
  Moves moves = stage.moves();
  EXPECT_EQ(cut_spikes(moves).cut, 0u);
  EXPECT_EQ(stage.labels.labels().raw(), before.raw());
}

/// A sphere whose one vertex is passed by: the tetrahedra at it are outside.
MoveStage dented_sphere(SampleIndex dent) {
  Prepared p = clouds::prepare(clouds::sphere(1000));
  clouds::HandMade made(p.t.tetrahedra.size(), 3);
  for (TetrahedronIndex i{0}; i.value < p.t.tetrahedra.size(); ++i.value)
    if (const auto& v = p.t.tetrahedra[i]; !p.t.touches_cube(i) && std::find(v.begin(), v.end(), dent) == v.end())
      made.set(i, Label::inside, 3);
  return {std::move(p), made.done(), 0.12};
}

TEST(RecoverSamples, TakesInWhatThePricesSay) {
  const SampleIndex dent{500};
  MoveStage stage = dented_sphere(dent);
  ASSERT_FALSE(stage.on_surface(dent));
  const MeshSummary before = stage.summary();
  ASSERT_TRUE(clouds::is_closed_manifold(before));
  Moves moves = stage.moves();
  EXPECT_EQ(recover_samples(moves).samples, 1u);
  EXPECT_TRUE(stage.on_surface(dent));
  const MeshSummary after = stage.summary();
  EXPECT_TRUE(clouds::is_closed_manifold(after));
  EXPECT_EQ(after.euler, before.euler); // neither opens nor joins anything
  EXPECT_EQ(after.components, before.components);
  EXPECT_EQ(after.vertices, before.vertices + 1);
}

TEST(RecoverSamples, LeavesOutWhatNoiseOrOutliersExplain) {
  const SampleIndex dent{500};
  MoveStage noisy = dented_sphere(dent), sure = dented_sphere(dent), known = dented_sphere(dent);
  noisy.model.noise.assign(noisy.p.t.sample_count, 0.1f);
  for (TetrahedronIndex i{0}; i.value < sure.energy.data.size(); ++i.value) {
    sure.energy.data[i] *= 10;
    known.energy.known[i] = known.labels[i];
  }
  for (MoveStage* stage : {&noisy, &sure, &known}) {
    Moves moves = stage->moves();
    EXPECT_EQ(recover_samples(moves).samples, 0u);
  }
  // Many of its kind are passed by: outliers are.
  Points points = clouds::sphere(1000);
  clouds::Random random(5);
  while (points.size() < 1100)
    if (const Vec3 at = random.in_box(2); norm(at) > 1.05) points.push_back(at);
  Prepared p = clouds::prepare(points);
  clouds::HandMade made(p.t.tetrahedra.size(), 0.1f);
  for (TetrahedronIndex i{0}; i.value < p.t.tetrahedra.size(); ++i.value) {
    const auto& v = p.t.tetrahedra[i];
    const bool within = std::none_of(v.begin(), v.end(), [&](SampleIndex s) {
      return p.t.is_corner(s) || norm(p.t.positions[s] + p.t.origin) > 1.01;
    });
    if (within) made.set(i, Label::inside, 0.1f);
  }
  MoveStage outliers(std::move(p), made.done(), 0.12);
  ASSERT_EQ(outliers.surface().sample_of.size(), 1000u);
  Moves moves = outliers.moves();
  recover_samples(moves);
  EXPECT_LE(outliers.surface().sample_of.size(), 1002u); // some stand among those of the sphere
}

} // namespace
} // namespace eigencrust
