// SPDX-License-Identifier: GPL-3.0-or-later
// §3: the surface is every face between an inside and an outside tetrahedron.
#include <eigencrust/stages.h>

#include "geometry/tetrahedron.h"
#include "parallel/threads.h"

namespace eigencrust {

namespace {

/// The surface's faces with sample numbers, in the order of their inside tetrahedra.
struct Faces {
  std::vector<std::array<SampleIndex, 3>> triangles;
  std::vector<TetrahedronIndex> inside;
};

Faces faces_of(const Tetrahedralization& t, const Labels& labels, std::size_t begin, std::size_t end) {
  Faces faces;
  for (std::size_t i = begin; i < end; ++i) {
    if (labels.raw()[i] != Label::inside) continue;
    const auto& v = t.tetrahedra.raw()[i];
    for (std::size_t k = 0; k < 4; ++k) {
      const TetrahedronIndex n = t.neighbours.raw()[i][k];
      if (!n.valid() || labels[n] != Label::outside) continue;
      const VertexIndex a = v[face_opposite[k][0]], b = v[face_opposite[k][1]], c = v[face_opposite[k][2]];
      // Only with a façade can inside reach the cube; such triangles are trimmed (§3.1).
      if (t.is_corner(a) || t.is_corner(b) || t.is_corner(c)) continue;
      faces.triangles.push_back({t.sample(a), t.sample(b), t.sample(c)});
      faces.inside.push_back(TetrahedronIndex{static_cast<std::uint32_t>(i)});
    }
  }
  return faces;
}

} // namespace

Surface extract_surface(const Tetrahedralization& t, const Labels& labels, const Threads& threads) {
  const std::size_t n = t.tetrahedra.size();
  std::vector<Faces> blocks((n + default_block - 1) / default_block);
  for_blocks(threads, n, default_block,
             [&](std::size_t begin, std::size_t end, std::size_t b) { blocks[b] = faces_of(t, labels, begin, end); });
  std::vector<std::size_t> first(blocks.size() + 1, 0);
  IndexedArray<SampleIndex, std::uint32_t> vertex_of(t.sample_count, SampleIndex::none);
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    first[b + 1] = first[b] + blocks[b].triangles.size();
    for (const auto& triangle : blocks[b].triangles)
      for (const SampleIndex s : triangle) vertex_of[s] = 0;
  }
  Surface surface;
  for (std::uint32_t s = 0; s < t.sample_count; ++s) {
    if (vertex_of.raw()[s] == SampleIndex::none) continue;
    vertex_of.raw()[s] = static_cast<std::uint32_t>(surface.sample_of.size());
    surface.sample_of.push_back(SampleIndex{s});
    surface.mesh.vertices.push_back(t.positions.raw()[s]);
  }
  surface.mesh.triangles.resize(first.back());
  surface.inside.resize(first.back());
  threads.run(blocks.size(), [&](std::size_t b) {
    for (std::size_t k = 0; k < blocks[b].triangles.size(); ++k) {
      const auto& [x, y, z] = blocks[b].triangles[k];
      surface.mesh.triangles[first[b] + k] = {vertex_of[x], vertex_of[y], vertex_of[z]};
      surface.inside[first[b] + k] = blocks[b].inside[k];
    }
    blocks[b] = {};
  });
  return surface;
}

} // namespace eigencrust
