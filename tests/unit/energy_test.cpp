// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>

#include "clouds.h"
#include "settle/minimum_energy.h"
#include "tetrahedra/circumsphere.h"

namespace eigencrust {
namespace {

using clouds::Points;
using clouds::Prepared;

std::array<VertexIndex, 3> face_of(const Tetrahedralization& t, TetrahedronIndex i, std::size_t k) {
  const auto& v = t.tetrahedra[i];
  return {v[(k + 1) % 4], v[(k + 2) % 4], v[(k + 3) % 4]};
}
double cosine_by_hand(const Tetrahedralization& t, TetrahedronIndex at, const std::array<VertexIndex, 3>& face) {
  const auto& v = t.tetrahedra[at];
  const Vec3 c = circumcentre(t.positions[v[0]], t.positions[v[1]], t.positions[v[2]], t.positions[v[3]]);
  const Vec3& a = t.positions[face[0]];
  Vec3 n = cross(t.positions[face[1]] - a, t.positions[face[2]] - a);
  n = (1 / norm(n)) * n;
  if (dot(n, clouds::centroid(t, at) - a) < 0) n = -1 * n;
  return dot(n, c - a) / distance(c, t.positions[v[0]]);
}
double beta_by_hand(const Tetrahedralization& t, TetrahedronIndex i, std::size_t k) {
  const auto face = face_of(t, i, k);
  return 0.01 + 1 - std::min(cosine_by_hand(t, i, face), cosine_by_hand(t, t.neighbours[i][k], face));
}

TEST(FaceWeights, AreTheBetaSkeletonMeasure) {
  for (const Points& points : {clouds::random_box(80, 3), clouds::sphere(200)}) {
    const Prepared p = clouds::prepare(points);
    const FaceWeights faces(p.t, {}, Threads(2));
    for (TetrahedronIndex i{0}; i.value < p.t.tetrahedra.size(); ++i.value)
      for (std::size_t k = 0; k < 4; ++k) {
        const TetrahedronIndex n = p.t.neighbours[i][k];
        if (!n.valid()) continue;
        const auto weight = static_cast<double>(faces(i, k));
        EXPECT_GE(weight, 0.0099);
        EXPECT_LE(weight, 2.0101);
        EXPECT_NEAR(weight, beta_by_hand(p.t, i, k), 1e-3);
        for (std::size_t j = 0; j < 4; ++j)
          if (p.t.neighbours[n][j] == i) {
            EXPECT_EQ(faces(n, j), faces(i, k));
          }
      }
  }
}

TEST(FaceWeights, AreOneMoreWithAnIsolatedSample) {
  const Prepared p = clouds::prepare(clouds::random_box(80, 3));
  SampleLengths isolated(p.t.sample_count, 0.0f);
  isolated[SampleIndex{5}] = 2.5f;
  const FaceWeights faces(p.t, isolated, Threads(1)), without(p.t, {}, Threads(1));
  std::size_t with = 0;
  for (TetrahedronIndex i{0}; i.value < p.t.tetrahedra.size(); ++i.value)
    for (std::size_t k = 0; k < 4; ++k) {
      std::size_t j = 0;
      while (j < 4 && !(p.t.tetrahedra[i][j] == SampleIndex{5})) ++j;
      const bool costs_more = j < 4 && j != k;
      with += costs_more;
      EXPECT_NEAR(faces(i, k), without(i, k) + (costs_more ? FaceWeights::cost_of_isolated : 0), 2e-4);
    }
  EXPECT_GT(with, 20u);
}

TEST(FaceWeights, FlatTetrahedraHaveNoSay) {
  // Turned lattices have them where four samples lie on a circle but for rounding.
  Points points = clouds::cube_surface(6);
  for (Vec3& p : points)
    p = {0.6 * p.x - 0.8 * p.y, 0.48 * p.x + 0.36 * p.y - 0.8 * p.z, 0.64 * p.x + 0.48 * p.y + 0.6 * p.z};
  const Prepared p = clouds::prepare(points);
  const FaceWeights faces(p.t, {}, Threads(1));
  const auto thickness = [&](TetrahedronIndex i) {
    const auto& v = p.t.tetrahedra[i];
    const Vec3 o = p.t.positions[v[0]];
    return std::fabs(dot(cross(p.t.positions[v[1]] - o, p.t.positions[v[2]] - o), p.t.positions[v[3]] - o));
  };
  std::size_t flat = 0;
  for (TetrahedronIndex i{0}; i.value < p.t.tetrahedra.size(); ++i.value) {
    if (p.t.touches_cube(i) || thickness(i) > 1e-6) continue;
    ++flat;
    for (std::size_t k = 0; k < 4; ++k) {
      const TetrahedronIndex n = p.t.neighbours[i][k];
      if (thickness(n) > 1e-6) {
        EXPECT_NEAR(faces(i, k), 1.01 - cosine_by_hand(p.t, n, face_of(p.t, i, k)), 1e-3);
      }
    }
  }
  EXPECT_GT(flat, 20u);
}

/// Random costs on a small cloud; what is at the cube is known.
Energy random_energy(const Prepared& p, std::uint64_t seed, double largest) {
  clouds::Random random(seed);
  Energy energy{FaceWeights(p.t, {}, Threads(1)), IndexedArray<TetrahedronIndex, float>(p.t.tetrahedra.size()), p.known,
                0};
  for (TetrahedronIndex i{0}; i.value < p.t.tetrahedra.size(); ++i.value)
    if (p.known[i] == Label::unlabelled) energy.data[i] = static_cast<float>(random.uniform(-largest, largest));
  return energy;
}

Labels random_labels(const Prepared& p, clouds::Random& random) {
  Labels labels = p.known;
  for (TetrahedronIndex i{0}; i.value < labels.size(); ++i.value)
    if (labels[i] == Label::unlabelled) labels[i] = random.below(2) == 0 ? Label::inside : Label::outside;
  return labels;
}

TEST(Energy, ChangeIsTheDifference) {
  const Prepared p = clouds::prepare(clouds::random_box(60, 8));
  const Energy energy = random_energy(p, 9, 2);
  clouds::Random random(10);
  for (int trial = 0; trial < 50; ++trial) {
    Labels labels = random_labels(p, random);
    const double before = energy.of(p.t, labels, Threads(2));
    std::vector<TetrahedronIndex> turned;
    for (TetrahedronIndex i{0}; i.value < labels.size(); ++i.value)
      if (p.known[i] == Label::unlabelled && random.below(6) == 0) turned.push_back(i);
    const double change = energy.change(p.t, labels, turned);
    for (const TetrahedronIndex i : turned) labels[i] = labels[i] == Label::outside ? Label::inside : Label::outside;
    EXPECT_NEAR(energy.of(p.t, labels, Threads(2)), before + change, 1e-6);
  }
}

TEST(Energy, BalanceSaysWhatTurningOneCosts) {
  const Prepared p = clouds::prepare(clouds::random_box(60, 18));
  const Energy energy = random_energy(p, 19, 2);
  clouds::Random random(20);
  const Labels labels = random_labels(p, random);
  for (TetrahedronIndex i{0}; i.value < labels.size(); ++i.value) {
    const float balance = energy.balance(p.t, labels, i);
    EXPECT_GE(balance, -1);
    EXPECT_LE(balance, 1);
    const double cost = energy.change(p.t, labels, std::array{i});
    if (std::fabs(cost) > 1e-5) {
      EXPECT_EQ(cost > 0, (balance > 0) == (labels[i] == Label::outside));
    }
  }
}

TEST(MinimumEnergy, IsThatOfAllLabelsOfATinyCloud) {
  int compared = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const Prepared p = clouds::prepare(clouds::random_box(8, seed));
    std::vector<TetrahedronIndex> open;
    for (TetrahedronIndex i{0}; i.value < p.known.size(); ++i.value)
      if (p.known[i] == Label::unlabelled) open.push_back(i);
    if (open.empty() || open.size() > 14) continue;
    ++compared;
    const Energy energy = random_energy(p, seed, 3);
    const MinimumLabels minimum = minimum_of(p.t, energy, Threads(1));
    double least = 1e300;
    Labels labels = p.known;
    for (std::uint32_t bits = 0; bits < 1u << open.size(); ++bits) {
      for (std::size_t k = 0; k < open.size(); ++k)
        labels[open[k]] = (bits >> k & 1u) != 0 ? Label::inside : Label::outside;
      least = std::min(least, energy.of(p.t, labels, Threads(1)));
    }
    EXPECT_NEAR(minimum.energy, least, 0.01) << "seed " << seed; // capacities are thousandths
    EXPECT_EQ(minimum.energy, energy.of(p.t, minimum.labels.labels(), Threads(1)));
  }
  EXPECT_GE(compared, 20);
}

TEST(MinimumEnergy, NoMoveOfOneOrTwoTetrahedraMakesItLess) {
  const Prepared p = clouds::prepare(clouds::random_box(2000, 31));
  const Energy energy = random_energy(p, 32, 2);
  const MinimumLabels minimum = minimum_of(p.t, energy, Threads(2));
  const Labels& labels = minimum.labels.labels();
  EXPECT_GT(minimum.undecided, 100u);
  for (TetrahedronIndex i{0}; i.value < labels.size(); ++i.value) {
    if (p.known[i] != Label::unlabelled) {
      EXPECT_EQ(labels[i], p.known[i]);
      continue;
    }
    EXPECT_GT(energy.change(p.t, labels, std::array{i}), -0.02);
    for (const TetrahedronIndex n : p.t.neighbours[i])
      if (n.valid() && p.known[n] == Label::unlabelled) {
        EXPECT_GT(energy.change(p.t, labels, std::array{i, n}), -0.02);
      }
  }
  const MinimumLabels again = minimum_of(p.t, energy, Threads(3));
  EXPECT_EQ(labels.raw(), again.labels.labels().raw());
  EXPECT_EQ(minimum.labels.values().raw(), again.labels.values().raw());
}

/// Labels of the truth, and full trust in them.
PoleLabels true_labels(const Prepared& p) {
  PoleLabels labels{p.known, IndexedArray<TetrahedronIndex, std::uint8_t>(p.known.size(), 255)};
  for (const TetrahedronIndex i : p.poles.tetrahedron)
    if (labels.labels[i] == Label::unlabelled)
      labels.labels[i] = norm(clouds::centroid(p.t, i) + p.t.origin) < 1 ? Label::inside : Label::outside;
  return labels;
}

/// All that the samples of a sphere say when its poles are labelled by the truth.
TEST(DataTerms, TiesPointToTheTrueSide) {
  const Prepared p = clouds::prepare(clouds::sphere(2000));
  const PoleLabels labels = true_labels(p);
  const SampleModel model = sample_model(std::span(p.t.positions.raw()).first(p.t.sample_count), 0.0, Threads(1));
  const NoisePlanes planes(p.t, p.poles, labels.labels, model, Threads(1));
  const DataTerms data(p.t, p.poles, labels, planes, {}, nullptr);
  std::size_t right = 0, wrong = 0;
  for (TetrahedronIndex i{0}; i.value < p.known.size(); ++i.value) {
    if (p.known[i] != Label::unlabelled) continue;
    const DataTerm term = data(i);
    const double depth = norm(clouds::centroid(p.t, i) + p.t.origin);
    if (depth < 0.9) ++(term.inside > term.outside ? right : wrong);
  }
  EXPECT_GT(right, 50u);
  EXPECT_EQ(wrong, 0u);

  // Without trust in the poles the ties say nothing; nor do isolated samples, but for their poles themselves.
  PoleLabels distrusted = labels;
  std::fill(distrusted.trust.raw().begin(), distrusted.trust.raw().end(), std::uint8_t{0});
  const DataTerms silent(p.t, p.poles, distrusted, planes, {}, nullptr);
  const SampleLengths isolated(p.t.sample_count, 1.0f);
  const DataTerms alone(p.t, p.poles, labels, planes, isolated, nullptr);
  for (TetrahedronIndex i{0}; i.value < p.known.size(); ++i.value) {
    EXPECT_EQ(silent(i).inside + silent(i).outside, 0);
    if (labels.labels[i] == Label::unlabelled) {
      EXPECT_EQ(alone(i).inside + alone(i).outside, 0);
    } else {
      EXPECT_GT(labels.labels[i] == Label::outside ? alone(i).outside : alone(i).inside, 2);
    }
  }
}

TEST(DataTerms, ASampleWithBothPolesOnOneSideTiesNothing) {
  const Prepared p = clouds::prepare(clouds::sphere(500));
  PoleLabels labels = true_labels(p);
  const SampleModel model = sample_model(std::span(p.t.positions.raw()).first(p.t.sample_count), 0.0, Threads(1));
  const NoisePlanes planes(p.t, p.poles, labels.labels, model, Threads(1));
  const auto term_of = [&](TetrahedronIndex i) { return DataTerms(p.t, p.poles, labels, planes, {}, nullptr)(i); };
  TetrahedronIndex deep;
  for (const PolePair& pair : p.poles.of_sample)
    for (const PoleIndex pole : {pair.first, pair.second})
      if (labels.labels[p.poles.tetrahedron[pole]] == Label::inside) deep = p.poles.tetrahedron[pole];
  ASSERT_TRUE(deep.valid());
  const float before = term_of(deep).inside;
  EXPECT_GT(before, strongest_tie);
  for (const TetrahedronIndex i : p.poles.tetrahedron) labels.labels[i] = Label::inside;
  EXPECT_FLOAT_EQ(term_of(deep).inside, static_cast<float>(strongest_tie / 2));
  EXPECT_EQ(term_of(deep).outside, 0);
}

TEST(DataTerms, LinesOfSightCount) {
  const Prepared p = clouds::prepare(clouds::sphere(300));
  const PoleLabels labels{p.known, IndexedArray<TetrahedronIndex, std::uint8_t>(p.known.size(), 0)};
  const SampleModel model = sample_model(std::span(p.t.positions.raw()).first(p.t.sample_count), 0.0, Threads(1));
  const NoisePlanes planes(p.t, p.poles, labels.labels, model, Threads(1));
  SightLabels sight;
  sight.front = sight.behind = IndexedArray<TetrahedronIndex, std::uint8_t>(p.known.size());
  const SampleLengths isolated(p.t.sample_count, 1.0f); // nothing else speaks
  const DataTerms data(p.t, p.poles, labels, planes, isolated, &sight);
  const TetrahedronIndex i{static_cast<std::uint32_t>(p.known.size() / 2)};
  EXPECT_EQ(data(i).outside, 0);
  sight.front[i] = 1;
  const float one = data(i).outside;
  EXPECT_GT(one, 0);
  sight.front[i] = 2;
  EXPECT_FLOAT_EQ(data(i).outside, 2 * one);
  sight.front[i] = 200;
  EXPECT_FLOAT_EQ(data(i).outside, 200 * one);
  sight.behind[i] = 3;
  EXPECT_GT(data(i).inside, 0);
}

} // namespace
} // namespace eigencrust
