// SPDX-License-Identifier: GPL-3.0-or-later
#include "tetrahedra/star_search.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace eigencrust {

StarSearch::StarSearch(const Tetrahedralization& tetrahedralization, const VertexStars& stars)
    : t_(tetrahedralization), stars_(stars), seen_(tetrahedralization.sample_count) {}

double StarSearch::distance_to_nearest(SampleIndex sample, std::size_t k) {
  seen_.clear();
  seen_.add(sample.value);
  heap_.assign(1, {0.0, sample.value});
  double square = 0;
  for (std::size_t found = 0; found <= k && !heap_.empty(); ++found) {
    std::pop_heap(heap_.begin(), heap_.end(), std::greater<>());
    const auto [distance, nearest] = heap_.back();
    heap_.pop_back();
    square = distance;
    for (const TetrahedronIndex i : stars_[SampleIndex{nearest}])
      for (const SampleIndex s : t_.tetrahedra[i]) {
        if (t_.is_corner(s) || !seen_.add(s.value)) continue;
        heap_.emplace_back(squared_norm(t_.positions[s] - t_.positions[sample]), s.value);
        std::push_heap(heap_.begin(), heap_.end(), std::greater<>());
      }
  }
  return std::sqrt(square);
}

} // namespace eigencrust
