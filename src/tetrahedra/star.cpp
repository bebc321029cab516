// SPDX-License-Identifier: GPL-3.0-or-later
#include "tetrahedra/star.h"

#include <algorithm>

namespace eigencrust {

void Star::fill(VertexIndex sample) {
  tetrahedra_ = stars_[sample];
  others_.resize(tetrahedra_.size());
  neighbours_.resize(tetrahedra_.size());
  for (std::uint32_t i = 0; i < size(); ++i) {
    const auto& vertices = t_.tetrahedra[tetrahedra_[i]];
    const auto& neighbours = t_.neighbours[tetrahedra_[i]];
    std::size_t filled = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      if (vertices[k] == sample) continue;
      others_[i][filled] = vertices[k];
      const auto at = std::lower_bound(tetrahedra_.begin(), tetrahedra_.end(), neighbours[k]);
      const bool found = neighbours[k].valid() && at != tetrahedra_.end() && *at == neighbours[k];
      neighbours_[i][filled++] = found ? static_cast<std::uint32_t>(at - tetrahedra_.begin()) : no_index;
    }
  }
}

std::uint32_t Star::components(const Labels& labels, Label label, VertexIndex edge,
                               std::vector<std::uint32_t>& component) {
  const auto at_edge = [&](std::uint32_t i) {
    return !edge.valid() || std::find(others_[i].begin(), others_[i].end(), edge) != others_[i].end();
  };
  component.assign(size(), no_index);
  std::uint32_t count = 0;
  for (std::uint32_t start = 0; start < size(); ++start) {
    if (component[start] != no_index || labels[tetrahedra_[start]] != label || !at_edge(start)) continue;
    component[start] = count;
    stack_.assign(1, start);
    while (!stack_.empty()) {
      const std::uint32_t i = stack_.back();
      stack_.pop_back();
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t n = neighbours_[i][k];
        // The face towards neighbour k lacks vertex k: it holds the edge unless that is vertex k.
        if (n == no_index || others_[i][k] == edge || component[n] != no_index || labels[tetrahedra_[n]] != label)
          continue;
        component[n] = count;
        stack_.push_back(n);
      }
    }
    ++count;
  }
  return count;
}

} // namespace eigencrust
