// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <optional>
#include <utility>

#include "fit/bridges.h"
#include "fit/edge_flips.h"
#include "fit/fit.h"
#include "fit/uncross.h"
#include "geometry/exact_difference.h"
#include "numerics/quantile.h"
#include "report/snapshots.h"
#include "simplify/other_triangles.h"
#include "surface/base.h"
#include "surface/surface.h"
#include "surface/trim.h"
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

/// Moves vertices to the middle of the noise, and those of strays to the middle of their bridges.
/// \param strays see strays_on_bridges() \return whether any moved
bool fit(Surface& surface, const SurfaceFans& fans, std::span<const Vec3> samples, const SampleModel& model,
         SurfaceKind kind, std::span<const std::uint32_t> strays, const Threads& threads) {
  const std::vector<float> noise = noise_to_fit(surface, fans, model, kind, threads);
  std::vector<Vec3> fitted;
  if (noise.empty())
    for (const SampleIndex s : surface.sample_of) fitted.push_back(samples[s.value]); // eased ones go back, too
  else
    fitted = fitted_vertices(surface, fans, samples, model, noise, threads);
  if (!strays.empty()) flatten_bridges(strays, fans, fitted);
  const bool moved = fitted != surface.mesh.vertices;
  surface.mesh.vertices = std::move(fitted);
  return moved;
}

/// How far the vertices are from the input points that they were. \param strays increasing
MovedReport moved_report(std::span<const Vec3> before, std::span<const Vec3> after,
                         std::span<const std::uint32_t> strays) {
  MovedReport report;
  std::vector<double> distances;
  for (std::size_t v = 0; v < before.size(); ++v) {
    if (before[v] == after[v]) continue;
    if (std::binary_search(strays.begin(), strays.end(), v))
      ++report.strays;
    else
      distances.push_back(distance(before[v], after[v]));
  }
  if (distances.empty()) return report;
  report.vertices = distances.size();
  report.median = median(distances);
  report.q99 = quantile(distances, 0.99);
  report.max = *std::max_element(distances.begin(), distances.end());
  return report;
}

/// No crossings, and no piece that turned over: pieces that did are back where they were triangulated, and what crosses
/// these moves on.
UncrossCounts settle_moved(const std::vector<Vec3>& before, const std::vector<Vec3>& rows, const SampleModel& model,
                           const SurfaceFans& fans, TriangleMesh& mesh, const Threads& threads) {
  UncrossCounts counts = uncross(before, model.typical_spacing, fans, mesh, threads, rows);
  for (;;) { // a piece that is back does not move any more
    const std::vector<Vec3> tested = mesh.vertices;
    take_back_turned(before, fans, mesh, threads);
    if (mesh.vertices == tested) return counts;
    const UncrossCounts again = uncross(before, model.typical_spacing, fans, mesh, threads, rows);
    counts.crossings += again.crossings;
    counts.eased += again.eased;
    counts.left = again.left;
  }
}

std::vector<Vec3> input_points(std::span<const SampleIndex> sample_of, const Tetrahedralization& t,
                               const PointCloud& cloud) {
  std::vector<Vec3> points;
  points.reserve(sample_of.size());
  for (const SampleIndex s : sample_of) points.push_back(cloud.points[t.source[s]]);
  return points;
}

/// Puts the vertices into input coordinates, those that are where their rows are bit for bit.
void to_input_coordinates(Surface& surface, const Tetrahedralization& t, const std::vector<Vec3>& rows) {
  for (std::size_t v = 0; v < rows.size(); ++v) {
    Vec3& place = surface.mesh.vertices[v];
    place = place == rows[v] - t.origin ? rows[v] : place + t.origin; // as samples are made of rows
  }
}

/// Where the vertices were triangulated, in input coordinates: faces of one tetrahedralization do not cross there.
std::vector<Vec3> triangulated_places(const Surface& surface, const Tetrahedralization& t,
                                      const std::vector<Vec3>& rows) {
  Surface there;
  there.sample_of = surface.sample_of;
  for (const SampleIndex s : surface.sample_of) there.mesh.vertices.push_back(t.positions[s]);
  to_input_coordinates(there, t, rows);
  return std::move(there.mesh.vertices);
}

/// \param moved are the vertices in input coordinates already?
Base put_on_base(Surface& surface, const Scene& scene, bool moved, Axis front) {
  const Vec3 origin = moved ? Vec3{} : scene.tetrahedralization.origin;
  Base base = close_with_base(front, scene.measures.model, origin, surface);
  const Vec3 axis = direction_of(front);
  const Vec3 place = base.level * axis + origin;
  base.level = dot(place, axis) * (axis.x + axis.y + axis.z);
  return base;
}

/// The surface in input coordinates with the attributes of its points and source_index. Unless the
/// vertices were moved, and are in input coordinates, they are the input's rows bit for bit. The last `invented` are no
/// row's.
TriangleMesh finish_mesh(const Surface& surface, const Tetrahedralization& t, const PointCloud& cloud, bool moved,
                         std::size_t invented) {
  TriangleMesh mesh;
  mesh.triangles = surface.mesh.triangles;
  std::vector<std::uint32_t> source;
  source.reserve(surface.sample_of.size());
  for (const SampleIndex s : surface.sample_of) source.push_back(t.source[s]);
  mesh.vertices.reserve(source.size());
  for (std::size_t v = 0; v < source.size(); ++v)
    if (moved)
      mesh.vertices.push_back(surface.mesh.vertices[v]);
    else
      mesh.vertices.push_back(v < source.size() - invented ? cloud.points[source[v]]
                                                           : surface.mesh.vertices[v] + t.origin);
  for (const Attribute& attribute : cloud.attributes) mesh.vertex_attributes.push_back(gather(attribute, source));
  std::vector<std::uint32_t> source_row = source;
  std::fill(source_row.end() - static_cast<std::ptrdiff_t>(invented), source_row.end(), no_index);
  mesh.vertex_attributes.push_back(derived_attribute(make_attribute("source_index", source_row)));
  if (!cloud.scan_index.empty()) {
    std::vector<std::uint32_t> scan;
    scan.reserve(source.size());
    for (const std::uint32_t row : source) scan.push_back(cloud.scan_index[row]);
    mesh.vertex_attributes.push_back(derived_attribute(make_attribute("scan_index", scan)));
  }
  mesh.triangle_attributes.push_back(derived_attribute(make_attribute("support", surface.support)));
  return mesh;
}

/// Which way the sensor of each vertex is, a unit vector; zero where none is known; empty where none is of any.
std::vector<Vec3> views_of(const Surface& surface, const PointCloud& cloud, const Tetrahedralization& t) {
  std::vector<Vec3> view;
  if (cloud.sensor_of.empty()) return view;
  for (const SampleIndex s : surface.sample_of) {
    const std::uint32_t row = t.source[s], sensor = cloud.sensor_of[row];
    Vec3 way;
    if (sensor != PointCloud::no_sensor)
      way = cloud.sensors[sensor].at_infinity ? cloud.sensors[sensor].place
                                              : cloud.sensors[sensor].place - cloud.points[row];
    const double length = norm(way);
    view.push_back(length > 0 ? (1 / length) * way : Vec3{});
  }
  return view;
}

/// Flips edges where no noise was measured: elsewhere it hides which way the surface bends.
EdgeFlipCounts flip_clean_edges(Surface& surface, const PointCloud& cloud, const Scene& scene, const Threads& threads) {
  const SampleModel& model = scene.measures.model;
  const std::vector<float> noise =
      noise_to_fit(surface, SurfaceFans(surface.mesh), model, SurfaceKind::automatic, threads);
  std::vector<float> longest(surface.mesh.vertices.size());
  for_each_index(threads, longest.size(), [&](std::size_t v) {
    const bool clean = noise.empty() || noise[v] <= 0;
    longest[v] = clean ? static_cast<float>(longest_kept) * model.spacing[surface.sample_of[v]] : 0;
  });
  return flip_edges(std::move(longest), views_of(surface, cloud, scene.tetrahedralization), surface, threads);
}

/// Fits and smoothes, and sees that nothing crosses. \return whether the vertices, in input coordinates then, moved
bool move_vertices(Surface& surface, const PointCloud& cloud, const Scene& scene, const Context& context) {
  const auto& [options, run, threads] = context;
  run.report().moved.reset();
  const bool may_fit = options.surface == SurfaceKind::automatic || options.surface == SurfaceKind::fitted;
  if (!may_fit && options.smooth == 0) return false;
  const Tetrahedralization& t = scene.tetrahedralization;
  std::optional<SurfaceFans> fans;
  std::vector<std::uint32_t> strays;
  bool fitted = false;
  if (may_fit)
    run.stage("fit", [&] {
      fans.emplace(surface.mesh);
      // What a scanner saw is somewhere, however lonely it is.
      if (cloud.sensor_of.empty() && !scene.measures.trusts_all)
        strays = strays_on_bridges(surface, *fans, scene.measures.model, threads);
      fitted = fit(surface, *fans, SamplePlaces(scene, cloud, threads).all(), scene.measures.model, options.surface,
                   strays, threads);
    });
  const std::vector<Vec3> rows = input_points(surface.sample_of, t, cloud); // not before the fit, which takes memory
  const std::vector<Vec3> before = triangulated_places(surface, t, rows);
  if (!fitted && before == rows && options.smooth == 0) return false;
  if (options.smooth > 0)
    run.stage("smoothing", [&] {
      if (!fans) fans.emplace(surface.mesh);
      smooth(surface.mesh, options.smoothing, options.smooth, threads);
      to_input_coordinates(surface, t, rows); // where this rounds, neighbours could meet
      return take_back_turned(before, *fans, surface.mesh, threads);
    });
  else
    to_input_coordinates(surface, t, rows);
  std::uint64_t crossing = 0;
  run.stage("crossings", [&] {
    const UncrossCounts counts = settle_moved(before, rows, scene.measures.model, *fans, surface.mesh, threads);
    crossing = counts.left;
    return counts;
  });
  run.report().moved = moved_report(rows, surface.mesh.vertices, strays);
  run.report().moved->crossing = crossing;
  return true;
}

} // namespace

TriangleMesh finish(Surface surface, const PointCloud& cloud, const Scene& scene, const Context& context) {
  const auto& [options, run, threads] = context;
  bool moved = move_vertices(surface, cloud, scene, context);
  // Crusts are no manifolds, and are there to be compared with.
  if (options.method == Method::eigencrust && options.surface != SurfaceKind::delaunay)
    run.stage("edges", [&] { return flip_clean_edges(surface, cloud, scene, threads); });
  run.report().simplified.reset();
  if (asks_for_other_triangles(options)) {
    const Tetrahedralization& t = scene.tetrahedralization;
    if (!moved) to_input_coordinates(surface, t, input_points(surface.sample_of, t, cloud));
    moved = true;
    make_other_triangles(surface, scene.measures.model, context);
  }
  std::optional<Base>& base = run.report().base;
  base.reset();
  if (options.base) base = put_on_base(surface, scene, moved, run.report().surroundings.front);
  TriangleMesh mesh = run.stage("attributes", [&] {
    return finish_mesh(surface, scene.tetrahedralization, cloud, moved, base ? base->vertices : 0);
  });
  run.product("mesh", [&] { return snapshot_of_mesh(mesh, surface); });
  return mesh;
}

void check(const TriangleMesh& mesh, const PointCloud& cloud, const Scene& scene, const ValidateOptions& checks,
           const Context& context) {
  const auto& [options, run, threads] = context;
  run.stage("validate", [&] {
    // Faces of one Delaunay tetrahedralization do not cross, unless they were moved, and then tested, or rounded
    // (docs/guarantees.md).
    const std::optional<MovedReport>& moved = run.report().moved;
    const std::optional<SimplifiedReport>& simplified = run.report().simplified;
    const bool cannot_cross = checks.self_intersections && !options.base &&
                              (simplified ? simplified->crossing == 0
                               : moved    ? moved->crossing == 0
                                          : is_exact_translation(scene.tetrahedralization, cloud, threads));
    ValidateOptions needed = checks;
    needed.self_intersections = checks.self_intersections && !cannot_cross;
    needed.merge_equal_vertices = checks.merge_equal_vertices && !cannot_cross; // samples differ, so vertices do
    MeshSummary summary = validate(mesh, needed, threads);
    if (cannot_cross) summary.self_intersections = 0;
    return summary;
  });
}

} // namespace eigencrust
