// SPDX-License-Identifier: GPL-3.0-or-later
// §3.4: labels from the signs of the second partition.
#include <cmath>

#include <eigencrust/stages.h>

namespace eigencrust {

bool supernodes_agree(const Partition& partition) {
  return !partition.value.empty() && partition.supernode_value[0] * partition.supernode_value[1] > 0;
}

TetrahedronLabels label_tetrahedra(const TetrahedronGraph& graph, const Partition& partition, Labels labels) {
  IndexedArray<TetrahedronIndex, float> values(labels.size());
  const double out = partition.supernode_value[0], in = partition.supernode_value[1];
  const float sign = out >= 0 ? 1.0f : -1.0f;
  for (std::uint32_t i = 0; i < labels.size(); ++i)
    values.raw()[i] = static_cast<float>(std::fabs(labels.raw()[i] == Label::outside ? out : in));
  for (std::uint32_t node = 0; node < graph.tetrahedron.size(); ++node) {
    const TetrahedronIndex t = graph.tetrahedron.raw()[node];
    values[t] = sign * partition.value[node];
    // A component of exactly 0 says nothing; outside is the side that leaves less surface.
    labels[t] = values[t] >= 0 ? Label::outside : Label::inside;
  }
  return {std::move(labels), std::move(values)};
}

} // namespace eigencrust
