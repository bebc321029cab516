// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// How close the samples stand.
#pragma once

#include <eigencrust/stages.h>

namespace eigencrust {

/// How close the samples stand, and which of them may be outliers (not in the paper; docs/decisions/0013).
struct Neighbourhoods {
  std::vector<float> spacing; ///< distance to the third nearest other sample
  double typical = 0;         ///< median of those
  double nearest = 0;         ///< median distance to the nearest other sample: the spacing of the report
  /// Distance to the 20th nearest sample where a sample is isolated: its spacing is 2.5 times the typical one
  /// and its neighbourhood is not flat. 0 for all others.
  std::vector<float> isolated;
};

} // namespace eigencrust
