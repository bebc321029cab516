// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Values by their rank.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace eigencrust {

/// The value of rank share × (n - 1), rounded down; reorders the values, of which there must be one.
template <class T>
T quantile(std::vector<T>& values, double share) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// Of an even number of values the larger middle one.
template <class T>
T median(std::vector<T>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

} // namespace eigencrust
