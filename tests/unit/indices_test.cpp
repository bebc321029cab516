// SPDX-License-Identifier: GPL-3.0-or-later
// A corner of the cube is a vertex and no sample: what only samples have cannot be asked of it.
#include <gtest/gtest.h>

#include <type_traits>

#include <eigencrust/eigencrust.h>
#include <eigencrust/error.h>

#include "clouds.h"
#include "samples/sample_model.h"

namespace eigencrust {
namespace {

template <class Array, class I>
concept TakesIndex = requires(const Array& array, I i) {
  array[i];
};

static_assert(std::is_convertible_v<SampleIndex, VertexIndex>, "a sample is a vertex");
static_assert(!std::is_convertible_v<VertexIndex, SampleIndex>, "a vertex may be a corner");
static_assert(!std::is_convertible_v<TetrahedronIndex, VertexIndex> && !std::is_convertible_v<PoleIndex, SampleIndex>);
static_assert(TakesIndex<SampleLengths, SampleIndex> && !TakesIndex<SampleLengths, VertexIndex>);
static_assert(TakesIndex<SampleLengthsView, SampleIndex> && !TakesIndex<SampleLengthsView, VertexIndex>);
static_assert(!TakesIndex<decltype(Poles::of_sample), VertexIndex> &&
              !TakesIndex<decltype(Tetrahedralization::source), VertexIndex>);
static_assert(TakesIndex<decltype(Tetrahedralization::positions), SampleIndex> && TakesIndex<VertexStars, SampleIndex>);
static_assert(!TakesIndex<decltype(SampleModel::isolated), std::size_t>, "nor of a number that may mean anything");

TEST(Indices, OfASampleAreThoseOfItsVertex) {
  const clouds::Prepared p = clouds::prepare(clouds::sphere(50));
  const SampleIndex s{7};
  const VertexIndex v = s;
  EXPECT_EQ(v.value, 7u);
  EXPECT_EQ(v, s);
  EXPECT_EQ(p.t.sample(v), s);
  EXPECT_FALSE(p.t.is_corner(v));
  EXPECT_TRUE(p.t.is_corner(VertexIndex{50}));
}

#ifndef NDEBUG
TEST(IndicesDeathTest, AreLookedAtInDebugBuilds) {
  const clouds::Prepared p = clouds::prepare(clouds::sphere(50));
  const SampleLengths lengths(50, 1.0f);
  EXPECT_DEATH((void)p.t.sample(VertexIndex{50}), "is_corner");
  EXPECT_DEATH((void)lengths[SampleIndex{50}], "size");
  EXPECT_DEATH((void)SampleLengthsView(lengths)[SampleIndex{50}], "size");
  EXPECT_DEATH((void)p.stars[VertexIndex{58}], "size");
}
#endif

// Nearly all tetrahedra of a few points have a corner of the cube, and behind a façade the surface may reach them. The
// sanitizers see what reads past the end, builds without NDEBUG each index that is none.
TEST(Indices, CornersBehindAFacadeAreAskedForNothing) {
  int meshes = 0;
  for (std::uint64_t seed = 1; seed <= 24; ++seed) {
    PointCloud cloud{clouds::random_box(8 + 3 * seed, seed), {}, {}};
    for (const Preset preset : {Preset::robust, Preset::paper}) {
      Options options = Options::of(preset);
      options.facade = static_cast<Axis>(seed % 6);
      options.components.kind = KeepComponents::Kind::all;
      options.trim = seed % 3 == 0;
      options.point_results = true;
      options.threads = 1;
      try {
        meshes += !reconstruct(cloud, options).mesh.triangles.empty();
      } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::no_surface) << error.what();
      }
    }
  }
  EXPECT_GT(meshes, 10);
}

} // namespace
} // namespace eigencrust
