// SPDX-License-Identifier: GPL-3.0-or-later
#include "settle/settle.h"

#include "report/snapshots.h"

namespace eigencrust {
namespace {

Energy energy_of(const Scene& scene, const Evidence& evidence, const PoleLabels& poles, const Threads& threads) {
  const Tetrahedralization& t = scene.tetrahedralization;
  const NoisePlanes planes(t, scene.poles, poles.labels, scene.measures.model, threads);
  const DataTerms data(t, scene.poles, poles, planes, scene.measures.isolated(), evidence.sight.get(),
                       evidence.hidden.get());
  return make_energy(t, data, evidence.named, threads);
}

/// What parts have in common where they overlap becomes inside. The energy changes with it: of a sample in the solid
/// both poles are inside.
Overlaps fill_overlaps(const Scene& scene, const Evidence& evidence, const PoleLabels& poles, const Threads& threads,
                       Settled& settled) {
  Overlaps overlaps = find_overlaps(scene, evidence, settled.labels.labels(), threads);
  if (overlaps.chambers == 0) return overlaps;
  settled.energy = {}; // makes room
  PoleLabels filled = poles;
  for (const TetrahedronIndex i : overlaps.tetrahedra) {
    if (filled.labels[i] != Label::outside) continue;
    filled.labels[i] = Label::inside;
    filled.trust[i] = full_trust;
  }
  settled.energy = energy_of(scene, evidence, filled, threads);
  settled.labels = minimum_of(scene.tetrahedralization, settled.energy, threads).labels;
  return overlaps;
}

/// §3.4 as in the paper, or with both supernodes fixed. The second graph is gone when this returns: it needs most
/// memory of all.
TetrahedronLabels partition_rest(const Scene& scene, const PoleLabels& poles, const Context& context) {
  const auto& [options, run, threads] = context;
  TetrahedronGraph h = run.stage(
      "tetrahedron_graph", [&] { return tetrahedron_graph(scene.tetrahedralization, poles.labels, context.threads); });
  const Partition solution = run.stage("partition_tetrahedra", [&] {
    return partition_tetrahedra(std::move(h.graph), context.options.second_stage, context.options.solver,
                                context.threads, context.run.checkpoint());
  });
  return run.stage("label_tetrahedra", [&] { return label_tetrahedra(h, solution, poles.labels); });
}

} // namespace

Settled settle(const Scene& scene, const Evidence& evidence, const PoleLabels& poles, const Context& context) {
  const auto& [options, run, threads] = context;
  const Tetrahedralization& t = scene.tetrahedralization;
  Settled settled;
  settled.energy = run.stage("energy", [&] { return energy_of(scene, evidence, poles, threads); });
  if (options.second_stage == SecondStage::cut) {
    settled.labels = run.stage("minimum_cut", [&] { return minimum_of(t, settled.energy, threads); }).labels;
    settled.overlaps = run.stage("overlaps", [&] { return fill_overlaps(scene, evidence, poles, threads, settled); });
  } else {
    settled.labels = partition_rest(scene, poles, context);
  }
  run.product("tetrahedra", [&] { return snapshot_of_tetrahedra(t, settled.labels); });
  return settled;
}

} // namespace eigencrust
