// SPDX-License-Identifier: GPL-3.0-or-later
#include <eigencrust/stages.h>
#include <eigencrust/validate.h>
#include <gmock/gmock.h>

#include "shapes.h"

namespace eigencrust {
namespace {

double volume(const TriangleMesh& mesh) { return validate(mesh, {.self_intersections = false}).volume; }

TEST(Smoothing, APlaneStaysAPlaneAndItsRimStays) {
  for (const Smoothing method : {Smoothing::laplacian, Smoothing::taubin}) {
    const TriangleMesh before = shapes::grid(8, 6);
    TriangleMesh mesh = before;
    smooth(mesh, method, 5, Threads(2));
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
      const Vec3 &p = mesh.vertices[v], &old = before.vertices[v];
      EXPECT_EQ(p.z, 0);
      EXPECT_NEAR(distance(p, old), 0, 1e-12); // inner vertices are the centroids of their six neighbours
      if (old.x == 0 || old.x == 8 || old.y == 0 || old.y == 6) {
        EXPECT_EQ(p, old);
      }
    }
    EXPECT_EQ(mesh.triangles, before.triangles);
  }
}

TEST(Smoothing, OneLaplacianStepMovesToTheCentroid) {
  // The tip of a pyramid over a square: its neighbours are the four corners of the base.
  TriangleMesh mesh{{{0, 0, 3}, {1, 1, 0}, {-1, 1, 0}, {-1, -1, 0}, {1, -1, 0}},
                    {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 1}},
                    {},
                    {}};
  smooth(mesh, Smoothing::laplacian, 1, Threads(1));
  EXPECT_EQ(mesh.vertices[0], (Vec3{0, 0, 0}));
  EXPECT_EQ(mesh.vertices[1], (Vec3{1, 1, 0})); // rim
}

TEST(Smoothing, LaplacianShrinksASphereAndTaubinDoesNot) {
  const TriangleMesh sphere = shapes::icosphere(4); // 2562 vertices
  TriangleMesh laplacian = sphere, taubin = sphere;
  smooth(laplacian, Smoothing::laplacian, 20, Threads(2));
  smooth(taubin, Smoothing::taubin, 20, Threads(2));
  EXPECT_LT(volume(laplacian), 0.95 * volume(sphere));
  EXPECT_NEAR(volume(taubin) / volume(sphere), 1, 0.02);
}

TEST(Smoothing, BothRemoveRoughness) {
  TriangleMesh rough = shapes::icosphere(4);
  for (std::size_t v = 0; v < rough.vertices.size(); ++v) rough.vertices[v] = (v % 2 ? 1.02 : 0.98) * rough.vertices[v];
  const auto roughness = [](const TriangleMesh& mesh) {
    double mean = 0, square = 0;
    for (const Vec3& p : mesh.vertices) mean += norm(p) / static_cast<double>(mesh.vertices.size());
    for (const Vec3& p : mesh.vertices) square += (norm(p) - mean) * (norm(p) - mean);
    return std::sqrt(square / static_cast<double>(mesh.vertices.size()));
  };
  for (const Smoothing method : {Smoothing::laplacian, Smoothing::taubin}) {
    TriangleMesh mesh = rough;
    smooth(mesh, method, 5, Threads(1));
    EXPECT_LT(roughness(mesh), 0.5 * roughness(rough));
  }
}

TEST(Smoothing, NoStepsChangeNothingAndThreadsDoNotMatter) {
  const TriangleMesh torus = shapes::torus(3, 1, 200, 100);
  TriangleMesh zero = torus, one = torus, three = torus;
  smooth(zero, Smoothing::laplacian, 0, Threads(1));
  EXPECT_EQ(zero.vertices, torus.vertices);
  smooth(one, Smoothing::taubin, 3, Threads(1));
  smooth(three, Smoothing::taubin, 3, Threads(3));
  EXPECT_EQ(one.vertices, three.vertices);
}

} // namespace
} // namespace eigencrust
