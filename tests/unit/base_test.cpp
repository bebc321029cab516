// SPDX-License-Identifier: GPL-3.0-or-later
// A flat base under an open surface.
#include <eigencrust/validate.h>
#include <gtest/gtest.h>

#include "support.h"
#include "surface/base.h"

namespace eigencrust {
namespace {

/// A square of n x n unit squares in z = 0, seen from +z.
Surface square(std::uint32_t n) {
  Surface surface;
  for (std::uint32_t j = 0; j <= n; ++j)
    for (std::uint32_t i = 0; i <= n; ++i) surface.mesh.vertices.push_back({double(i), double(j), 0});
  for (std::uint32_t j = 0; j < n; ++j)
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t a = j * (n + 1) + i, b = a + 1, c = a + n + 1, d = c + 1;
      surface.mesh.triangles.push_back({a, b, d});
      surface.mesh.triangles.push_back({a, d, c});
    }
  return surface;
}

/// A tetrahedron beside the corner at `place`, its triangles turned outwards or inwards.
void add_tetrahedron(const Vec3& place, bool inwards, Surface& surface) {
  const auto first = static_cast<std::uint32_t>(surface.mesh.vertices.size());
  for (const Vec3& p : {Vec3{}, Vec3{2, 0, 0}, Vec3{0, 2, 0}, Vec3{0, 0, 2}})
    surface.mesh.vertices.push_back(place + p);
  for (std::array<std::uint32_t, 3> t :
       std::vector<std::array<std::uint32_t, 3>>{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}) {
    if (inwards) std::swap(t[1], t[2]);
    surface.mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
}

MeshSummary on_base(Surface surface) {
  for (std::uint32_t v = 0; v < surface.mesh.vertices.size(); ++v) surface.sample_of.push_back(SampleIndex{v});
  surface.inside.resize(surface.mesh.triangles.size());
  surface.support.assign(surface.mesh.triangles.size(), 1);
  SampleModel model;
  model.typical_spacing = 1;
  close_with_base(Axis::plus_z, model, {}, surface);
  return validate(surface.mesh);
}

TEST(Base, ClosesASquare) {
  const MeshSummary m = on_base(square(4));
  EXPECT_TRUE(m.closed() && m.manifold() && m.oriented());
  EXPECT_NEAR(m.volume, 16.0 / 500, 1e-12); // as thick as the base is below
}

TEST(Base, CavitiesBehindTheSurfaceGoAndBodiesStay) {
  Surface cavity = square(4), body = square(4);
  add_tetrahedron({7, 0, -3}, true, cavity);
  add_tetrahedron({7, 0, -3}, false, body);
  EXPECT_EQ(on_base(cavity).components, 1u);
  EXPECT_NEAR(on_base(cavity).volume, 16.0 / 500, 1e-12);
  EXPECT_EQ(on_base(body).components, 2u);
}

TEST(Base, IsRefusedWhereItWouldRoundIntoTheSurface) {
  Surface far = square(4);
  for (Vec3& v : far.mesh.vertices) v = v + Vec3{1e14, 0, 0};
  EXPECT_NE(error_of([&] { on_base(far); }).find("nearer to zero"), std::string::npos);
}

TEST(Base, IsRefusedBehindAPitWiderThanItsRim) {
  // 20 wide behind an opening of 8: what the base closes would have a negative volume.
  Surface pit = square(8);
  for (Vec3& v : pit.mesh.vertices) {
    const Vec3 d = v - Vec3{4, 4, 0};
    const double ring = std::max(std::fabs(d.x), std::fabs(d.y));
    if (ring == 4 || ring == 0)
      v.z = ring == 4 ? 0 : -6;
    else
      v = Vec3{4, 4, ring == 3 ? -1.0 : -6.0} + (ring == 1 ? 4.0 : 10 / ring) * Vec3{d.x, d.y, 0};
  }
  EXPECT_NE(error_of([&] { on_base(pit); }).find("wider than its rim"), std::string::npos);
}

} // namespace
} // namespace eigencrust
