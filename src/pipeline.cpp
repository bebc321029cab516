// SPDX-License-Identifier: GPL-3.0-or-later
// The paper on one page. § numbers: Kolluri, Shewchuk, O'Brien, Spectral Surface Reconstruction from
// Noisy Point Clouds (SGP 2004).
#include <eigencrust/eigencrust.h>
#include <eigencrust/memory_forecast.h>
#include <eigencrust/stages.h>

#include "parallel/threads.h"
#include "pipeline.h"
#include "points/point_results.h"
#include "report/output.h"
#include "report/run.h"
#include "report/snapshots.h"

namespace eigencrust {

FirstHalf first_half(const PointCloud& cloud, const Options& options, Run& run, Report& report,
                     const Threads& threads) {
  FirstHalf half;
  Samples samples = run.stage("samples", [&] { return prepare_samples(cloud.points, threads); });
  describe_input(cloud, samples, report);

  // §3: S+ = samples and cube corners, T = Delaunay(S+). Beside it: how close the samples stand; §3.3: ℓ, of the
  // whole cloud or of each sample
  half.t = triangulate_and_measure(cloud, std::move(samples), run, report, threads, half.measures);
  const Tetrahedralization& t = half.t;
  const auto& [around, isolated, grid, reach] = half.measures;
  describe_noise(grid, run);
  run.count("delaunay", "tetrahedra", t.tetrahedra.size());
  half.stars = run.stage("stars", [&] { return vertex_stars(t, threads); });
  const VertexStars& stars = half.stars;
  half.poles = run.stage("poles", [&] { return find_poles(t, stars, reach, threads); });
  const Poles& poles = half.poles;
  run.count("poles", poles.tetrahedron.size());

  // §3.1: what is known beforehand, and the pole graph G
  half.known.named = run.stage("evidence", [&] {
    Labels labels = known_labels(t, options.outside_points, options.inside_points, options.facade, threads);
    name_poles(t, poles, options.outside_points, options.inside_points, threads, labels);
    return labels;
  });
  const Labels& named = half.known.named;
  half.known.labels = named;
  if (!cloud.sensor_of.empty()) {
    const SightLabels sight = run.stage("line_of_sight", [&] {
      const auto depth = crossing_depths(grid, options, report.spacing, t.sample_count);
      const auto lines = sight_lines(cloud, t, depth, isolated);
      if (options.detect_facade) report.one_sided = one_sided_scan(t, lines);
      half.crossings = sight_crossings(t, stars, lines, options.weights, named, threads);
      return line_of_sight(t, stars, lines, half.crossings,
                           {options.crossing_count, options.behind_count, options.weights, isolated}, named, threads);
    });
    describe_sight(half.crossings, sight, named, run, report);
    half.known.labels = sight.labels;
  }
  half.questionable = run.stage("questionable", [&] { return questionable_tetrahedra(t, grid, threads); }); // §3.3
  const bool leave_out = options.questionable == Questionable::before;
  half.graph = run.stage("pole_graph", [&] {
    const auto left_out =
        leave_out ? std::span<const std::uint8_t>(half.questionable) : std::span<const std::uint8_t>{};
    return pole_graph(t, stars, poles, half.known.labels, left_out, isolated, threads);
  });

  // §3.2: the eigenvector of the smallest eigenvalue of L x = λ D x labels the poles
  half.first = run.stage("partition_poles", [&] {
    return partition_poles(half.graph, options.solver, threads, &half.component, run.checkpoint());
  });
  describe_partition("poles", edge_count(half.graph.graph), half.first, run, report);
  return half;
}

void second_half(const PointCloud& cloud, const FirstHalf& half, FirstHalf* spendable, const Known& before,
                 const Partition& first, const SecondSolve& solve, const ValidateOptions& checks, Run& run,
                 Result& result, const Threads& threads) {
  Report& report = result.report;
  const Options& options = report.options;
  const Tetrahedralization& t = half.t;
  const VertexStars& stars = half.stars;
  const Poles& poles = half.poles;
  const PoleGraph& g = half.graph;
  const auto& [around, isolated, grid, reach] = half.measures;
  const Labels &named = before.named, &known = before.labels;

  PoleLabels pole_labels = run.stage("label_poles", [&] {
    return label_poles(t, stars, poles, g, first, half.component, known, options.global_sign, options.min_agreement,
                       threads);
  });
  describe_pole_labels(pole_labels, run);
  run.product("poles", [&] { return snapshot_of_poles(t, poles, g, first, pole_labels.labels); });
  if (options.questionable == Questionable::after) // §3.3
    run.count("labels_removed",
              static_cast<double>(unlabel_questionable(half.questionable, known, pole_labels.labels)));

  // What is over gives its memory back; the second partition needs most of all.
  if (spendable) {
    spendable->graph = {};
    spendable->first = {};
    spendable->component = {};
  }
  // §3.4: the second graph H labels the rest
  TetrahedronGraph h = run.stage("tetrahedron_graph", [&] {
    return tetrahedron_graph(t, poles, pole_labels.labels, options.pole_ties, reach, threads);
  });
  const std::uint64_t edges = edge_count(h.graph);
  if (spendable) {
    spendable->poles.sphere = {};
    spendable->stars = {}; // quickly made again
  }
  Partition second = run.stage("partition_tetrahedra", [&] { return solve(h); });
  describe_partition("tetrahedra", edges, second, run, report);
  FinalLabels labels = run.stage("label_tetrahedra", [&] { return label_tetrahedra(h, second, pole_labels.labels); });
  h = {};
  second = {};
  if (spendable) spendable->stars = vertex_stars(t, threads);
  if (options.centring) {
    const auto moved = run.stage(
        "centring", [&] { return centre_in_noise(t, stars, reach, isolated, pole_labels.labels, threads, labels); });
    run.count("relabelled", static_cast<double>(moved));
  }
  run.product("tetrahedra", [&] { return snapshot_of_tetrahedra(t, labels); });
  describe_labels(labels, run);

  // §3.5, §3: manifold, surface
  if (options.manifold) {
    const auto counts = run.stage("manifold", [&] {
      return make_manifold(t, stars, poles, named, options.manifold_rule, labels, threads, run.checkpoint());
    });
    describe_manifold(counts, named, labels.labels, run);
  }
  if (options.manifold && options.close_handles) {
    const auto closed = run.stage("handles", [&] {
      return close_handles(t, stars, poles, pole_labels.labels, named, grid, options.manifold_rule, labels, threads,
                           run.checkpoint());
    });
    run.count("closed", static_cast<double>(closed));
  }
  const auto recovered = run.stage(
      "recover", [&] { return recover_samples(t, stars, known, isolated, options.recover_share, labels.labels); });
  run.count("samples", static_cast<double>(recovered));
  if (options.manifold && !isolated.empty()) {
    const auto cut = run.stage("spikes", [&] {
      return cut_spikes(t, stars, poles, pole_labels.labels, named, around, grid, options.manifold_rule, labels);
    });
    run.count("cut", static_cast<double>(cut));
  }
  if (report.sight_lines > 0)
    describe_contradictions(contradicting_lines(half.crossings, labels.labels, threads), run, report);
  Surface surface = run.stage("surface", [&] { return extract_surface(t, labels.labels, threads); });
  run.product("surface", [&] { return snapshot_of_surface(t, surface); });
  run.stage("support", [&] { measure_support(t, labels, around, grid, surface, threads); });
  report.dropped_components =
      run.stage("components", [&] { return filter_components(surface, options.components, t, grid, threads); });
  require_surface(surface);
  const bool one_sided = options.facade.has_value() || report.one_sided.has_value();
  std::vector<std::uint8_t> unsupported = run.stage(
      "trim", [&] { return unsupported_triangles(t, around, rays_of(cloud, t), one_sided, surface, threads); });
  describe_unsupported(surface, unsupported, run, report);
  if (options.trim) {
    trim(std::move(unsupported), surface);
    for (const DroppedComponent& piece : filter_components(surface, options.components, t, grid, threads))
      report.dropped_components.push_back(piece);
    require_trimmed(surface);
  }
  if (options.point_results) {
    run.stage("points", [&] { add_point_results(cloud, t, surface, grid, threads, result); });
    run.count("inliers", static_cast<double>(std::count(result.inlier.begin(), result.inlier.end(), 1)));
  }
  if (options.smooth > 0) // §3.6
    run.stage("smoothing", [&] { smooth(surface.mesh, options.smoothing, options.smooth, threads); });

  result.mesh = run.stage("attributes", [&] { return finish_mesh(surface, t, cloud, options.smooth > 0); });
  report.mesh = run.stage("validate", [&] {
    // Faces of one Delaunay tetrahedralization do not cross, unless they were moved or rounded (docs/guarantees.md).
    const bool cannot_cross =
        checks.self_intersections && options.smooth == 0 && is_exact_translation(t, cloud, threads);
    ValidateOptions needed = checks;
    needed.self_intersections = checks.self_intersections && !cannot_cross;
    needed.merge_equal_vertices = checks.merge_equal_vertices && !cannot_cross; // samples differ, so vertices do
    MeshSummary summary = validate(result.mesh, needed);
    if (cannot_cross) summary.self_intersections = 0;
    return summary;
  });
  report.broken_guarantees = broken_guarantees(report.mesh, options);
  result.labels = std::move(labels.labels);
}

Result reconstruct(const PointCloud& cloud, const Options& options, Observer& observer) {
  check_options(options);
  check_cloud(cloud);
  check_memory(cloud, options.max_memory);
  const auto start = std::chrono::steady_clock::now();
  Result result;
  result.report.options = options;
  const Threads threads(options.threads);
  Run run(result.report, observer);
  FirstHalf half = first_half(cloud, options, run, result.report, threads);
  const SecondSolve solve = [&](TetrahedronGraph& h) {
    return partition_tetrahedra(std::move(h.graph), options.second_stage, options.solver, threads, run.checkpoint());
  };
  second_half(cloud, half, &half, half.known, half.first, solve, {.threads = options.threads}, run, result, threads);
  result.tetrahedralization = std::move(half.t);
  result.report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  result.report.peak_memory_bytes = peak_memory_bytes();
  return result;
}

} // namespace eigencrust
