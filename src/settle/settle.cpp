// SPDX-License-Identifier: GPL-3.0-or-later
#include "settle/settle.h"

#include "report/snapshots.h"
#include "settle/centring.h"

namespace eigencrust {
namespace {

TetrahedronGraph graph_of(const Scene& scene, const PoleLabels& poles, const Context& context) {
  return context.run.stage("tetrahedron_graph", [&] {
    return tetrahedron_graph(scene.tetrahedralization, scene.poles, poles.labels, context.options.pole_ties,
                             scene.measures.reach, context.threads);
  });
}

Partition solution_of(SignedGraph graph, const Context& context) {
  const auto& [options, run, threads] = context;
  return partition_tetrahedra(std::move(graph), options.second_stage, options.solver, threads, run.checkpoint());
}

/// The second graph is gone when this returns: it needs most memory of all.
TetrahedronLabels label_rest(const Scene& scene, const PoleLabels& poles, const KeptSolution& kept,
                             const Context& context) {
  Run& run = context.run;
  TetrahedronGraph h = graph_of(scene, poles, context);
  const Partition solution = run.stage("partition_tetrahedra", [&] {
    return kept.empty() ? solution_of(std::move(h.graph), context) : kept.adapted_to(h);
  });
  return run.stage("label_tetrahedra", [&] { return label_tetrahedra(h, solution, poles.labels); });
}

} // namespace

KeptSolution keep_solution(const Scene& scene, const PoleLabels& poles, const Context& context) {
  const TetrahedronGraph graph = graph_of(scene, poles, context);
  const Partition solution =
      context.run.stage("partition_tetrahedra", [&] { return solution_of(graph.graph, context); });
  return {graph, solution, scene.tetrahedralization.tetrahedra.size()};
}

TetrahedronLabels settle(const Scene& scene, const PoleLabels& poles, const Context& context,
                         const KeptSolution& kept) {
  const auto& [options, run, threads] = context;
  TetrahedronLabels labels = label_rest(scene, poles, kept, context);
  if (options.centring)
    run.stage("centring", [&] {
      return centre_in_noise(scene.tetrahedralization, scene.stars, scene.measures.reach, scene.measures.isolated,
                             poles.labels, threads, labels);
    });
  run.product("tetrahedra", [&] { return snapshot_of_tetrahedra(scene.tetrahedralization, labels); });
  return labels;
}

} // namespace eigencrust
