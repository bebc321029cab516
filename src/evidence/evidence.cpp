// SPDX-License-Identifier: GPL-3.0-or-later
#include "evidence/evidence.h"
#include "evidence/contradictions.h"
#include "evidence/named_points.h"
#include "evidence/surroundings.h"
#include "evidence/walls.h"

#include <algorithm>

namespace eigencrust {
namespace {

Labels named_labels(const Scene& scene, const Surroundings& surroundings,
                    const std::vector<TetrahedronIndex>& beyond_walls, const Options& options, const Threads& threads) {
  const Tetrahedralization& t = scene.tetrahedralization;
  Labels labels =
      known_labels(t, scene.stars, options.outside_points, options.inside_points, surroundings, threads, beyond_walls);
  name_poles(t, scene.poles, options.outside_points, options.inside_points, threads, labels);
  return labels;
}

/// How far in front of each sample a tetrahedron must begin to count as crossed.
SampleLengths crossing_depths(const SampleModel& model, const Options& options) {
  if (options.crossing_depth) return SampleLengths(model.spacing.size(), static_cast<float>(*options.crossing_depth));
  // Nearer than that the line runs within what the sample itself is uncertain by.
  SampleLengths depth(model.spacing.size());
  for (SampleIndex s{0}; s.value < depth.size(); ++s.value)
    depth[s] = std::max(model.spacing[s] / 2, noise_bound * model.noise[s]);
  return depth;
}

LinesOfSight follow_lines(const PointCloud& cloud, const Scene& scene, const Labels& named, const Options& options,
                          const Threads& threads) {
  const auto& [t, rows, stars, measures, poles] = scene;
  const auto depth = crossing_depths(measures.model, options);
  const auto lines = sight_lines(cloud, rows, t, depth, measures.isolated());
  LinesOfSight sight;
  if (options.detect_facade) sight.one_sided = one_sided_scan(t, lines);
  sight.crossings = sight_crossings(t, stars, lines, options.weights, named, threads);
  const SightRule rule{options.weights, measures.isolated()};
  sight.labels = line_of_sight(t, stars, lines, sight.crossings, rule, named, threads);
  return sight;
}

/// Of a façade without sensors: what its samples hide, and what lies beyond its walls.
void look_along(const Scene& scene, const Options& options, const Threads& threads, KnownBeforehand& known) {
  const SampleLengths depth = crossing_depths(scene.measures.model, options);
  const Vec3 front = direction_of(known.surroundings.front);
  const Labels at_cube =
      known_labels(scene.tetrahedralization, scene.stars, {}, {}, known.surroundings, threads); // whatever is named
  HiddenCounts hidden = count_hidden(scene, front, depth, at_cube, threads);
  const bool has_paper_weights = options.weights == Weights::paper;
  if (!has_paper_weights) known.beyond_walls = beyond_walls(scene, front, hidden, at_cube);
  known.labels = known.named = named_labels(scene, known.surroundings, known.beyond_walls, options, threads);
  if (!has_paper_weights && is_seen_along(scene, known.surroundings.front, threads))
    label_hidden(hidden, known.labels);
  else // no sample is known to have been seen along the axis
    for (std::int16_t& count : hidden.raw()) count = std::max<std::int16_t>(count, 0);
  known.hidden = std::make_shared<const HiddenCounts>(std::move(hidden));
}

KnownBeforehand what_is_known(const PointCloud& cloud, const Scene& scene, const Options& options,
                              const Threads& threads) {
  KnownBeforehand known;
  known.surroundings = surroundings_of(cloud, scene, options, threads);
  if (known.surroundings.kind == SceneKind::facade && cloud.sensor_of.empty())
    look_along(scene, options, threads, known);
  else
    known.labels = known.named = named_labels(scene, known.surroundings, {}, options, threads);
  return known;
}

} // namespace

Evidence gather_evidence(const PointCloud& cloud, const Scene& scene, const Context& context) {
  const auto& [options, run, threads] = context;
  Evidence evidence;
  KnownBeforehand known = run.stage("evidence", [&] { return what_is_known(cloud, scene, options, threads); });
  evidence.surroundings = known.surroundings;
  evidence.named = std::move(known.named);
  evidence.labels = std::move(known.labels);
  evidence.hidden = std::move(known.hidden);
  evidence.beyond_walls = std::move(known.beyond_walls);
  if (cloud.sensor_of.empty()) return evidence;
  LinesOfSight sight =
      run.stage("line_of_sight", [&] { return follow_lines(cloud, scene, evidence.named, options, threads); });
  evidence.labels = std::move(sight.labels.labels);
  evidence.sight = std::make_shared<const SightLabels>(std::move(sight.labels));
  evidence.crossings = std::make_shared<const SightCrossings>(std::move(sight.crossings));
  evidence.one_sided = sight.one_sided;
  return evidence;
}

Evidence with_points(const Evidence& before, const Scene& scene, const Context& context) {
  Evidence evidence = before;
  evidence.named = named_labels(scene, before.surroundings, before.beyond_walls, context.options, context.threads);
  for (std::uint32_t i = 0; i < evidence.named.size(); ++i) {
    const Label label = evidence.named.raw()[i];
    if (label != before.named.raw()[i]) evidence.labels.raw()[i] = label;
  }
  return evidence;
}

Contradictions contradictions(const Evidence& evidence, const Labels& labels, const Threads& threads) {
  if (!evidence.crossings) return {};
  return {contradicting_lines(*evidence.crossings, labels, threads), evidence.crossings->begin.size() - 1};
}

} // namespace eigencrust
