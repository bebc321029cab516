// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/exact_difference.h"
#include "surface/surface.h"
#include "surface/turned_over.h"

namespace eigencrust {
namespace {

/// Are the samples the input's rows moved without any rounding?
bool is_exact_translation(const Tetrahedralization& t, const PointCloud& cloud, const Threads& threads) {
  const auto rounded = sum_blocks<std::uint64_t>(threads, t.sample_count, [&](std::size_t begin, std::size_t end) {
    std::uint64_t count = 0;
    for (std::size_t s = begin; s < end; ++s) count += !is_exact_difference(cloud.points[t.source.raw()[s]], t.origin);
    return count;
  });
  return rounded == 0;
}

/// Smoothes, and puts the vertices into input coordinates: where these round, neighbours could meet.
TurnedOver smooth_in_place(Surface& surface, const Tetrahedralization& t, const PointCloud& cloud,
                           const Options& options, const Threads& threads) {
  smooth(surface.mesh, options.smoothing, options.smooth, threads);
  std::vector<Vec3> rows;
  rows.reserve(surface.sample_of.size());
  for (const SampleIndex s : surface.sample_of) rows.push_back(cloud.points[t.source[s]]);
  for (std::size_t v = 0; v < rows.size(); ++v) {
    Vec3& place = surface.mesh.vertices[v];
    place = place == t.positions[surface.sample_of[v]] ? rows[v] : place + t.origin;
  }
  return take_back_turned(rows, surface.mesh, threads);
}

/// The surface in input coordinates with the attributes of its points and source_index. Unless the
/// vertices were moved, and are in input coordinates, they are the input's rows bit for bit.
TriangleMesh finish_mesh(const Surface& surface, const Tetrahedralization& t, const PointCloud& cloud, bool moved) {
  TriangleMesh mesh;
  mesh.triangles = surface.mesh.triangles;
  std::vector<std::uint32_t> source;
  source.reserve(surface.sample_of.size());
  for (const SampleIndex s : surface.sample_of) source.push_back(t.source[s]);
  mesh.vertices.reserve(source.size());
  for (std::size_t v = 0; v < source.size(); ++v)
    mesh.vertices.push_back(moved ? surface.mesh.vertices[v] : cloud.points[source[v]]);
  for (const Attribute& attribute : cloud.attributes) mesh.vertex_attributes.push_back(gather(attribute, source));
  mesh.vertex_attributes.push_back(make_attribute("source_index", source));
  if (!cloud.scan_index.empty()) {
    std::vector<std::uint32_t> scan;
    scan.reserve(source.size());
    for (const std::uint32_t row : source) scan.push_back(cloud.scan_index[row]);
    mesh.vertex_attributes.push_back(make_attribute("scan_index", scan));
  }
  mesh.triangle_attributes.push_back(make_attribute("support", surface.support));
  return mesh;
}

} // namespace

TriangleMesh finish(Surface surface, const PointCloud& cloud, const Scene& scene, const Context& context) {
  const auto& [options, run, threads] = context;
  if (options.smooth > 0)
    run.stage("smoothing", [&] { return smooth_in_place(surface, scene.tetrahedralization, cloud, options, threads); });
  return run.stage("attributes",
                   [&] { return finish_mesh(surface, scene.tetrahedralization, cloud, options.smooth > 0); });
}

void check(const TriangleMesh& mesh, const PointCloud& cloud, const Scene& scene, const ValidateOptions& checks,
           const Context& context) {
  const auto& [options, run, threads] = context;
  run.stage("validate", [&] {
    // Faces of one Delaunay tetrahedralization do not cross, unless they were moved or rounded (docs/guarantees.md).
    const bool cannot_cross = checks.self_intersections && options.smooth == 0 &&
                              is_exact_translation(scene.tetrahedralization, cloud, threads);
    ValidateOptions needed = checks;
    needed.self_intersections = checks.self_intersections && !cannot_cross;
    needed.merge_equal_vertices = checks.merge_equal_vertices && !cannot_cross; // samples differ, so vertices do
    MeshSummary summary = validate(mesh, needed);
    if (cannot_cross) summary.self_intersections = 0;
    return summary;
  });
}

} // namespace eigencrust
