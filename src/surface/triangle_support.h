// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// How well the samples bear out one triangle (docs/decisions/0004).
#pragma once

#include <algorithm>
#include <cmath>
#include <span>

#include <eigencrust/stages.h>

#include "samples/sample_model.h"

namespace eigencrust {

/// See measure_support.
class TriangleSupport {
 public:
  TriangleSupport(const Tetrahedralization& t, const TetrahedronLabels& labels, const SampleModel& model,
                  std::span<const float> grid_spacing)
      : t_(t), labels_(labels), model_(model), grid_spacing_(grid_spacing) {}

  /// Of the face v between the tetrahedra `inside` and `outside` (invalid: nothing lies there).
  [[nodiscard]] float operator()(const std::array<SampleIndex, 3>& v, TetrahedronIndex inside,
                                 TetrahedronIndex outside) const {
    double longest = 0, mean = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      longest = std::max(longest, distance(t_.positions[v[k]], t_.positions[v[(k + 1) % 3]]));
      mean += scale(v[k]) / static_cast<double>(v.size());
    }
    const double contrast =
        outside.valid() ? std::fabs(static_cast<double>(labels_.value(outside) - labels_.value(inside))) : 0;
    const double sampling = std::min(1.0, full_support * mean / longest);
    return static_cast<float>(sampling * (1 + std::min(1.0, contrast)) / 2);
  }

 private:
  // The longest edge of a triangle among evenly spread samples is about twice the distance to the third nearest.
  static constexpr double full_support = 2.5;

  [[nodiscard]] double scale(SampleIndex s) const {
    const bool isolated = model_.isolated[s.value] > 0;
    const double spacing = isolated ? model_.typical_spacing : static_cast<double>(model_.spacing[s.value]);
    return grid_spacing_.empty() ? spacing : std::max(spacing, static_cast<double>(grid_spacing_[s.value]));
  }

  const Tetrahedralization& t_;
  const TetrahedronLabels& labels_;
  const SampleModel& model_;
  std::span<const float> grid_spacing_;
};

} // namespace eigencrust
