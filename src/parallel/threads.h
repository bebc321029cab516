// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The only place that knows threads. Work is cut into blocks whose number does not depend on the
/// number of threads, and sums are added block by block, so that results are the same bytes on any
/// machine.
#pragma once

#include <eigencrust/threads.h>

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace eigencrust {

/// Block length for loops over n cheap items: short loops stay on the calling thread.
constexpr std::size_t default_block = 16384;
/// The same for items that are a search or a walk each: dear beside the start of a block, few beside a small cloud.
constexpr std::size_t costly_block = 64;

/// work(begin, end, block) for consecutive blocks of [0, n).
template <class Work>
void for_blocks(const Threads& threads, std::size_t n, std::size_t block_size, Work&& work) {
  const std::size_t blocks = (n + block_size - 1) / block_size;
  threads.run(blocks, [&](std::size_t b) { work(b * block_size, std::min(n, (b + 1) * block_size), b); });
}

/// work(i) for each i in [0, n); items must not write to each other's data.
template <class Work>
void for_each_index(const Threads& threads, std::size_t n, Work&& work, std::size_t block_size = default_block) {
  for_blocks(threads, n, block_size, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) work(i);
  });
}

/// Sum of part(begin, end) over the blocks, added in block order: the same value for any thread count.
template <class T, class Part>
T sum_blocks(const Threads& threads, std::size_t n, Part&& part, std::size_t block_size = default_block) {
  std::vector<T> partial((n + block_size - 1) / block_size);
  for_blocks(threads, n, block_size,
             [&](std::size_t begin, std::size_t end, std::size_t b) { partial[b] = part(begin, end); });
  return std::accumulate(partial.begin(), partial.end(), T{});
}

/// Sorts in blocks on all threads, then merges pairs of blocks; equal items keep no order.
template <class Range>
void sort_blocks(const Threads& threads, Range& items) {
  // The number of blocks is fixed: std::sort of a block and the merges are deterministic.
  constexpr std::size_t blocks = 16;
  const std::size_t n = items.size();
  if (n < 4096) {
    std::sort(items.begin(), items.end());
    return;
  }
  const auto at = [&](std::size_t b) { return items.begin() + static_cast<std::ptrdiff_t>(n * b / blocks); };
  threads.run(blocks, [&](std::size_t b) { std::sort(at(b), at(b + 1)); });
  for (std::size_t width = 1; width < blocks; width *= 2)
    threads.run(blocks / (2 * width), [&](std::size_t k) {
      const std::size_t b = 2 * width * k;
      std::inplace_merge(at(b), at(b + width), at(b + 2 * width));
    });
}

} // namespace eigencrust
