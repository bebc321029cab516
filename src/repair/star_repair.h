// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The manifold repair of §3.5 on some samples, with a way back.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include <eigencrust/stages.h>

namespace eigencrust {

/// Repairs the stars of given samples; what is relabelled may be written down and undone.
class StarRepair {
 public:
  StarRepair(const Tetrahedralization& tetrahedralization, const VertexStars& stars, const Poles& poles,
             const Labels& known, ManifoldRule rule, TetrahedronLabels& labels);
  ~StarRepair();

  /// Repairs the stars of `samples` (increasing, distinct) and whatever that spoils.
  /// \param journal receives what was turned, in order; may be null
  ManifoldCounts run(std::vector<std::uint32_t> samples, TetrahedronLabels::Journal* journal,
                     const Checkpoint& checkpoint = {});
  /// Takes back a journal, which must hold the last turns that were made.
  void undo(const TetrahedronLabels::Journal& journal);

  /// These tetrahedra are dear from now on: only where nothing else will do they turn.
  void hold(std::span<const TetrahedronIndex> tetrahedra);
  void release(std::span<const TetrahedronIndex> tetrahedra);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace eigencrust
