// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/snapshots.h"

#include <limits>

namespace eigencrust {
namespace {

/// 0 unlabelled, 1 inside, 2 outside.
Attribute label_column(const std::vector<double>& labels) { return make_attribute("label", ScalarType::uint8, labels); }

} // namespace

TriangleMesh snapshot_of_poles(const Tetrahedralization& t, const Poles& poles, const PoleGraph& graph,
                               const Partition& partition, const Labels& labels) {
  TriangleMesh snapshot;
  std::vector<float> radius, value(poles.tetrahedron.size(), std::numeric_limits<float>::quiet_NaN());
  std::vector<double> label;
  for (std::uint32_t p = 0; p < value.size(); ++p)
    if (graph.node.raw()[p].valid()) value[p] = partition.value[graph.node.raw()[p].value];
  for (std::uint32_t p = 0; p < poles.tetrahedron.size(); ++p) {
    snapshot.vertices.push_back(poles.sphere.raw()[p].centre + t.origin);
    radius.push_back(static_cast<float>(poles.sphere.raw()[p].radius));
    label.push_back(static_cast<double>(labels[poles.tetrahedron.raw()[p]]));
  }
  snapshot.vertex_attributes = {make_attribute("radius", radius), make_attribute("value", value), label_column(label)};
  return snapshot;
}

TriangleMesh snapshot_of_tetrahedra(const Tetrahedralization& t, const TetrahedronLabels& labels) {
  TriangleMesh snapshot;
  std::vector<float> value;
  std::vector<double> label;
  for (std::uint32_t i = 0; i < t.tetrahedra.size(); ++i) {
    if (t.touches_cube(TetrahedronIndex{i})) continue;
    Vec3 centroid = t.origin;
    for (const VertexIndex s : t.tetrahedra.raw()[i]) centroid = centroid + 0.25 * t.positions[s];
    snapshot.vertices.push_back(centroid);
    value.push_back(labels.values().raw()[i]);
    label.push_back(static_cast<double>(labels.labels().raw()[i]));
  }
  snapshot.vertex_attributes = {make_attribute("value", value), label_column(label)};
  return snapshot;
}

TriangleMesh snapshot_of_surface(const Tetrahedralization& t, const Surface& surface) {
  TriangleMesh snapshot = surface.mesh;
  for (Vec3& p : snapshot.vertices) p = p + t.origin;
  return snapshot;
}

} // namespace eigencrust
