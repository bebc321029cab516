// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What is known beforehand of each tetrahedron (§3.1).
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <eigencrust/stages.h>

#include "evidence/hidden.h"
#include "report/context.h"
#include "tetrahedra/scene.h"

namespace eigencrust {

/// What the lines of sight say.
struct LinesOfSight {
  SightCrossings crossings;
  SightLabels labels;
  std::optional<OneSided> one_sided;
};

/// What is known without the lines of sight.
struct KnownBeforehand {
  Surroundings surroundings;
  Labels named;                               ///< from the cube and the user's points
  Labels labels;                              ///< and from what a façade that was seen along its axis hides
  std::shared_ptr<const HiddenCounts> hidden; ///< see Evidence
  std::vector<TetrahedronIndex> beyond_walls; ///< see Evidence
};

struct Evidence {
  Surroundings surroundings;
  Labels named;  ///< from the cube, the façade and the user's points
  Labels labels; ///< and from the lines of sight, or from what was seen along the axis of a façade
  /// The lines do not change when points are named: those of a session are shared. Null: no sensor is known.
  std::shared_ptr<const SightCrossings> crossings;
  /// How many lines cross each tetrahedron, how many samples lie right in front of it; see SightLabels. Null likewise.
  std::shared_ptr<const SightLabels> sight;
  std::optional<OneSided> one_sided; ///< the sensors all lie on one side
  /// Null: no façade, or there are lines of sight, which know better.
  std::shared_ptr<const HiddenCounts> hidden;
  std::vector<TetrahedronIndex> beyond_walls; ///< named inside, see walls.h
};

/// The stages evidence and, where sensors are known, line_of_sight.
Evidence gather_evidence(const PointCloud& cloud, const Scene& scene, const Context& context);

/// The same with the points of these options named, too.
Evidence with_points(const Evidence& evidence, const Scene& scene, const Context& context);

/// How many lines of sight cross what was found to be inside.
struct Contradictions {
  std::uint64_t lines = 0, all = 0;
};
Contradictions contradictions(const Evidence& evidence, const Labels& labels, const Threads& threads);

} // namespace eigencrust
