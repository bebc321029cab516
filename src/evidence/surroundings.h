// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What was scanned: a body, rooms from within, or one side of something that goes on behind
/// (not in the paper; docs/decisions/0032).
#pragma once

#include <span>

#include <eigencrust/stages.h>

#include "tetrahedra/scene.h"

namespace eigencrust {

/// What the user says (`facade`); or, of `detect_facade` and without the paper's weights, what the sensors say; or,
/// where none is known, how the samples lie.
Surroundings surroundings_of(const PointCloud& cloud, const Scene& scene, const Options& options,
                             const Threads& threads);

/// Area of the samples' hull whose samples were seen from within it, and from elsewhere.
struct HullSight {
  double within = 0, without = 0;
};
/// \param lines of samples on the hull; those of others do not matter
HullSight hull_sight(const Tetrahedralization& tetrahedralization, const VertexStars& stars,
                     std::span<const SightLine> lines, const Threads& threads);

/// How the samples lie along an axis.
struct AxisReading {
  /// Share of the area, as many squared spacings as there are samples, whose samples have another one above or below
  /// them: within a spacing across the axis, and along it farther than twice as far and than spacing and noise explain.
  /// A face that lies in the plane of a scanner's lines has many times the samples of all others. Or the share around
  /// which the samples lie in two sheets, one above the other, if that is more.
  double stacked = 1;
  /// Space between the samples and their hull behind them, over that in front, seen from the positive end. Large where
  /// the samples are the cap of a body, infinite where they are a plane, small where the ground has something on it.
  /// -1: not measured.
  double cap = -1;
};
/// Do so few samples of a façade have another one before or behind them that it was seen along its axis, as ground is
/// from the air? Scans from the ground see walls, and what is below something.
bool is_seen_along(const Scene& scene, Axis front, const Threads& threads);

/// Some thousand samples are looked at. `cap` is measured only where `stacked` is small.
AxisReading read_axis(const Scene& scene, int axis, const Threads& threads);

} // namespace eigencrust
