// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Sets of numbers: lists that are emptied again and again, and what is sorted.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace eigencrust {

/// A list of different numbers below a bound. Emptying it costs nothing, making it does: one for many lists.
class DistinctNumbers {
 public:
  explicit DistinctNumbers(std::size_t bound) : last_list_(bound, 0) {}

  void clear() {
    ++list_;
    numbers_.clear();
  }
  /// \returns whether the number is new
  bool add(std::uint32_t number) {
    if (last_list_[number] == list_) return false;
    last_list_[number] = list_;
    numbers_.push_back(number);
    return true;
  }
  /// In the order of their first appearance.
  [[nodiscard]] const std::vector<std::uint32_t>& numbers() const { return numbers_; }

 private:
  std::vector<std::uint32_t> last_list_; ///< that holds the number
  std::vector<std::uint32_t> numbers_;
  std::uint32_t list_ = 1;
};

/// In order, each once.
template <class T>
void sort_distinct(std::vector<T>& values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

/// Block length for loops over n items with such a table for each block.
inline std::size_t block_with_table(std::size_t n) { return n / 64 < 2048 ? 2048 : n / 64 + 1; }

} // namespace eigencrust
