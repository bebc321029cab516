// SPDX-License-Identifier: GPL-3.0-or-later
#include "repair/repair.h"

#include "repair/generators.h"
#include "repair/passed_sheets.h"

namespace eigencrust {

TetrahedronLabels repair(const Scene& scene, const Evidence& evidence, Settled settled, const Context& context) {
  const auto& [options, run, threads] = context;
  const auto& [t, rows, stars, measures, poles] = scene;
  TetrahedronLabels& labels = settled.labels;
  if (options.manifold && options.manifold_rule == ManifoldRule::paper)
    run.stage("manifold",
              [&] { return make_manifold(t, stars, poles, settled.energy.known, labels, threads, run.checkpoint()); });
  if (options.manifold && options.manifold_rule == ManifoldRule::cheapest) {
    Moves moves({t, stars, settled.energy, measures.model, threads}, labels);
    run.stage("manifold", [&] { return moves.make_manifold(run.checkpoint()); });
    run.stage("sheets", [&] { return passed_sheets(moves); });
    run.stage("handles", [&] { return close_handles(moves, run.checkpoint()); });
    run.stage("pieces", [&] { return drop_pieces(moves); });
    run.stage("recover", [&] { return recover_samples(moves); });
    moves.settle_values();
    run.count("energy", settled.energy.of(t, labels.labels(), threads));
  }
  describe(contradictions(evidence, labels.labels(), threads), run);
  return std::move(labels);
}

} // namespace eigencrust
