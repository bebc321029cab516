// SPDX-License-Identifier: GPL-3.0-or-later
// §3: the surface is every face between an inside and an outside tetrahedron.
#include <eigencrust/stages.h>

namespace eigencrust {

Surface extract_surface(const Tetrahedralization& t, const Labels& labels) {
  // Face k, counter-clockwise seen from outside the (positively oriented) tetrahedron.
  static constexpr std::array<std::array<std::size_t, 3>, 4> face{{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
  Surface surface;
  IndexedArray<SampleIndex, std::uint32_t> vertex_of(t.positions.size(), SampleIndex::none);
  std::vector<std::array<SampleIndex, 3>> triangles;
  for (std::uint32_t i = 0; i < t.tetrahedra.size(); ++i) {
    if (labels.raw()[i] != Label::inside) continue;
    const auto& v = t.tetrahedra.raw()[i];
    for (std::size_t k = 0; k < 4; ++k) {
      const TetrahedronIndex n = t.neighbours.raw()[i][k];
      if (!n.valid() || labels[n] != Label::outside) continue;
      const std::array<SampleIndex, 3> triangle{v[face[k][0]], v[face[k][1]], v[face[k][2]]};
      // Only with a façade can inside reach the cube; such triangles are trimmed (§3.1).
      if (t.is_corner(triangle[0]) || t.is_corner(triangle[1]) || t.is_corner(triangle[2])) continue;
      for (const SampleIndex s : triangle) vertex_of[s] = 0;
      triangles.push_back(triangle);
      surface.inside.push_back(TetrahedronIndex{i});
    }
  }
  for (std::uint32_t s = 0; s < t.sample_count; ++s) {
    if (vertex_of.raw()[s] == SampleIndex::none) continue;
    vertex_of.raw()[s] = static_cast<std::uint32_t>(surface.sample_of.size());
    surface.sample_of.push_back(SampleIndex{s});
    surface.mesh.vertices.push_back(t.positions.raw()[s]);
  }
  surface.mesh.triangles.reserve(triangles.size());
  for (const auto& [a, b, c] : triangles) surface.mesh.triangles.push_back({vertex_of[a], vertex_of[b], vertex_of[c]});
  return surface;
}

} // namespace eigencrust
