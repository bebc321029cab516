// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Mandatory moves: stars that are no disc become one.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <eigencrust/stages.h>

#include "repair/priced_labels.h"
#include "repair/unsound_stars.h"

namespace eigencrust {

/// Of all sets of tetrahedra that mend an edge or a vertex of a star the one that costs least turns: one of several
/// sets of equal label around it, or a path that joins two of them (docs/decisions/0027).
class StarRepair {
 public:
  StarRepair(const Tetrahedralization& tetrahedralization, const VertexStars& stars, const Labels& known,
             PricedLabels& labels);

  /// Mends the stars of `samples` (increasing, distinct) and whatever that spoils. It ends: each tetrahedron becomes
  /// inside at most once. What is known gives way only where nothing else does, and then only to the outside.
  /// \param held tetrahedra that stay as they are where anything else will do
  /// \param most  tetrahedra that may turn
  /// \return false if more had to
  bool run(std::vector<std::uint32_t> samples, std::span<const TetrahedronIndex> held = {},
           std::uint64_t most = ~std::uint64_t{0}, const Checkpoint& checkpoint = {});

  ManifoldCounts counts; ///< of all runs

 private:
  struct Candidate {
    double price;
    std::vector<TetrahedronIndex> members;
  };

  bool mend(VertexIndex s);
  bool mend_edges();
  bool mend_vertex(bool& mended);
  [[nodiscard]] bool may_turn(TetrahedronIndex i) const;
  [[nodiscard]] double extra_price(TetrahedronIndex i) const;
  double price_of(std::span<const TetrahedronIndex> members);
  void offer(std::vector<TetrahedronIndex> members, Candidate& best);
  std::uint32_t offer_components(Label label, VertexIndex edge, Candidate& best);
  void offer_path(Label label, Candidate& best);
  void turn(const std::vector<TetrahedronIndex>& members);

  const Tetrahedralization& t_;
  const VertexStars& stars_;
  const Labels& known_;
  PricedLabels& labels_;
  Star star_;
  LinkCheck link_;
  std::uint32_t run_ = 0;
  IndexedArray<TetrahedronIndex, std::uint32_t> held_, filled_; ///< the last run in which they were
  std::vector<std::uint8_t> waiting_;
  std::vector<std::uint32_t> next_; ///< samples that wait for the next round
  std::vector<std::uint32_t> component_;
};

} // namespace eigencrust
