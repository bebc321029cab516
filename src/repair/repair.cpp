// SPDX-License-Identifier: GPL-3.0-or-later
#include "repair/repair.h"
#include "repair/handles.h"
#include "repair/recover.h"
#include "repair/spikes.h"

namespace eigencrust {
namespace {

constexpr double most_passed = 0.04; // of the samples on the surface (docs/decisions/0007)

} // namespace

TetrahedronLabels repair(const Scene& scene, const Evidence& evidence, const PoleLabels& first, Settled settled,
                         const Context& context) {
  const auto& [options, run, threads] = context;
  const auto& [t, rows, stars, measures, poles] = scene;
  TetrahedronLabels& labels = settled.labels;
  const Labels& named = evidence.named;
  const ManifoldRule rule = options.manifold_rule;
  if (options.manifold)
    run.stage("manifold",
              [&] { return make_manifold(t, stars, poles, named, rule, labels, threads, run.checkpoint()); });
  if (options.manifold && options.manifold_rule == ManifoldRule::cheapest)
    run.stage("handles", [&] {
      return close_handles(t, stars, poles, first.labels, named, measures.grid, rule, labels, threads,
                           run.checkpoint());
    });
  run.stage("recover", [&] {
    return recover_samples(t, stars, evidence.labels, measures.isolated,
                           options.manifold_rule == ManifoldRule::cheapest ? most_passed : 0, labels);
  });
  if (options.manifold && !measures.isolated.empty())
    run.stage("spikes", [&] {
      return cut_spikes(t, stars, poles, first.labels, named, measures.around, measures.grid, rule, labels);
    });
  describe(contradictions(evidence, labels.labels(), threads), run);
  return std::move(labels);
}

} // namespace eigencrust
