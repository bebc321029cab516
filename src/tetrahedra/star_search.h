// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Nearest samples along Delaunay edges, without a search tree.
#pragma once

#include <eigencrust/types.h>
#include <cstdint>
#include <utility>
#include <vector>

#include "geometry/distinct_numbers.h"

namespace eigencrust {

/// For a few samples of many, where a tree over all of them would cost more than the queries. Each sample has a
/// Delaunay neighbour nearer to any other point, so the next nearest is always a neighbour of those found before.
class StarSearch {
 public:
  StarSearch(const Tetrahedralization& tetrahedralization, const VertexStars& stars);

  /// Distance to the k-th nearest other sample; to the farthest if there are fewer. 0 for a sample alone.
  double distance_to_nearest(SampleIndex sample, std::size_t k);

 private:
  const Tetrahedralization& t_;
  const VertexStars& stars_;
  DistinctNumbers seen_;
  std::vector<std::pair<double, std::uint32_t>> heap_; ///< squared distance, sample; nearest first
};

} // namespace eigencrust
