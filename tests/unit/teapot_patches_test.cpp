// SPDX-License-Identifier: GPL-3.0-or-later
// Bézier patches: the reader, the evaluation and what the teapot is known to be.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <set>

#include <eigencrust/error.h>

#include "bezier_patches.h"
#include "support.h"

namespace eigencrust::tools {
namespace {

BezierPatches teapot() { return read_bezier_patches(source_folder() / "examples" / "teapot_patches.txt"); }

/// De Casteljau's scheme: the other way to evaluate.
Vec3 de_casteljau(std::array<Vec3, 4> p, double t) {
  for (std::size_t n = 3; n > 0; --n)
    for (std::size_t i = 0; i < n; ++i) p[i] = (1 - t) * p[i] + t * p[i + 1];
  return p[0];
}

TEST(TeapotPatches, PublishedCounts) {
  const BezierPatches patches = teapot();
  EXPECT_EQ(patches.patches.size(), 32u);
  EXPECT_EQ(patches.control_points.size(), 306u);
}

TEST(TeapotPatches, CornersOfAPatchAreItsCornerControlPoints) {
  const BezierPatches patches = teapot();
  for (std::size_t p = 0; p < 32; ++p) {
    const auto& index = patches.patches[p];
    EXPECT_EQ(bezier_position(patches, p, 0, 0, 7), patches.control_points[index[0]]);
    EXPECT_EQ(bezier_position(patches, p, 0, 7, 7), patches.control_points[index[3]]);
    EXPECT_EQ(bezier_position(patches, p, 7, 0, 7), patches.control_points[index[12]]);
    EXPECT_EQ(bezier_position(patches, p, 7, 7, 7), patches.control_points[index[15]]);
  }
}

TEST(TeapotPatches, PositionsAgreeWithDeCasteljau) {
  const BezierPatches patches = teapot();
  for (std::size_t p = 0; p < 32; ++p)
    for (const std::uint32_t i : {0u, 3u, 10u})
      for (const std::uint32_t j : {1u, 5u, 8u}) {
        std::array<Vec3, 4> column;
        for (std::size_t row = 0; row < 4; ++row) {
          std::array<Vec3, 4> points;
          for (std::size_t k = 0; k < 4; ++k) points[k] = patches.control_points[patches.patches[p][4 * row + k]];
          column[row] = de_casteljau(points, j / 10.0);
        }
        EXPECT_LT(distance(bezier_position(patches, p, i, j, 10), de_casteljau(column, i / 10.0)), 1e-14);
      }
}

TEST(TeapotPatches, BoundingBoxIsNewells) {
  Box3 box;
  for (const Vec3& p : tessellate(teapot(), 64).vertices) box.add(p);
  // Handle -3, body radius 2, bottom 0, top of the knob 3.15 are control points on the surface.
  EXPECT_EQ(box.min, (Vec3{-3, -2, 0}));
  EXPECT_DOUBLE_EQ(box.max.y, 2);
  EXPECT_DOUBLE_EQ(box.max.z, 3.15);
  // The tip of the spout is the maximum of the cubic with x = 3.3, 3.525, 3.45, 3.2.
  double tip = 0;
  for (int i = 0; i <= 10000; ++i) {
    const double t = i / 10000.0, s = 1 - t;
    tip = std::max(tip, 3.3 * s * s * s + 3 * 3.525 * s * s * t + 3 * 3.45 * s * t * t + 3.2 * t * t * t);
  }
  EXPECT_NEAR(box.max.x, tip, 1e-4);
}

TEST(TeapotPatches, GapBetweenRimAndLidIsOpen) {
  const BezierPatches patches = teapot();
  // At z = 2.4 the rim begins at radius 1.4 (patch 1) and the lid ends at radius 1.3 (patch 25).
  EXPECT_EQ(bezier_position(patches, 0, 0, 0, 8), (Vec3{1.4, 0, 2.4}));
  EXPECT_EQ(bezier_position(patches, 24, 8, 0, 8), (Vec3{1.3, 0, 2.4}));
}

TEST(TeapotPatches, NeighboursShareBoundaryPointsBitForBit) {
  const BezierPatches patches = teapot();
  // Patches 5 to 8 are the four quarters of the upper body, one after another around the axis.
  for (std::size_t quarter = 4; quarter < 8; ++quarter)
    for (std::uint32_t i = 0; i <= 13; ++i)
      EXPECT_EQ(bezier_position(patches, quarter, i, 13, 13),
                bezier_position(patches, quarter == 7 ? 4 : quarter + 1, i, 0, 13));
}

TEST(BezierPatches, ReversedPatchGivesTheSamePointsBitForBit) {
  BezierPatches patches = teapot();
  for (std::size_t p = 0; p < 32; ++p) {
    auto reversed = patches.patches[p];
    std::reverse(reversed.begin(), reversed.end());
    patches.patches.push_back(reversed);
  }
  for (std::size_t p = 0; p < 32; ++p)
    for (std::uint32_t k = 0; k <= 11; ++k) {
      EXPECT_EQ(bezier_position(patches, p, 0, k, 11), bezier_position(patches, p + 32, 11, 11 - k, 11));
      EXPECT_EQ(bezier_position(patches, p, k, 0, 11), bezier_position(patches, p + 32, 11 - k, 11, 11));
    }
}

TEST(TeapotPatches, TrianglesThatCollapseInPolesAreLeftOut) {
  // Eight patches (knob and bottom) have one side in one point: n triangles each are nothing.
  const TriangleMesh mesh = tessellate(teapot(), 10);
  EXPECT_EQ(mesh.triangles.size(), 32u * 200 - 8 * 10);
  for (const auto& [a, b, c] : mesh.triangles)
    EXPECT_GT(norm(cross(mesh.vertices[b] - mesh.vertices[a], mesh.vertices[c] - mesh.vertices[a])), 0);
}

TEST(TeapotPatches, FrontFacesPointOutOfTheBody) {
  const std::uint32_t n = 8;
  const TriangleMesh mesh = tessellate(teapot(), n);
  std::size_t checked = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const std::size_t patch = a / ((n + 1) * (n + 1));
    if (patch < 4 || patch >= 12) continue; // 5 to 12: the body, around the z axis
    const Vec3 p = mesh.vertices[a];
    EXPECT_GT(dot(cross(mesh.vertices[b] - p, mesh.vertices[c] - p), {p.x, p.y, 0}), 0);
    ++checked;
  }
  EXPECT_EQ(checked, 8u * 2 * n * n);
}

TEST(TeapotPatches, SubdivisionsOutOfRangeAreRefused) {
  EXPECT_THROW(tessellate(teapot(), 0), Error);
  EXPECT_THROW(tessellate(teapot(), 1025), Error);
}

TEST(OuterPart, LosesWhatLiesInside) {
  // A small tetrahedron inside a large one, both outward.
  TriangleMesh mesh;
  for (const double size : {1.0, 0.2}) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const Vec3& p : {Vec3{1, 1, 1}, Vec3{1, -1, -1}, Vec3{-1, 1, -1}, Vec3{-1, -1, 1}})
      mesh.vertices.push_back(size * p);
    for (const auto& [a, b, c] : {std::array{0u, 1u, 2u}, {0u, 3u, 1u}, {0u, 2u, 3u}, {1u, 3u, 2u}})
      mesh.triangles.push_back({first + a, first + b, first + c});
  }
  const TriangleMesh outer = outer_part(mesh);
  ASSERT_EQ(outer.triangles.size(), 4u);
  for (const auto& triangle : outer.triangles)
    for (const std::uint32_t v : triangle) EXPECT_LT(v, 4u);
}

// ---- malformed files ----

constexpr const char* one_patch = "1,2,3,4,1,2,3,4,1,2,3,4,1,2,3,4";

/// Place and cause of the error that reading `text` gives; empty if it is read.
std::string error_of(const std::string& text) {
  const TempDir folder;
  std::ofstream(folder / "p.txt", std::ios::binary) << text;
  try {
    read_bezier_patches(folder / "p.txt");
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), ErrorKind::input);
    return std::filesystem::path(e.place()).filename().string() + " " + e.cause();
  }
  return "";
}

TEST(BezierPatchesFile, CommentsBlanksAndCarriageReturnsAreFine) {
  EXPECT_EQ(error_of("# title\r\n1 # one\r\n\r\n" + std::string(one_patch) +
                     "\r\n4\r\n0 0 0\r\n1,0,0\r\n1, 1, 0\r\n0\t1\t1e-3"),
            "");
}

TEST(BezierPatchesFile, EveryDefectIsNamedWithItsLine) {
  using ::testing::StartsWith;
  const std::string patch = one_patch, points = "\n4\n0,0,0\n1,0,0\n1,1,0\n0,1,0\n";
  EXPECT_THAT(error_of(""), StartsWith("p.txt:1 the file ends"));
  EXPECT_THAT(error_of("x\n"), StartsWith("p.txt:1 expected 1 number"));
  EXPECT_THAT(error_of("0\n"), StartsWith("p.txt:1 there are no patches"));
  EXPECT_THAT(error_of("-1\n"), StartsWith("p.txt:1 expected 1"));
  EXPECT_THAT(error_of("1\n1,2,3\n"), StartsWith("p.txt:2 expected 16 indices"));
  EXPECT_THAT(error_of("1\n" + patch + ",4\n"), StartsWith("p.txt:2 expected 16 indices"));
  EXPECT_THAT(error_of("1\n1.5" + patch.substr(1) + points), StartsWith("p.txt:2 expected 16 indices"));
  EXPECT_THAT(error_of("1\n0" + patch.substr(1) + points), StartsWith("p.txt:2 index 0 is not within 1 to 4"));
  EXPECT_THAT(error_of("1\n5" + patch.substr(1) + points), StartsWith("p.txt:2 index 5 is not within 1 to 4"));
  EXPECT_THAT(error_of("1\n" + patch + "\n4\n0,0,0\n1,0\n"), StartsWith("p.txt:5 expected 3 coordinates"));
  EXPECT_THAT(error_of("1\n" + patch + "\n4\n0,0,nan\n"), StartsWith("p.txt:4 a coordinate is not finite"));
  EXPECT_THAT(error_of("1\n" + patch + "\n4\n0,0,0\n"), StartsWith("p.txt:4 the file ends"));
  EXPECT_THAT(error_of("1\n" + patch + points + "7\n"), StartsWith("p.txt:8 more lines"));
  // A count that the file does not hold must cost no memory.
  EXPECT_THAT(error_of("4294967295\n" + patch + "\n"), StartsWith("p.txt:2 the file ends"));
}

TEST(BezierPatchesFile, MissingFile) {
  const TempDir folder;
  EXPECT_THROW(read_bezier_patches(folder / "nothing.txt"), Error);
}

} // namespace
} // namespace eigencrust::tools
