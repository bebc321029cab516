// SPDX-License-Identifier: GPL-3.0-or-later
#include <eigencrust/error.h>
#include <gmock/gmock.h>

#include "clouds.h"
#include "evidence/named_points.h"
#include "samples/sample_model.h"
#include "support.h"

namespace eigencrust {
namespace {

using clouds::Points;
using clouds::Prepared;

Labels known_of(const Tetrahedralization& t, const Points& outside, const Points& inside,
                std::optional<Axis> facade = {}, unsigned threads = 1) {
  return known_labels(t, vertex_stars(t, Threads(threads)), outside, inside,
                      facade ? Surroundings{SceneKind::facade, *facade, {}} : Surroundings{}, Threads(threads));
}

ErrorKind kind_of(const Tetrahedralization& t, const Points& outside, const Points& inside,
                  std::optional<Axis> facade = {}) {
  try {
    known_of(t, outside, inside, facade);
  } catch (const Error& error) {
    EXPECT_FALSE(error.remedy().empty());
    return error.kind();
  }
  return ErrorKind{};
}

/// The first tetrahedron whose vertices are samples.
TetrahedronIndex interior_tetrahedron(const Tetrahedralization& t) {
  TetrahedronIndex i{0};
  while (t.touches_cube(i)) ++i.value;
  return i;
}

/// Which tetrahedra away from the cube have the label.
std::vector<TetrahedronIndex> labelled(const Tetrahedralization& t, const Labels& labels, Label label) {
  std::vector<TetrahedronIndex> found;
  for (std::uint32_t i = 0; i < t.tetrahedra.size(); ++i)
    if (!t.touches_cube(TetrahedronIndex{i}) && labels.raw()[i] == label) found.push_back(TetrahedronIndex{i});
  return found;
}

/// Those of a star that are away from the cube.
std::vector<TetrahedronIndex> interior_star(const Prepared& p, SampleIndex s) {
  std::vector<TetrahedronIndex> found;
  for (const TetrahedronIndex t : p.stars[s])
    if (!p.t.touches_cube(t)) found.push_back(t);
  return found;
}

TEST(KnownLabels, TetrahedraAtTheCubeAreOutsideAndNoOthers) {
  const Prepared p = clouds::prepare(clouds::random_box(60, 1));
  const Labels labels = known_of(p.t, {}, {});
  for (std::uint32_t i = 0; i < p.t.tetrahedra.size(); ++i)
    EXPECT_EQ(labels.raw()[i], p.t.touches_cube(TetrahedronIndex{i}) ? Label::outside : Label::unlabelled);
}

TEST(KnownLabels, PointWithinATetrahedronNamesThatOne) {
  const Prepared p = clouds::prepare(clouds::moved(clouds::random_box(60, 2), {10, 20, 30}));
  const TetrahedronIndex i = interior_tetrahedron(p.t);
  const Vec3 middle = clouds::centroid(p.t, i) + p.t.origin; // input coordinates
  EXPECT_THAT(labelled(p.t, known_of(p.t, {middle}, {}), Label::outside), testing::ElementsAre(i));
  EXPECT_THAT(labelled(p.t, known_of(p.t, {}, {middle}), Label::inside), testing::ElementsAre(i));
  EXPECT_THAT(labelled(p.t, known_of(p.t, {}, {middle}, {}, 3), Label::inside), testing::ElementsAre(i));
}

TEST(KnownLabels, PointOnASampleNamesItsStar) {
  // A lattice: the box's middle is a sample, and no sample of the star is at the cube.
  const Prepared p = clouds::prepare(clouds::lattice(5, 5, 5));
  SampleIndex middle{0};
  while (p.t.positions[middle] != Vec3{0, 0, 0}) ++middle.value;
  const std::vector<TetrahedronIndex> star = interior_star(p, middle);
  EXPECT_EQ(star.size(), p.stars[middle].size());
  EXPECT_THAT(labelled(p.t, known_of(p.t, {}, {{2, 2, 2}}), Label::inside), testing::ElementsAreArray(star));
  EXPECT_THAT(labelled(p.t, known_of(p.t, {{2, 2, 2}}, {}), Label::outside), testing::ElementsAreArray(star));
}

TEST(KnownLabels, PointOnAFaceNamesBothSides) {
  // Corners at even integers keep midpoints of faces' edges exact; a point on an edge names its ring, and
  // every face of a lattice's Delaunay has dyadic coordinates.
  const Prepared p = clouds::prepare(clouds::lattice(5, 5, 5, 4.0));
  for (std::uint32_t i = 0; i < p.t.tetrahedra.size(); ++i) {
    const TetrahedronIndex self{i};
    if (p.t.touches_cube(self)) continue;
    const auto& v = p.t.tetrahedra[self];
    const TetrahedronIndex n = p.t.neighbours[self][3];
    if (!n.valid() || p.t.touches_cube(n)) continue;
    const Vec3 on_face = 0.5 * p.t.positions[v[0]] + 0.25 * p.t.positions[v[1]] + 0.25 * p.t.positions[v[2]];
    EXPECT_THAT(labelled(p.t, known_of(p.t, {}, {on_face + p.t.origin}), Label::inside),
                testing::UnorderedElementsAre(self, n));
    return;
  }
  FAIL() << "no face away from the cube";
}

TEST(KnownLabels, ContradictionsAreRefused) {
  const Prepared p = clouds::prepare(clouds::random_box(60, 3));
  const Vec3 middle = clouds::centroid(p.t, interior_tetrahedron(p.t)) + p.t.origin;
  EXPECT_EQ(kind_of(p.t, {middle}, {middle}), ErrorKind::usage);
  EXPECT_EQ(kind_of(p.t, {}, {{5, 5, 5}}), ErrorKind::usage);         // between the samples and the cube
  EXPECT_EQ(kind_of(p.t, {}, {{1e6, 0, 0}}), ErrorKind::usage);       // beyond the cube
  EXPECT_EQ(kind_of(p.t, {{1e6, 0, 0}, {5, 5, 5}}, {}), ErrorKind{}); // outside it is, and says nothing new
}

TEST(NamePoles, ThoseInWhoseBallsAPointLiesDeep) {
  const Prepared p = clouds::prepare(clouds::joined(clouds::sphere(800), clouds::sphere(300, 0.5)));
  const std::vector<Vec3> outside{{0, 0, 0}, {0.1, 0, 0}, {0, 0.3, 0.8}}, inside{{0.75, 0, 0}, {0.01, 0, 0}};
  Labels known = known_of(p.t, {}, {});
  const Labels before = known;
  name_poles(p.t, p.poles, outside, inside, Threads(2), known);
  std::size_t named_outside = 0, named_inside = 0, disputed = 0;
  for (PoleIndex i{0}; i.value < p.poles.tetrahedron.size(); ++i.value) {
    const Sphere& ball = p.poles.sphere[i];
    const auto holds = [&](const Vec3& q) { return distance(q - p.t.origin, ball.centre) < 0.5 * ball.radius; };
    const bool out = std::any_of(outside.begin(), outside.end(), holds);
    const bool in = std::any_of(inside.begin(), inside.end(), holds);
    const TetrahedronIndex at = p.poles.tetrahedron[i];
    if (before[at] != Label::unlabelled || out == in) {
      EXPECT_EQ(known[at], before[at]);
      disputed += out && in && before[at] == Label::unlabelled;
      continue;
    }
    EXPECT_EQ(known[at], out ? Label::outside : Label::inside);
    ++(out ? named_outside : named_inside);
  }
  EXPECT_GT(named_inside, 0u);
  EXPECT_GT(disputed, 0u); // the poles at the centre are named both
  Labels alone = before;
  name_poles(p.t, p.poles, {}, {}, Threads(1), alone);
  EXPECT_EQ(alone.raw(), before.raw());
}

TEST(KnownLabels, FacadeHasAFrontAndABack) {
  const Prepared p = clouds::prepare(clouds::random_box(60, 4));
  const std::vector<std::pair<Axis, Vec3>> axes{{Axis::plus_x, {1, 0, 0}}, {Axis::minus_x, {-1, 0, 0}},
                                                {Axis::plus_y, {0, 1, 0}}, {Axis::minus_y, {0, -1, 0}},
                                                {Axis::plus_z, {0, 0, 1}}, {Axis::minus_z, {0, 0, -1}}};
  for (const auto& [axis, direction] : axes) {
    const Labels labels = known_of(p.t, {}, {}, axis);
    std::size_t inside = 0;
    for (std::uint32_t i = 0; i < p.t.tetrahedra.size(); ++i) {
      bool front = false;
      for (const SampleIndex s : p.t.tetrahedra.raw()[i])
        front = front || (p.t.is_corner(s) && dot(direction, p.t.positions[s]) > 0);
      const Label expected = !p.t.touches_cube(TetrahedronIndex{i}) ? Label::unlabelled
                             : front                                ? Label::outside
                                                                    : Label::inside;
      EXPECT_EQ(labels.raw()[i], expected);
      inside += expected == Label::inside;
    }
    EXPECT_GT(inside, 0u);
  }
}

TEST(KnownLabels, FacadeRefusesAnOutsidePointBehindIt) {
  const Prepared p = clouds::prepare(clouds::random_box(60, 5));
  EXPECT_EQ(kind_of(p.t, {{0, 0, -20}}, {}, Axis::plus_z), ErrorKind::usage);
  EXPECT_EQ(kind_of(p.t, {{0, 0, 20}}, {{0, 0, -20}}, Axis::plus_z), ErrorKind{});
}

TEST(SampleModel, OnlyTheLonelySampleIsIsolated) {
  // A flat lattice of spacing 1 with one sample 10 above it: its neighbours are all about 10 away.
  clouds::Points points;
  for (int x = 0; x < 12; ++x)
    for (int y = 0; y < 12; ++y) points.push_back({static_cast<double>(x), static_cast<double>(y), 0});
  points.push_back({5.5, 5.5, 10});
  const clouds::Prepared p = clouds::prepare(points);
  const SampleModel model =
      sample_model(std::span(p.t.positions.raw()).first(p.t.sample_count), std::nullopt, Threads(2));
  const std::vector<float>& radius = model.isolated;
  ASSERT_EQ(radius.size(), points.size());
  ASSERT_EQ(model.spacing.size(), points.size());
  EXPECT_NEAR(model.typical_spacing, 1, 0.2); // at the rim twelve neighbours reach farther
  for (std::uint32_t i = 0; i < radius.size(); ++i) {
    const bool lonely = p.t.source.raw()[i] == points.size() - 1;
    // Twentieth neighbour of the lonely one: within the 32 lattice points at most sqrt(4.5² + 1.5²) off its foot.
    if (lonely)
      EXPECT_NEAR(radius[i], 10.3, 0.3);
    else
      EXPECT_EQ(radius[i], 0.0f);
  }
}

} // namespace
} // namespace eigencrust
