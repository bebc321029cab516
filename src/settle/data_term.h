// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What the samples and the lines of sight say of the side of one tetrahedron.
#pragma once

#include <cstdint>
#include <span>

#include <eigencrust/stages.h>

#include "evidence/hidden.h"
#include "poles/pole_weights.h"
#include "settle/noise_planes.h"

namespace eigencrust {

/// What a tie weighs where its directions are at right angles, and where they agree (docs/decisions/0026: 0.03 to 0.3
/// make little difference); in units of a face's weight.
constexpr double tie = 0.1;
inline const double strongest_tie = tie * std::exp(steepness);

/// Costs in units of a face's weight.
struct DataTerm {
  float outside = 0; ///< what it costs to be inside
  float inside = 0;  ///< what it costs to be outside
};

/// Below the spacing the poles speak: on a smooth surface every circumcentre lies on the side of one of the two poles
/// of its sample. Where samples are noisy the distance from the local mean plane does, as far as that reaches. Lines of
/// sight count each (none of it is in the paper; docs/decisions/0026).
class DataTerms {
 public:
  /// \param isolated samples where it is > 0 say nothing; may be empty \param sight, hidden may be null
  DataTerms(const Tetrahedralization& tetrahedralization, const Poles& poles, const PoleLabels& labels,
            const NoisePlanes& planes, SampleLengthsView isolated, const SightLabels* sight,
            const HiddenCounts* hidden = nullptr)
      : t_(tetrahedralization),
        poles_(poles),
        labels_(labels),
        planes_(planes),
        isolated_(isolated),
        sight_(sight),
        hidden_(hidden) {}

  [[nodiscard]] SampleLengthsView isolated() const { return isolated_; }
  [[nodiscard]] DataTerm operator()(TetrahedronIndex i) const;

 private:
  void add_ties(SampleIndex s, TetrahedronIndex i, const Vec3& centre, DataTerm& sum) const;
  void add_heights(TetrahedronIndex i, const Vec3& middle, DataTerm& sum) const;
  void add_lines(TetrahedronIndex i, DataTerm& sum) const;
  [[nodiscard]] double trust_in(TetrahedronIndex i) const { return static_cast<double>(labels_.trust[i]) / full_trust; }

  const Tetrahedralization& t_;
  const Poles& poles_;
  const PoleLabels& labels_;
  const NoisePlanes& planes_;
  SampleLengthsView isolated_;
  const SightLabels* sight_;
  const HiddenCounts* hidden_;
};

} // namespace eigencrust
