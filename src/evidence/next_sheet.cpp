// SPDX-License-Identifier: GPL-3.0-or-later
#include "evidence/next_sheet.h"

#include <algorithm>
#include <array>

namespace eigencrust {
namespace {

// A sheet of samples at random places has few longer edges, in spacings.
constexpr double longest_in_sheet = 3;

} // namespace

bool is_in_sheet(const Scene& scene, TetrahedronIndex one, TetrahedronIndex other) {
  const Tetrahedralization& t = scene.tetrahedralization;
  std::array<SampleIndex, 3> face;
  std::size_t common = 0;
  for (const VertexIndex v : t.tetrahedra[one])
    if (const auto& w = t.tetrahedra[other]; std::find(w.begin(), w.end(), v) != w.end()) {
      if (t.is_corner(v) || common == face.size()) return false;
      face[common++] = t.sample(v);
    }
  if (common < face.size()) return false;
  double longest = 0, spacing = 0;
  for (std::size_t k = 0; k < face.size(); ++k) {
    longest = std::max(longest, distance(t.positions[face[k]], t.positions[face[(k + 1) % face.size()]]));
    spacing += static_cast<double>(scene.measures.model.spacing[face[k]]) / static_cast<double>(face.size());
  }
  return longest <= longest_in_sheet * spacing;
}

} // namespace eigencrust
