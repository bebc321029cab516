// SPDX-License-Identifier: GPL-3.0-or-later
// Which tetrahedra there are around each sample.
#include <eigencrust/stages.h>

#include "parallel/compressed_rows.h"

namespace eigencrust {

VertexStars vertex_stars(const Tetrahedralization& t, const Threads&) {
  auto rows = build_rows<TetrahedronIndex>(t.positions.size(), [&](auto&& visit) {
    for (TetrahedronIndex i{0}; i.value < t.tetrahedra.size(); ++i.value)
      for (const VertexIndex s : t.tetrahedra[i]) visit(s.value, i);
  });
  return {std::move(rows.begin), std::move(rows.item)};
}

} // namespace eigencrust
