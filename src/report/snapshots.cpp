// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/snapshots.h"

#include <algorithm>
#include <limits>

namespace eigencrust {
namespace {

/// 0 unlabelled, 1 inside, 2 outside.
Attribute label_column(const std::vector<double>& labels) { return make_attribute("label", ScalarType::uint8, labels); }

} // namespace

TriangleMesh snapshot_of_samples(const Tetrahedralization& t, const SampleModel& model) {
  TriangleMesh snapshot;
  for (std::uint32_t s = 0; s < t.sample_count; ++s)
    snapshot.vertices.push_back(t.positions[VertexIndex{s}] + t.origin);
  const auto column = [](std::string name, const SampleLengths& lengths) {
    return make_attribute(std::move(name), std::span<const float>(lengths.raw()));
  };
  snapshot.vertex_attributes = {column("spacing", model.spacing), column("noise", model.input_noise),
                                column("isolated", model.isolated)};
  return snapshot;
}

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

TriangleMesh snapshot_of_surface(const Tetrahedralization& t, const Surface& all, const Surface& kept) {
  TriangleMesh snapshot = all.mesh;
  for (Vec3& p : snapshot.vertices) p = p + t.origin;
  // A wall of a cavity may have been turned over: what counts is which samples a triangle has.
  const auto corners = [](const Surface& surface, std::size_t i) {
    const auto& [a, b, c] = surface.mesh.triangles[i];
    std::array<SampleIndex, 3> samples{surface.sample_of[a], surface.sample_of[b], surface.sample_of[c]};
    std::sort(samples.begin(), samples.end());
    return samples;
  };
  std::vector<std::array<SampleIndex, 3>> left;
  for (std::size_t i = 0; i < kept.mesh.triangles.size(); ++i) left.push_back(corners(kept, i));
  std::sort(left.begin(), left.end());
  std::vector<double> is_kept;
  for (std::size_t i = 0; i < all.mesh.triangles.size(); ++i)
    is_kept.push_back(std::binary_search(left.begin(), left.end(), corners(all, i)));
  snapshot.triangle_attributes = {make_attribute("support", all.support),
                                  make_attribute("kept", ScalarType::uint8, is_kept)};
  return snapshot;
}

TriangleMesh snapshot_of_mesh(const TriangleMesh& mesh, const Surface& surface) {
  TriangleMesh snapshot = mesh;
  if (surface.unsupported.size() == mesh.triangles.size()) {
    const std::vector<double> marked(surface.unsupported.begin(), surface.unsupported.end());
    snapshot.triangle_attributes.push_back(make_attribute("unsupported", ScalarType::uint8, marked));
  }
  return snapshot;
}

} // namespace eigencrust
