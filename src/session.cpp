// SPDX-License-Identifier: GPL-3.0-or-later
#include <eigencrust/memory_forecast.h>
#include <eigencrust/session.h>

#include "evidence/evidence.h"
#include "invariants.h"
#include "numerics/spreading.h"
#include "points/point_results.h"
#include "poles/solve.h"
#include "repair/repair.h"
#include "samples/check_cloud.h"
#include "settle/settle.h"
#include "surface/surface.h"
#include "tetrahedra/scene.h"

namespace eigencrust {
namespace {

Options without_points(Options options) {
  options.outside_points.clear();
  options.inside_points.clear();
  return options;
}

} // namespace

/// What does not hang on the points that are named: the scene, the pole graph and its solution.
struct Session::Kept {
  Kept(PointCloud points, const Options& all, Observer& observer) : cloud(std::move(points)), options(all) {
    check_options(options);
    check_cloud(cloud);
    check_memory(cloud, options.max_memory);
    report.options = options;
    const Options unnamed = without_points(options);
    Run run(report, observer);
    const Threads threads(options.threads, run.cancellation());
    const Context context{unnamed, run, threads};
    scene = make_scene(cloud, context);
    EIGENCRUST_SOUND(scene, cloud);
    evidence = gather_evidence(cloud, scene, context);
    EIGENCRUST_SOUND(evidence, scene);
    solved = solve_poles(scene, evidence, context);
    EIGENCRUST_SOUND(solved.graph.graph);
    report.stages.clear();
    measure_sides(threads);
    node_of =
        IndexedArray<TetrahedronIndex, std::uint32_t>(scene.tetrahedralization.tetrahedra.size(), NodeIndex::none);
    for (PoleIndex p{0}; p.value < solved.graph.node.size(); ++p.value)
      node_of[scene.poles.tetrahedron[p]] = solved.graph.node[p].value;
  }

  /// The first partition as it follows from more evidence.
  Partition adapted_to(const Evidence& more) const {
    Partition first = solved.partition;
    Spreading spreading(solved.graph.graph, first);
    for (std::uint32_t i = 0; i < more.named.size(); ++i) {
      const Label label = more.named.raw()[i];
      const std::uint32_t node = node_of.raw()[i];
      if (label == evidence.named.raw()[i] || node == NodeIndex::none) continue;
      if (outside_value == 0 || solved.component[node] != 0) continue;
      spreading.hold(node, label == Label::outside ? outside_value : inside_value);
    }
    spreading.run();
    return first;
  }

  PointCloud cloud;
  Options options;
  Report report;
  Scene scene;
  Evidence evidence;
  PoleSolution solved;
  float outside_value = 0, inside_value = 0; ///< of nodes of the pole graph that are as good as the supernodes
  IndexedArray<TetrahedronIndex, std::uint32_t> node_of;

 private:
  void measure_sides(const Threads& threads) {
    const PoleLabels labels = label_poles(scene.tetrahedralization, scene.poles, solved.graph, solved.partition,
                                          solved.component, evidence.labels, options.global_sign, threads);
    const auto& supers = solved.partition.supernode_value;
    outside_value = supers.empty() ? 0 : static_cast<float>(labels.reversed ? -supers[0] : supers[0]);
    inside_value = supers.size() > 1 ? static_cast<float>(supers[1]) : -outside_value;
  }
};

Session::Session(PointCloud cloud, const Options& options, Observer& observer)
    : kept_(std::make_unique<Kept>(std::move(cloud), options, observer)) {}
Session::~Session() = default;
Session::Session(Session&&) noexcept = default;
Session& Session::operator=(Session&&) noexcept = default;

const Tetrahedralization& Session::tetrahedralization() const { return kept_->scene.tetrahedralization; }
const PointCloud& Session::cloud() const { return kept_->cloud; }

Result Session::label(std::span<const Vec3> outside_points, std::span<const Vec3> inside_points, Observer& observer) {
  const PointCloud& cloud = kept_->cloud;
  const Scene& scene = kept_->scene;
  Result result;
  result.report = kept_->report;
  Options& options = result.report.options;
  options.outside_points.insert(options.outside_points.end(), outside_points.begin(), outside_points.end());
  options.inside_points.insert(options.inside_points.end(), inside_points.begin(), inside_points.end());
  check_options(options);
  Run run(result.report, observer);
  const Threads threads(options.threads, run.cancellation());
  const Context context{options, run, threads};

  Evidence evidence;
  Partition first;
  run.stage("evidence", [&] {
    evidence = with_points(kept_->evidence, scene, context);
    first = kept_->adapted_to(evidence);
  });
  EIGENCRUST_SOUND(evidence, scene);
  const auto poles = label_poles(scene, evidence, kept_->solved, first, context);
  EIGENCRUST_SOUND(poles, scene, evidence);
  auto settled = settle(scene, evidence, poles, context);
  EIGENCRUST_SOUND(settled, scene, options);
  const auto overlaps = std::move(settled.overlaps);
  auto labels = repair(scene, evidence, std::move(settled), context);
  EIGENCRUST_SOUND(labels, scene, options);
  auto surface = make_surface(cloud, scene, evidence, labels, overlaps, context);
  EIGENCRUST_SOUND(surface, scene, labels, options);
  auto points = point_results(cloud, scene, surface, context);
  result.mesh = finish(std::move(surface), cloud, scene, context);
  check(result.mesh, cloud, scene, {.self_intersections = result.report.moved.has_value()}, context);

  run.end();
  result.labels = std::move(labels).labels();
  result.inlier = std::move(points.inlier);
  result.confidence = std::move(points.confidence);
  result.normals = std::move(points.normals);
  return result;
}

} // namespace eigencrust
