// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Edges in the order of their costs.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace eigencrust {

/// A heap in which each item has four others below it, side by side: less deep than one of two, and what is compared is
/// one number.
class EdgeQueue {
 public:
  void clear() { heap_.clear(); }
  [[nodiscard]] bool empty() const { return heap_.empty(); }

  /// Adds one at the end; make() has to follow before anything else is asked. \param cost not negative; told apart to
  /// 2^-20 of itself, then by edge
  void append(double cost, std::uint32_t edge) { heap_.push_back(key(cost, edge)); }
  void make() {
    for (std::size_t i = heap_.size() / children + 1; i-- > 0;)
      if (i < heap_.size()) sink(i, heap_[i]);
  }

  /// The cheapest.
  [[nodiscard]] std::uint32_t top() const { return static_cast<std::uint32_t>(heap_.front()); }
  void pop() {
    const std::uint64_t last = heap_.back();
    heap_.pop_back();
    if (!heap_.empty()) sink(0, last);
  }
  /// Gives the cheapest another cost.
  void change_top(double cost) { sink(0, key(cost, top())); }
  void push(double cost, std::uint32_t edge) {
    std::size_t at = heap_.size();
    const std::uint64_t item = key(cost, edge);
    heap_.push_back(item);
    for (; at > 0 && item < heap_[(at - 1) / children]; at = (at - 1) / children)
      heap_[at] = heap_[(at - 1) / children];
    heap_[at] = item;
  }

 private:
  static constexpr std::size_t children = 4;

  static std::uint64_t key(double cost, std::uint32_t edge) {
    constexpr std::uint64_t high = 0xffffffff00000000U; // numbers that are not negative are ordered as their bits are
    return (std::bit_cast<std::uint64_t>(cost) & high) | edge;
  }

  void sink(std::size_t at, std::uint64_t item) {
    for (std::size_t first = children * at + 1; first < heap_.size(); first = children * at + 1) {
      std::size_t least = first;
      for (std::size_t k = first + 1; k < heap_.size() && k < first + children; ++k)
        least = heap_[k] < heap_[least] ? k : least;
      if (item <= heap_[least]) break;
      heap_[at] = heap_[least];
      at = least;
    }
    heap_[at] = item;
  }

  std::vector<std::uint64_t> heap_;
};

} // namespace eigencrust
