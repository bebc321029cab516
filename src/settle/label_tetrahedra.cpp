// SPDX-License-Identifier: GPL-3.0-or-later
// §3.4: labels from the signs of the second partition.
#include <cmath>

#include <eigencrust/stages.h>

namespace eigencrust {

FinalLabels label_tetrahedra(const TetrahedronGraph& graph, const Partition& partition, Labels labels) {
  FinalLabels result;
  result.labels = std::move(labels);
  result.value = IndexedArray<TetrahedronIndex, float>(result.labels.size());
  const double out = partition.supernode_value[0], in = partition.supernode_value[1];
  result.supernodes_agree = graph.tetrahedron.size() > 0 && out * in > 0;
  const float sign = out >= 0 ? 1.0f : -1.0f;
  for (std::uint32_t i = 0; i < result.labels.size(); ++i) {
    const Label label = result.labels.raw()[i];
    if (label == Label::outside)
      result.value.raw()[i] = static_cast<float>(std::fabs(out));
    else if (label == Label::inside)
      result.value.raw()[i] = -static_cast<float>(std::fabs(in));
  }
  for (std::uint32_t node = 0; node < graph.tetrahedron.size(); ++node) {
    const TetrahedronIndex t = graph.tetrahedron.raw()[node];
    const float value = sign * partition.value[node];
    result.value[t] = value;
    // A component of exactly 0 says nothing; outside is the side that leaves less surface.
    result.labels[t] = value >= 0 ? Label::outside : Label::inside;
  }
  return result;
}

} // namespace eigencrust
