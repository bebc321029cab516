// SPDX-License-Identifier: GPL-3.0-or-later
// Support of triangles, and pieces dropped for want of it.
#include <eigencrust/validate.h>
#include <gmock/gmock.h>

#include "clouds.h"
#include "parallel/threads.h"
#include "surface/components.h"
#include "surface/support.h"

namespace eigencrust {
namespace {

using clouds::Points;
using clouds::Prepared;
using Kind = KeepComponents::Kind;

/// Everything within the hull of the points is inside, with values -x and x.
struct Hull {
  Threads threads{2};
  Prepared p;
  TetrahedronLabels labels;
  SampleModel model;
  Surface surface;

  Hull(const Points& points, float x) : p(clouds::prepare(points)) {
    const std::size_t n = p.t.tetrahedra.size();
    clouds::HandMade made(n, x);
    for (TetrahedronIndex i{0}; i.value < n; ++i.value)
      if (!p.t.touches_cube(i)) made.set(i, Label::inside, x);
    labels = made.done();
    model = sample_model(std::span(p.t.positions.raw()).first(p.t.sample_count), std::nullopt, threads);
    surface = extract_surface(p.t, labels.labels(), Threads(2));
  }
  std::vector<float> support(std::span<const float> grid_spacing = {}) {
    measure_support(p.t, labels, model, grid_spacing, surface, threads);
    return surface.support;
  }
  [[nodiscard]] bool has_vertex(std::size_t triangle, const Vec3& place) const {
    for (const std::uint32_t v : surface.mesh.triangles[triangle])
      if (distance(surface.mesh.vertices[v] + p.t.origin, place) < 1e-9) return true;
    return false;
  }
};

TEST(Support, IsFullOnEvenSamples) {
  Hull hull(clouds::sphere(2000), 1);
  const std::vector<float> support = hull.support();
  ASSERT_EQ(support.size(), hull.surface.mesh.triangles.size());
  std::size_t full = 0;
  for (const float s : support) {
    EXPECT_TRUE(s >= 0 && s <= 1) << s;
    full += s > 0.9f;
  }
  EXPECT_GT(static_cast<double>(full), 0.98 * static_cast<double>(support.size()));
}

TEST(Support, IsHalvedWithoutContrast) {
  Hull hull(clouds::sphere(500), 1);
  const std::vector<float> full = hull.support();
  hull.labels = {hull.labels.labels(), IndexedArray<TetrahedronIndex, float>(hull.labels.size(), 0.0f)};
  const std::vector<float> none = hull.support();
  for (std::size_t i = 0; i < full.size(); ++i) EXPECT_FLOAT_EQ(none[i], full[i] / 2);
}

TEST(Support, GrowsWithContrastUpToOne) {
  // Values -x and x: contrast 2 x, which counts up to 1.
  Hull quarter(clouds::sphere(500), 0.25f), half(clouds::sphere(500), 0.5f), one(clouds::sphere(500), 1);
  const std::vector<float> a = quarter.support(), b = half.support(), c = one.support();
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_FLOAT_EQ(a[i], b[i] * 0.75f);
  EXPECT_EQ(b, c);
}

TEST(Support, IsLowOnTheSpikeOfAnIsolatedSample) {
  const Vec3 tip{0, 0, 2};
  Hull hull(clouds::joined(clouds::sphere(2000), {tip}), 1);
  const std::vector<float> support = hull.support();
  std::size_t spikes = 0;
  for (std::size_t i = 0; i < support.size(); ++i) {
    EXPECT_TRUE(support[i] >= 0 && support[i] <= 1) << support[i];
    if (!hull.has_vertex(i, tip)) continue;
    ++spikes;
    // From the tip to the sphere are more than 1.7 (its tangents); a spacing is about 3.5/√2000 = 0.08.
    EXPECT_LT(support[i], 2.5 * 0.11 / 1.7);
  }
  EXPECT_GE(spikes, 3u);
  // Noise as wide as the spike explains it: 2.5 · 1 > 2, the longest edge.
  const std::vector<float> grid_spacing(hull.p.t.sample_count, 1.0f);
  for (const float s : hull.support(grid_spacing)) EXPECT_FLOAT_EQ(s, 1);
}

TEST(Support, DoesNotDependOnThreads) {
  Hull hull(clouds::joined(clouds::sphere(2000), {{0, 0, 2}}), 0.4f);
  const std::vector<float> two = hull.support();
  const Threads one(1);
  measure_support(hull.p.t, hull.labels, hull.model, {}, hull.surface, one);
  EXPECT_EQ(hull.surface.support, two);
}

/// Spheres of 300 samples at (100, 0, 0) and of 80 at (0, 0, 0), each filled.
struct TwoPieces {
  Prepared p = clouds::prepare(clouds::joined(clouds::moved(clouds::sphere(300), {100, 0, 0}), clouds::sphere(80)));
  Labels labels;
  Surface surface;

  TwoPieces() {
    labels = Labels(p.t.tetrahedra.size(), Label::outside);
    for (TetrahedronIndex i{0}; i.value < labels.size(); ++i.value) {
      double longest = 0;
      for (const SampleIndex a : p.t.tetrahedra[i])
        for (const SampleIndex b : p.t.tetrahedra[i])
          longest = std::max(longest, distance(p.t.positions[a], p.t.positions[b]));
      if (longest < 10) labels[i] = Label::inside;
    }
    surface = extract_surface(p.t, labels, Threads(2));
    surface.support.assign(surface.mesh.triangles.size(), 1.0f);
  }
  [[nodiscard]] bool is_small(std::size_t triangle) const {
    return surface.mesh.vertices[surface.mesh.triangles[triangle][0]].x + p.t.origin.x < 50;
  }
  void set_small(float support) {
    for (std::size_t i = 0; i < surface.support.size(); ++i)
      if (is_small(i)) surface.support[i] = support;
  }
  std::vector<DroppedComponent> filter(const SampleModel& model = {}) {
    return filter_components(surface, {Kind::supported, 1}, p.t, model, labels, Threads(2));
  }
};

TEST(SupportedComponents, LowSupportIsDroppedAndListed) {
  TwoPieces pieces;
  pieces.set_small(0.375f);
  const std::vector<DroppedComponent> dropped = pieces.filter();
  ASSERT_EQ(dropped.size(), 1u);
  EXPECT_EQ(dropped[0].vertices, 80u);
  EXPECT_EQ(dropped[0].triangles, 2 * 80u - 4); // Euler: a sphere
  EXPECT_NEAR(dropped[0].support, 0.375, 1e-6);
  EXPECT_NEAR(norm(dropped[0].centre), 0, 0.1); // in input coordinates
  EXPECT_EQ(pieces.surface.mesh.vertices.size(), 300u);
  EXPECT_THAT(pieces.surface.support, testing::AllOf(testing::SizeIs(2 * 300 - 4), testing::Each(1.0f)));
}

TEST(SupportedComponents, EnoughSupportIsKept) {
  TwoPieces pieces;
  pieces.set_small(0.4375f);
  EXPECT_TRUE(pieces.filter().empty());
  EXPECT_EQ(pieces.surface.mesh.vertices.size(), 380u);
}

TEST(SupportedComponents, TheLargestStaysWithNoSupportAtAll) {
  TwoPieces pieces;
  std::fill(pieces.surface.support.begin(), pieces.surface.support.end(), 0.0f);
  EXPECT_EQ(pieces.filter().size(), 1u);
  EXPECT_EQ(pieces.surface.mesh.vertices.size(), 300u);
}

TEST(SupportedComponents, SupportIsTheMeanOverTheArea) {
  TwoPieces pieces;
  // The larger half of the triangles has none: the mean over the area is below that over the triangles, 0.375.
  std::vector<std::pair<double, std::size_t>> by_area;
  double whole = 0, supported = 0;
  for (std::size_t i = 0; i < pieces.surface.support.size(); ++i) {
    if (!pieces.is_small(i)) continue;
    const auto& [a, b, c] = pieces.surface.mesh.triangles[i];
    const auto& v = pieces.surface.mesh.vertices;
    by_area.emplace_back(norm(cross(v[b] - v[a], v[c] - v[a])) / 2, i);
    whole += by_area.back().first;
  }
  std::sort(by_area.begin(), by_area.end());
  for (std::size_t k = 0; k < by_area.size(); ++k) {
    pieces.surface.support[by_area[k].second] = k < by_area.size() / 2 ? 0.75f : 0.0f;
    if (k < by_area.size() / 2) supported += 0.75 * by_area[k].first;
  }
  ASSERT_LT(supported / whole, 0.37); // else area and number could not be told apart
  const std::vector<DroppedComponent> dropped = pieces.filter();
  ASSERT_EQ(dropped.size(), 1u);
  EXPECT_NEAR(dropped[0].support, supported / whole, 1e-9);
}

} // namespace
} // namespace eigencrust
