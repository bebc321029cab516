// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Where noise exceeds the spacing: the middle of the samples, place by place.
#pragma once

#include <span>
#include <vector>

#include <eigencrust/types.h>

#include "parallel/threads.h"
#include "samples/sample_model.h"

namespace eigencrust {

/// The mean planes of the sample model, oriented outward by the labelled poles (not in the paper; docs/decisions/0026).
class NoisePlanes {
 public:
  /// How far a plane speaks, in deviations of the noise (docs/decisions/0026).
  static constexpr double reach = 5;

  NoisePlanes(const Tetrahedralization& tetrahedralization, const Poles& poles, const Labels& labels,
              const SampleModel& model, const Threads& threads);

  /// Is there a plane for this sample?
  [[nodiscard]] bool has(SampleIndex s) const {
    return !plane_.empty() && model_.is_noisy(s) && squared_norm(plane_[s.value / SampleModel::run].normal) > 0;
  }
  /// Is there one, and p near enough for it to know? Beyond, at thin parts, there is another surface, and beside a rim
  /// there is none.
  [[nodiscard]] bool knows(SampleIndex s, const Vec3& p) const {
    return has(s) &&
           distance(p, plane_[s.value / SampleModel::run].mean) < reach * static_cast<double>(model_.noise[s]);
  }
  /// Height of p over the sample's plane in deviations of the noise, > 0 outside.
  [[nodiscard]] double height(SampleIndex s, const Vec3& p) const {
    const MeanPlane& plane = plane_[s.value / SampleModel::run];
    return dot(p - plane.mean, plane.normal) / static_cast<double>(model_.noise[s]);
  }

 private:
  const SampleModel& model_;
  std::vector<MeanPlane> plane_; ///< of each run; normal: outward, 0 where that is not known
};

} // namespace eigencrust
