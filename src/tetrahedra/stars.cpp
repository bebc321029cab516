// SPDX-License-Identifier: GPL-3.0-or-later
// Which tetrahedra there are around each sample.
#include <eigencrust/stages.h>

namespace eigencrust {

VertexStars vertex_stars(const Tetrahedralization& t, const Threads&) {
  VertexStars stars;
  stars.begin.assign(t.positions.size() + 1, 0);
  for (const auto& tetrahedron : t.tetrahedra)
    for (const SampleIndex s : tetrahedron) ++stars.begin[s.value + 1];
  for (std::size_t s = 0; s < t.positions.size(); ++s) stars.begin[s + 1] += stars.begin[s];
  stars.tetrahedra.resize(stars.begin.back());
  std::vector<std::uint64_t> cursor(stars.begin.begin(), stars.begin.end() - 1);
  for (std::uint32_t i = 0; i < t.tetrahedra.size(); ++i)
    for (const SampleIndex s : t.tetrahedra[TetrahedronIndex{i}])
      stars.tetrahedra[cursor[s.value]++] = TetrahedronIndex{i};
  return stars;
}

} // namespace eigencrust
