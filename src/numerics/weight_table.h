// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Sums of weights by number, the same in any order.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "geometry/distinct_numbers.h"

namespace eigencrust {

/// Whole units: what is added in another order gives the same.
class WeightTable {
 public:
  explicit WeightTable(std::size_t bound) : numbers_(bound), place_(bound) {}
  void clear() {
    numbers_.clear();
    sums_.clear();
  }
  void add(std::uint32_t number, double weight) {
    if (numbers_.add(number)) {
      place_[number] = static_cast<std::uint32_t>(sums_.size());
      sums_.push_back(0);
    }
    sums_[place_[number]] += std::llround(weight * units);
  }
  /// visit(number, sum) for each that is not 0, in the order of their first appearance.
  template <class Visit>
  void for_each(Visit&& visit) const {
    for (std::size_t k = 0; k < sums_.size(); ++k)
      if (sums_[k] != 0) visit(numbers_.numbers()[k], static_cast<float>(static_cast<double>(sums_[k]) / units));
  }

 private:
  static constexpr double units = 1 << 20; // weights of poles are between 1 and e^8
  DistinctNumbers numbers_;
  std::vector<std::uint32_t> place_;
  std::vector<std::int64_t> sums_;
};

} // namespace eigencrust
