// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The sides of all tetrahedra, from those of the poles (§3.4).
#pragma once

#include <vector>

#include <eigencrust/stages.h>

#include "tetrahedra/scene.h"

namespace eigencrust {

/// A solution by tetrahedron, with the weights to the supernodes that it came from; those are 0 where the
/// tetrahedron was no node. From it that of a graph which changed here and there is found quickly.
class KeptSolution {
 public:
  KeptSolution() = default;
  KeptSolution(const TetrahedronGraph& graph, const Partition& partition, std::size_t tetrahedra);

  [[nodiscard]] bool empty() const { return value_.empty(); }
  /// Of another graph of the same tetrahedra.
  [[nodiscard]] Partition adapted_to(const TetrahedronGraph& graph) const;

 private:
  std::vector<float> value_, outside_, inside_;
};
/// The stages tetrahedron_graph and partition_tetrahedra.
KeptSolution keep_solution(const Scene& scene, const PoleLabels& poles, const Context& context);

/// The stages tetrahedron_graph, partition_tetrahedra, label_tetrahedra and centring.
/// \param kept solves the graph if it is not empty
TetrahedronLabels settle(const Scene& scene, const PoleLabels& poles, const Context& context,
                         const KeptSolution& kept = {});

} // namespace eigencrust
