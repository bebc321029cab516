// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A stage for the engine of moves, made by hand.
#pragma once

#include <utility>

#include <eigencrust/validate.h>

#include "clouds.h"
#include "repair/generators.h"

namespace eigencrust::clouds {

/// Labels, with an energy whose data term says what they are, and a model of samples without noise.
struct MoveStage {
  Threads threads;
  Prepared p;
  TetrahedronLabels labels;
  Energy energy;
  SampleModel model;

  /// \param spacing of all samples
  MoveStage(Prepared prepared, TetrahedronLabels sides, double spacing, unsigned team = 2)
      : threads(team), p(std::move(prepared)), labels(std::move(sides)) {
    energy.faces = FaceWeights(p.t, {}, threads);
    energy.data = labels.values();
    energy.known = p.known;
    model.spacing = SampleLengths(p.t.sample_count, static_cast<float>(spacing));
    model.noise = model.input_noise = SampleLengths(p.t.sample_count, 0.0f);
    model.isolated = SampleLengths(p.t.sample_count, 0.0f);
    model.typical_spacing = spacing;
  }
  [[nodiscard]] Moves moves() { return {{p.t, p.stars, energy, model, threads}, labels}; }
  [[nodiscard]] double energy_now() const { return energy.of(p.t, labels.labels(), threads); }
  [[nodiscard]] Surface surface() const { return extract_surface(p.t, labels.labels(), threads); }
  [[nodiscard]] MeshSummary summary() const {
    return validate(surface().mesh, {.self_intersections = false, .merge_equal_vertices = false});
  }
  [[nodiscard]] bool on_surface(SampleIndex s) const {
    const std::vector<SampleIndex> samples = surface().sample_of;
    return std::find(samples.begin(), samples.end(), s) != samples.end();
  }
};

inline MeshSummary summary_of(const Tetrahedralization& t, const Labels& labels) {
  return validate(extract_surface(t, labels, Threads(2)).mesh,
                  {.self_intersections = false, .merge_equal_vertices = false});
}
inline bool is_closed_manifold(const MeshSummary& summary) {
  return summary.triangles == 0 || (summary.closed() && summary.manifold() && summary.oriented());
}

} // namespace eigencrust::clouds
