// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The manifold repair of §3.5 on some samples, with a way back.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include <eigencrust/stages.h>

namespace eigencrust {

/// A tetrahedron that was relabelled, and what it was.
struct Flip {
  TetrahedronIndex tetrahedron;
  Label before;
};

/// Repairs the stars of given samples; what is relabelled may be written down and undone.
class StarRepair {
 public:
  StarRepair(const Tetrahedralization& tetrahedralization, const VertexStars& stars, const Poles& poles,
             const Labels& known, ManifoldRule rule, FinalLabels& labels);
  ~StarRepair();

  /// Repairs the stars of `samples` (increasing, distinct) and whatever that spoils.
  /// \param journal receives the flips in order; may be null
  ManifoldCounts run(std::vector<std::uint32_t> samples, std::vector<Flip>* journal, const Checkpoint& checkpoint = {});
  /// Takes back the flips of a journal, which must be the last that were made.
  void undo(std::span<const Flip> journal);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace eigencrust
