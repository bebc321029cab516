// SPDX-License-Identifier: GPL-3.0-or-later
// Parts of the Delaunay tetrahedra, made each without most of the samples, are those of the whole.
#include "tetrahedra/tile.h"

#include <gmock/gmock.h>

#include <cmath>

#include "clouds.h"
#include "tetrahedra/assemble.h"

namespace eigencrust {
namespace {

using clouds::Points;

Tetrahedralization whole(const Points& points) {
  const Threads threads(1);
  return tetrahedralize(prepare_samples(points, threads), threads);
}

/// What a machine has that knows its own samples alone, and asks for others.
class FewSamples : public SampleSupply {
 public:
  FewSamples(const Tetrahedralization& all, const SampleRange& own)
      : all_(all), blocks(all.sample_count, sketches(all)) {
    for (std::uint32_t b = 0; b < blocks.block_count(); ++b)
      if (own.holds(blocks.samples_of(b).begin)) learn(b);
  }
  bool fetch(const std::vector<std::uint32_t>& wanted) override {
    EXPECT_TRUE(std::is_sorted(wanted.begin(), wanted.end()));
    for (const std::uint32_t b : wanted) {
      EXPECT_FALSE(blocks.knows(b));
      learn(b);
    }
    fetched += wanted.size();
    return !wanted.empty();
  }

 private:
  static std::vector<BlockSketch> sketches(const Tetrahedralization& all) {
    const SampleBlocks whole(samples_of(all), Threads(1));
    std::vector<BlockSketch> result;
    for (std::uint32_t b = 0; b < whole.block_count(); ++b) result.push_back(whole.sketch_of(b));
    return result;
  }
  void learn(std::uint32_t b) {
    const SampleRange range = blocks.samples_of(b);
    blocks.learn(b, samples_of(all_).subspan(range.begin, range.size()));
  }
  const Tetrahedralization& all_;

 public:
  SampleBlocks blocks;
  std::size_t fetched = 0;
};

/// The same from own samples and those that were asked for. \return the blocks that were
std::size_t expect_same_from_few(const Tetrahedralization& t, const SampleRange& range, const Tile& expected) {
  FewSamples few(t, range);
  const WatchGrowth watch;
  TileProgress progress(watch, range.size());
  const auto tile = make_tile(corners_of(t), few.blocks, range, progress, &few);
  if (!tile) {
    ADD_FAILURE() << "given up";
    return 0;
  }
  EXPECT_EQ(tile->tetrahedra, expected.tetrahedra);
  EXPECT_EQ(tile->neighbours, expected.neighbours);
  EXPECT_EQ(tile->open, expected.open);
  return few.fetched;
}

/// Every part, however small, has the tetrahedra of the whole, and knows which faces others have, too.
void expect_same_in_parts(const Tetrahedralization& t, std::uint32_t parts) {
  const SampleBlocks blocks(samples_of(t), Threads(1));
  const WatchGrowth watch;
  std::vector<std::array<VertexIndex, 4>> tetrahedra;
  std::vector<std::array<VertexIndex, 3>> open;
  for (std::uint32_t i = 0; i < parts; ++i) {
    // Of few parts the borders are those of blocks.
    const std::uint32_t step = t.sample_count / parts > 2 * SampleBlocks::block_size ? SampleBlocks::block_size : 1;
    const auto at = [&](std::uint64_t k) {
      const auto even = static_cast<std::uint32_t>(t.sample_count * k / parts);
      return k == parts ? even : even / step * step;
    };
    TileProgress progress(watch, t.sample_count);
    const auto tile = make_tile(corners_of(t), blocks, {at(i), at(i + 1)}, progress);
    ASSERT_TRUE(tile);
    const auto whole_blocks = [](std::uint32_t k) { return k % SampleBlocks::block_size == 0; };
    if (whole_blocks(at(i)) && (whole_blocks(at(i + 1)) || i + 1 == parts))
      expect_same_from_few(t, {at(i), at(i + 1)}, *tile);
    const auto first = static_cast<std::uint32_t>(tetrahedra.size());
    tetrahedra.insert(tetrahedra.end(), tile->tetrahedra.begin(), tile->tetrahedra.end());
    ASSERT_LE(tetrahedra.size(), t.tetrahedra.size());
    for (std::uint32_t k = 0; k < tile->neighbours.size(); ++k)
      for (std::size_t j = 0; j < 4; ++j) {
        const TetrahedronIndex n = tile->neighbours[k][j];
        if (n.valid()) {
          ASSERT_EQ(n.value + first, t.neighbours.raw()[k + first][j].value);
        }
      }
    for (const OpenFace& face : tile->open) {
      open.push_back(face.vertices);
      ASSERT_TRUE(t.neighbours.raw()[face.tetrahedron.value + first][face.corner].valid());
    }
  }
  EXPECT_EQ(tetrahedra, t.tetrahedra.raw());
  std::sort(open.begin(), open.end());
  ASSERT_EQ(open.size() % 2, 0u);
  for (std::size_t i = 0; i < open.size(); i += 2) EXPECT_EQ(open[i], open[i + 1]);
}

void expect_parts_fit(const Points& points) {
  const Tetrahedralization t = whole(points);
  for (const std::uint32_t parts : {2u, 3u, 7u, 40u}) {
    SCOPED_TRACE(std::to_string(parts) + " parts of " + std::to_string(t.sample_count));
    expect_same_in_parts(t, parts);
  }
}

/// About an axis oblique to all others.
Points turned(Points points) {
  const double c = std::cos(0.7), s = std::sin(0.7);
  for (Vec3& p : points) {
    p = {c * p.x - s * p.y, s * p.x + c * p.y, p.z};
    p = {p.x, c * p.y - s * p.z, s * p.y + c * p.z};
  }
  return points;
}

TEST(Tiles, OfRandomPoints) {
  for (const std::uint64_t seed : {1u, 2u, 3u}) expect_parts_fit(clouds::random_box(2000, seed));
}

TEST(Tiles, OfNoisySurfacesWithOutliers) {
  expect_parts_fit(
      clouds::joined(clouds::jittered(clouds::torus(1, 0.4, 60, 40), 0.02, 1), clouds::random_box(60, 2, 2)));
}

TEST(Tiles, OfAnExactGrid) { expect_parts_fit(clouds::lattice(11, 12, 13)); }

TEST(Tiles, OfAGridThatWasTurned) { expect_parts_fit(turned(clouds::lattice(11, 12, 13))); }

TEST(Tiles, OfACubesSurface) {
  expect_parts_fit(clouds::cube_surface(14));
  expect_parts_fit(turned(clouds::cube_surface(14)));
}

TEST(Tiles, OfTwoParallelPlanes) {
  // Spheres through both are empty over wide areas and touch four samples of each.
  expect_parts_fit(clouds::joined(clouds::lattice(30, 30, 1), clouds::moved(clouds::lattice(30, 30, 1), {0, 0, 7.5})));
}

TEST(Tiles, OfTwoCurvesThatSeeEachOther) {
  // Each sample of one is a neighbour of each of the other: as many tetrahedra as the square of the samples.
  Points points;
  for (int i = 0; i < 60; ++i) {
    points.push_back({i / 60.0, 0, 0});
    points.push_back({0, i / 60.0, 1});
  }
  expect_parts_fit(points);
}

TEST(Tiles, AskForFewSamplesOfOthers) {
  // Hills, of which each sphere above touches few.
  Points hills = clouds::jittered(clouds::lattice(200, 200, 1), 0.2, 1);
  for (Vec3& p : hills) p.z += 8 * std::sin(p.x / 9) * std::cos(p.y / 13 + p.x / 50);
  const Tetrahedralization t = whole(hills);
  const SampleBlocks blocks(samples_of(t), Threads(1));
  const WatchGrowth watch;
  for (const std::uint32_t begin : {0u, 8000u, 29952u}) {
    const SampleRange range{begin, begin + 10048};
    TileProgress progress(watch, range.size());
    const auto tile = make_tile(corners_of(t), blocks, range, progress);
    ASSERT_TRUE(tile);
    const std::size_t others = blocks.block_count() - range.size() / SampleBlocks::block_size;
    EXPECT_LT(expect_same_from_few(t, range, *tile), others * 6 / 10);
  }
}

TEST(Tiles, FarFromTheOriginAndOfDifferentDensity) {
  expect_parts_fit(clouds::joined(clouds::moved(clouds::random_box(1000, 4), {1e6, -1e6, 1e3}, 1e-3),
                                  clouds::moved(clouds::random_box(500, 5), {1e6, -1e6, 1e3}, 10)));
}

TEST(Tiles, AreGivenUpWhereAllSamplesLieOnOneSphere) {
  // Each sphere through four of them nearly touches all.
  const Tetrahedralization t = whole(clouds::sphere(20000));
  const SampleBlocks blocks(samples_of(t), Threads(1));
  const WatchGrowth watch;
  TileProgress progress(watch, t.sample_count);
  EXPECT_FALSE(make_tile(corners_of(t), blocks, {0, 10000}, progress));
  EXPECT_TRUE(progress.given_up());
  // Then the others need not go on, but one that knows all samples is certain of all.
  EXPECT_FALSE(make_tile(corners_of(t), blocks, {10000, 20000}, progress));
  EXPECT_TRUE(make_tile(corners_of(t), blocks, {0, 20000}, progress));
}

TEST(Tiles, AreOfUseWhereOneSampleIsFarAway) {
  // Spheres through it and three samples of the surface are nearly planes, with all of the surface on one side.
  Points points = clouds::jittered(clouds::sphere(20000), 0.01, 1);
  points.push_back({1e9, -3e8, 2e9});
  const Tetrahedralization t = whole(points);
  expect_same_in_parts(t, 2);
}

TEST(Tiles, TellHowFarTheyHaveCome) {
  const Tetrahedralization t = whole(clouds::random_box(3000, 6));
  const SampleBlocks blocks(samples_of(t), Threads(1));
  double fraction = 0;
  std::uint64_t tetrahedra = 0;
  const WatchGrowth watch = [&](double done, std::uint64_t count) {
    EXPECT_GE(done, fraction);
    EXPECT_LE(done, 1);
    fraction = done;
    tetrahedra = count;
  };
  TileProgress progress(watch, t.sample_count);
  for (const SampleRange& range : {SampleRange{0, 1500}, SampleRange{1500, 3000}})
    EXPECT_TRUE(make_tile(corners_of(t), blocks, range, progress));
  EXPECT_EQ(fraction, 1);
  EXPECT_GE(tetrahedra, t.tetrahedra.size()); // those beyond the cube, and what both tiles have
  const WatchGrowth refuse = [](double, std::uint64_t) { throw std::runtime_error("enough"); };
  TileProgress refused(refuse, t.sample_count);
  EXPECT_THROW(make_tile(corners_of(t), blocks, {0, 1500}, refused), std::runtime_error);
}

TEST(Tiles, AreTheSameForAnyNumberOfThreads) {
  // Large enough for more than one.
  for (const Points& points : {clouds::random_box(60000, 7), clouds::sphere(40000), clouds::lattice(36, 36, 36)}) {
    const Tetrahedralization one = whole(points);
    for (const unsigned count : {2u, 3u}) {
      const Threads threads(count);
      const Tetrahedralization t = tetrahedralize(prepare_samples(points, threads), threads);
      EXPECT_EQ(t.tetrahedra.raw(), one.tetrahedra.raw());
      EXPECT_EQ(t.neighbours.raw(), one.neighbours.raw());
    }
  }
}

TEST(SampleBlocks, FindTheDeepestOutsideARange) {
  for (const std::size_t count : {1u, 9u, 500u, 5000u}) {
    const Threads threads(1);
    const auto samples =
        prepare_samples(clouds::joined(clouds::random_box(count, 8), clouds::lattice(2, 2, 2)), threads);
    const auto& positions = samples.positions.raw();
    const auto n = static_cast<std::uint32_t>(positions.size());
    const SampleBlocks blocks(positions, threads);
    clouds::Random random(9);
    for (int k = 0; k < 300; ++k) {
      // Small ones, ones that hold all, and ones so large that they are planes.
      const Vec3 centre = (k % 3 == 0 ? 0.2 : k % 3 == 1 ? 4 : 1e12) * random.in_box(1);
      const Circumsphere sphere{random.in_box(1.5), centre, 0};
      const SampleRange left_out{n * static_cast<std::uint32_t>(k) / 600, n - n * static_cast<std::uint32_t>(k) / 700};
      std::optional<std::uint32_t> expected;
      for (std::uint32_t s = 0; s < n; ++s) {
        const double power = sphere.power(positions[s]).value;
        if (!left_out.holds(s) && s % 2 == 0 && power <= 0 &&
            (!expected || power < sphere.power(positions[*expected]).value))
          expected = s;
      }
      std::uint64_t looks = 0;
      const auto even = [](std::uint32_t s, const Power&) { return s % 2 == 0; };
      const auto never = [](std::uint32_t) { ADD_FAILURE() << "all blocks are known"; };
      EXPECT_EQ(blocks.deepest(sphere, left_out, looks, even, never), expected);
    }
  }
}

TEST(SampleBlocks, KnowHowFarOthersAre) {
  const Threads threads(1);
  const auto samples = prepare_samples(clouds::random_box(1000, 10), threads);
  const auto& positions = samples.positions.raw();
  const SampleBlocks blocks(positions, threads);
  const SampleRange own{300, 640};
  for (std::uint32_t b = 0; b * SampleBlocks::block_size < 1000; ++b) {
    const Box3 box = blocks.box_of_block(b);
    Box3 expected_box;
    for (std::uint32_t s = b * SampleBlocks::block_size; s < std::min(1000u, (b + 1) * SampleBlocks::block_size); ++s)
      expected_box.add(positions[s]);
    EXPECT_EQ(box.min, expected_box.min);
    EXPECT_EQ(box.max, expected_box.max);
    double expected = std::numeric_limits<double>::infinity();
    for (std::uint32_t s = 0; s < 1000; ++s) {
      if (own.holds(s)) continue;
      const Vec3& p = positions[s];
      const Vec3 nearest{std::clamp(p.x, box.min.x, box.max.x), std::clamp(p.y, box.min.y, box.max.y),
                         std::clamp(p.z, box.min.z, box.max.z)};
      expected = std::min(expected, distance(p, nearest));
    }
    EXPECT_NEAR(blocks.distance_to_others(box, own), expected, 1e-12);
  }
  EXPECT_EQ(blocks.distance_to_others(blocks.box_of_block(0), {0, 1000}), std::numeric_limits<double>::infinity());
}

} // namespace
} // namespace eigencrust
