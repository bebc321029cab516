// SPDX-License-Identifier: GPL-3.0-or-later
#include "poles/solve.h"

#include "report/snapshots.h"

namespace eigencrust {

PoleSolution solve_poles(const Scene& scene, const Evidence& evidence, const Context& context) {
  const auto& [options, run, threads] = context;
  const auto& [t, rows, stars, measures, poles] = scene;
  PoleSolution solved;
  solved.questionable =
      run.stage("questionable", [&] { return questionable_tetrahedra(t, measures.grid, threads); }); // §3.3
  std::span<const std::uint8_t> left_out;
  if (options.questionable == Questionable::before) left_out = solved.questionable;
  solved.graph = run.stage("pole_graph", [&] { // §3.1
    return pole_graph(t, stars, poles, evidence.labels, left_out, {measures.isolated(), measures.noisy()},
                      options.weights == Weights::evidence, threads);
  });
  solved.partition = run.stage("partition_poles", [&] { // §3.2
    return partition_poles(solved.graph, options.solver, options.weights == Weights::evidence, threads,
                           &solved.component, run.checkpoint());
  });
  return solved;
}

PoleLabels label_poles(const Scene& scene, const Evidence& evidence, const PoleSolution& solved,
                       const Partition& partition, const Context& context) {
  const auto& [options, run, threads] = context;
  const auto& [t, rows, stars, measures, poles] = scene;
  PoleLabels result = run.stage("label_poles", [&] {
    return label_poles(t, poles, solved.graph, partition, solved.component, evidence.labels, options.global_sign,
                       threads);
  });
  run.product("poles", [&] { return snapshot_of_poles(t, poles, solved.graph, partition, result.labels); });
  if (options.questionable == Questionable::after) // §3.3
    run.count("labels_removed",
              static_cast<double>(unlabel_questionable(solved.questionable, evidence.labels, result.labels)));
  return result;
}

PoleLabels label_poles(const Scene& scene, const Evidence& evidence, const Context& context) {
  const PoleSolution solved = solve_poles(scene, evidence, context);
  return label_poles(scene, evidence, solved, solved.partition, context);
}

} // namespace eigencrust
